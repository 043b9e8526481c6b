//! Tables of numbers as text (`.csv`).

use std::path::Path;

use csv::{ReaderBuilder, Trim};

use super::error::{ArrayError, broken, contents_error, value_error};

/// Comment lines are searched for the separator up to this total length.
pub(super) const PREAMBLE_MAX_BYTES: u64 = 1 << 20;
/// A number with its separator and blanks, and its share of comments: numpy's longest takes 25.
pub(super) const NUMBER_MAX_BYTES: u64 = 64;

/// `ny` lines of `nx` numbers in row-major order; the values may be anything that is written as a number.
pub(super) fn values(path: &Path, bytes: &[u8], nx: usize, ny: usize) -> Result<Vec<f64>, ArrayError> {
    let separator = separator(bytes);
    let table = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(Trim::All)
        .delimiter(separator)
        .from_reader(bytes);

    // A number and what separates it from the next take two bytes at the least.
    let mut values = Vec::with_capacity((nx * ny).min(bytes.len() / 2 + 1));
    let mut row = 0;
    for record in table.into_records() {
        let record = record.map_err(|source| broken(path, ".csv", &source.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        // Numbers in columns are padded with several blanks.
        let fields = record.iter();
        let fields: Vec<&str> = fields
            .filter(|field| separator != b' ' || !field.is_empty())
            .collect();
        // The csv crate gives an empty record for a comment that ends the file without a line break.
        if matches!(fields.as_slice(), [] | [""]) {
            continue;
        }
        if row == ny {
            let found = format!("more than {ny} lines of numbers");
            return Err(wrong_shape(path, &found, nx, ny));
        }
        if fields.len() != nx {
            let found = format!("{} numbers in line {line}", fields.len());
            return Err(wrong_shape(path, &found, nx, ny));
        }
        for (column, field) in fields.iter().enumerate() {
            let value = field.parse().map_err(|_| {
                let field = format!("`{}`", excerpt(field));
                value_error(path, &field, [row, column], "a number with a decimal point")
            });
            values.push(value?);
        }
        row += 1;
    }
    if row < ny {
        return Err(wrong_shape(path, &format!("{row} lines of numbers"), nx, ny));
    }
    Ok(values)
}

/// What separates the numbers of the first line that is no comment: a semicolon, a tab, a comma or a blank.
///
/// The semicolon comes before the comma, so that a decimal comma is reported as such and not as a wrong shape.
fn separator(bytes: &[u8]) -> u8 {
    let preamble = &bytes[..bytes.len().min(PREAMBLE_MAX_BYTES as usize)];
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
