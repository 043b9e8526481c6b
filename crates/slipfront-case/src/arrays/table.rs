//! Tables of numbers as text (`.csv`).

use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim};

use super::{ArrayError, longest, open, read_error};

/// Comment lines longer than this in total are not looked through for the separator.
pub(super) const PREAMBLE_MAX_BYTES: u64 = 1 << 20;
/// A number with its separator and blanks, and its share of comments: numpy's longest takes 25.
pub(super) const NUMBER_MAX_BYTES: u64 = 64;

/// Reads `ny` lines of `nx` numbers in row-major order; the values may be anything that is written as a number.
pub(super) fn read(path: &Path, nx: usize, ny: usize) -> Result<Vec<f64>, ArrayError> {
    let (mut file, file_bytes) = open(path)?;
    // A line is read before it is looked at, and may be the whole file.
    let longest = longest(path, nx, ny);
    if file_bytes > longest {
        return Err(ArrayError::TooLong {
            path: path.to_owned(),
            found: file_bytes,
            wanted: format!("{ny} lines of {nx} numbers take at most {longest}"),
            remedy: "write one number per block, or change `blocks`",
        });
    }
    let separator = separator(&file).map_err(|source| read_error(path, source))?;
    file.seek(SeekFrom::Start(0))
        .map_err(|source| read_error(path, source))?;
    let mut table = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(Trim::All)
        .delimiter(separator)
        .from_reader(BufReader::new(file));

    // A number and what separates it from the next take two bytes at the least.
    let mut values = Vec::with_capacity((nx * ny).min(file_bytes as usize / 2 + 1));
    let mut record = StringRecord::new();
    let mut row = 0;
    while table
        .read_record(&mut record)
        .map_err(|source| unreadable(path, source))?
    {
        let line = record.position().map_or(0, csv::Position::line);
        // Numbers in columns are padded with several blanks.
        let fields: Vec<&str> = record
            .iter()
            .filter(|field| separator != b' ' || !field.is_empty())
            .collect();
        // The csv crate gives an empty record for a comment that ends the file without a line break.
        if matches!(fields.as_slice(), [] | [""]) {
            continue;
        }
        if row == ny {
            return Err(wrong_shape(
                path,
                format!("more than {ny} lines of numbers"),
                nx,
                ny,
            ));
        }
        if fields.len() != nx {
            let found = format!("{} numbers in line {line}", fields.len());
            return Err(wrong_shape(path, found, nx, ny));
        }
        for (column, field) in fields.iter().enumerate() {
            let value = field.parse().map_err(|_| ArrayError::Value {
                path: path.to_owned(),
                row,
                column,
                value: format!("`{}`", shortened(field)),
                wanted: "a number with a decimal point",
            })?;
            values.push(value);
        }
        row += 1;
    }
    if row < ny {
        return Err(wrong_shape(path, format!("{row} lines of numbers"), nx, ny));
    }
    Ok(values)
}

/// What separates the numbers of the first line that is no comment: a semicolon, a tab, a comma or a blank.
///
/// The semicolon comes before the comma, so that a decimal comma is told as such and not as a wrong shape.
fn separator(file: &File) -> std::io::Result<u8> {
    let mut reader = BufReader::new(file.take(PREAMBLE_MAX_BYTES));
    let mut line = Vec::new();
    while reader.read_until(b'\n', &mut line)? > 0 {
        let text = line.trim_ascii();
        if !text.is_empty() && !text.starts_with(b"#") {
            let separators = [b';', b'\t', b',', b' '];
            return Ok(separators
                .into_iter()
                .find(|byte| text.contains(byte))
                .unwrap_or(b','));
        }
        line.clear();
    }
    Ok(b',')
}

fn wrong_shape(path: &Path, found: String, nx: usize, ny: usize) -> ArrayError {
    ArrayError::Shape {
        path: path.to_owned(),
        found,
        wanted: format!("one line per row of blocks, {ny} lines of {nx} numbers,"),
        remedy: "write one number per block, or change `blocks`",
    }
}

fn unreadable(path: &Path, source: csv::Error) -> ArrayError {
    let detail = source.to_string();
    match source.into_kind() {
        csv::ErrorKind::Io(source) => read_error(path, source),
        _ => ArrayError::Broken {
            path: path.to_owned(),
            format: ".csv",
            detail,
        },
    }
}

/// A field as it is shown in a message.
fn shortened(field: &str) -> String {
    const SHOWN: usize = 40;
    if field.chars().count() <= SHOWN {
        return field.escape_debug().to_string();
    }
    let start: String = field.chars().take(SHOWN).collect();
    format!("{}...", start.escape_debug())
}
