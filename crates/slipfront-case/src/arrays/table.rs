//! Tables of numbers as text (`.csv`).

use std::io::{BufRead, Read, Seek};
use std::path::Path;

use csv::{ErrorKind, ReaderBuilder, StringRecord, Trim};

use super::error::{ArrayError, broken, contents_error, value_error};
use super::head::length_and_head;
use super::slab::Slab;

/// Comment lines are searched for the separator up to this total length.
pub(super) const PREAMBLE_MAX_BYTES: u64 = 1 << 20;
/// A number with its separator and blanks, and its share of comments: numpy's longest takes 25.
pub(super) const NUMBER_MAX_BYTES: u64 = 64;

/// The rows of a slab of `ny` lines of `nx` numbers. The lines before are counted, those behind not read.
pub(super) fn values(
    path: &Path,
    source: &mut (impl BufRead + Seek),
    slab: &Slab,
    wanted: &str,
    is_wrong: impl Fn(f64) -> bool,
) -> Result<Vec<f64>, ArrayError> {
    let Slab { nx, ny, ref rows } = *slab;
    let read_error = ArrayError::read(path);
    let (length, preamble) = length_and_head(path, source, PREAMBLE_MAX_BYTES)?;
    let separator = separator(&preamble);
    let mut table = reader(source, separator);

    // A number and what separates it from the next take two bytes at the least.
    let mut values = Vec::with_capacity(slab.n_blocks().min(length as usize / 2 + 1));
    let mut record = StringRecord::new();
    let mut row = 0;
    // Whoever reads the last row sees that there is no other.
    while row < rows.end || rows.end == ny {
        let is_there = table.read_record(&mut record).map_err(|error| {
            let detail = error.to_string();
            match error.into_kind() {
                ErrorKind::Io(source) => read_error(source),
                _ => broken(path, ".csv", &detail),
            }
        })?;
        if !is_there {
            break;
        }
        // Numbers in columns are padded with several blanks.
        let fields = || {
            record
                .iter()
                .filter(|field| separator != b' ' || !field.is_empty())
        };
        // The csv crate gives an empty record for a comment that ends the file without a line break.
        if fields().nth(1).is_none() && fields().all(str::is_empty) {
            continue;
        }
        if row == ny {
            let found = format!("more than {ny} lines of numbers");
            return Err(wrong_shape(path, &found, nx, ny));
        }
        if rows.contains(&row) {
            let found = fields().count();
            if found != nx {
                let line = record.position().map_or(0, csv::Position::line);
                return Err(wrong_shape(
                    path,
                    &format!("{found} numbers in line {line}"),
                    nx,
                    ny,
                ));
            }
            for (column, field) in fields().enumerate() {
                let at = [row, column];
                let value = field.parse().map_err(|_| {
                    let field = format!("`{}`", excerpt(field));
                    value_error(path, &field, at, "a number with a decimal point")
                })?;
                if is_wrong(value) {
                    return Err(value_error(path, &value.to_string(), at, wanted));
                }
                values.push(value);
            }
        }
        row += 1;
    }
    if row < rows.end {
        return Err(wrong_shape(path, &format!("{row} lines of numbers"), nx, ny));
    }
    Ok(values)
}

/// Reads a table of text line by line; `#` begins a comment.
pub fn reader<R: Read>(source: R, separator: u8) -> csv::Reader<R> {
    ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(Trim::All)
        .delimiter(separator)
        .from_reader(source)
}

/// What separates the fields of the first line that is no comment, given the beginning of a table: a semicolon, a tab, a comma or a
/// blank.
///
/// The semicolon comes before the comma, so that a decimal comma is known as such.
pub fn separator(preamble: &[u8]) -> u8 {
    const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
    let preamble = preamble.strip_prefix(BYTE_ORDER_MARK).unwrap_or(preamble);
    let mut lines = preamble.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let numbers = lines.find(|line| !line.is_empty() && !line.starts_with(b"#"));
    let separators = [b';', b'\t', b',', b' '];
    separators
        .into_iter()
        .find(|byte| numbers.unwrap_or_default().contains(byte))
        .unwrap_or(b',')
}

fn wrong_shape(path: &Path, found: &str, nx: usize, ny: usize) -> ArrayError {
    let problem = format!(
        "has {found} where one line per row of blocks, {ny} lines of {nx} numbers, is wanted; write one number per \
         block, or change `blocks`"
    );
    contents_error(path, problem)
}

/// The beginning of a field, for a message.
fn excerpt(field: &str) -> String {
    const SHOWN: usize = 40;
    if field.chars().count() <= SHOWN {
        return field.escape_debug().to_string();
    }
    let start: String = field.chars().take(SHOWN).collect();
    format!("{}...", start.escape_debug())
}
