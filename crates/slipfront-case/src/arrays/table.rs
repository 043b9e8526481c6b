//! Tables of numbers as text (`.csv`).

use std::io::{BufRead, Read, Seek, Take};
use std::path::Path;

use csv::{ErrorKind, ReaderBuilder, StringRecord, Trim};

use super::error::{ArrayError, broken, contents_error, value_error};
use super::head::length_and_head;
use super::pixels::{SIDE_MAX, limit_pixels};
use super::slab::Slab;

/// Total length of comment lines among which the separator is searched.
pub(super) const PREAMBLE_MAX_BYTES: u64 = 1 << 20;
/// Largest length of a number with its separator and blanks, and its share of comments: numpy's longest
/// number takes 25.
pub(super) const NUMBER_MAX_BYTES: u64 = 64;
/// Largest length of a line of a table of any size. The line is in memory as a whole, with the place of each
/// of its fields: eight bytes for each of the fields that are read.
const LINE_MAX_BYTES: u64 = 8 * SIDE_MAX;

/// The rows of a slab of `ny` lines of `nx` numbers. Lines before these rows are counted, lines behind are
/// not read.
pub(super) fn values(
    path: &Path,
    source: &mut (impl BufRead + Seek),
    slab: &Slab,
    wanted: &str,
    is_wrong: impl Fn(f64) -> bool,
) -> Result<Vec<f64>, ArrayError> {
    let Slab { nx, ny, ref rows } = *slab;
    let line_max = PREAMBLE_MAX_BYTES.saturating_add((nx as u64).saturating_mul(NUMBER_MAX_BYTES));
    let (length, mut lines) = TableLines::of(path, source, line_max)?;
    // A number and what separates it from the next take two bytes at the least.
    let mut values = Vec::with_capacity(slab.n_blocks().min(length as usize / 2 + 1));
    let mut row = 0;
    // Whoever reads the last row sees that there is no other.
    while row < rows.end || rows.end == ny {
        if !lines.next()? {
            break;
        }
        if row == ny {
            let found = format!("more than {ny} lines of numbers");
            return Err(wrong_shape(path, &found, nx, ny));
        }
        if rows.contains(&row) {
            let found = lines.fields().count();
            if found != nx {
                let found = format!("{found} numbers in line {}", lines.number());
                return Err(wrong_shape(path, &found, nx, ny));
            }
            for (column, field) in lines.fields().enumerate() {
                let at = [row, column];
                let value = number(path, field, at, lines.number())?;
                if is_wrong(value) {
                    let value = format!("{value} in line {},", lines.number());
                    return Err(value_error(path, &value, at, wanted));
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

/// Reads a table of any size row after row, and returns its columns and rows. `take` gets each row, with its
/// number and the column 0.
pub(super) fn rows(
    path: &Path,
    source: &mut (impl BufRead + Seek),
    mut take: impl FnMut([usize; 2], &[f64]) -> Result<(), ArrayError>,
) -> Result<[u64; 2], ArrayError> {
    let (_, mut lines) = TableLines::of(path, source, LINE_MAX_BYTES)?;
    let mut values = Vec::new();
    let (mut columns, mut row) = (None, 0);
    while lines.next()? {
        values.clear();
        for (column, field) in lines.fields().enumerate() {
            values.push(number(path, field, [row, column], lines.number())?);
        }
        let wanted = *columns.get_or_insert(values.len());
        if values.len() != wanted {
            let problem = format!(
                "has {} numbers in line {}, where the lines before have {wanted}; write as many in every line",
                values.len(),
                lines.number()
            );
            return Err(contents_error(path, problem));
        }
        limit_pixels(path, wanted as u64, row as u64 + 1)?;
        take([row, 0], &values)?;
        row += 1;
    }
    Ok([columns.unwrap_or(0) as u64, row as u64])
}

/// The lines of a table that hold numbers, one after the other.
struct TableLines<'a, R> {
    path: &'a Path,
    table: csv::Reader<Take<R>>,
    /// Largest number of bytes of a line, with comments before it.
    line_max: u64,
    separator: u8,
    record: StringRecord,
}

impl<'a, R: BufRead + Seek> TableLines<'a, &'a mut R> {
    /// Opens a table with lines of at most `line_max` bytes; returns its length in bytes and its lines.
    fn of(path: &'a Path, source: &'a mut R, line_max: u64) -> Result<(u64, Self), ArrayError> {
        let (length, preamble) = length_and_head(path, source, PREAMBLE_MAX_BYTES)?;
        let separator = separator(&preamble);
        let lines = Self {
            path,
            table: reader(source.take(line_max), separator),
            line_max,
            separator,
            record: StringRecord::new(),
        };
        Ok((length, lines))
    }

    /// Goes to the next line, if there is one.
    fn next(&mut self) -> Result<bool, ArrayError> {
        loop {
            self.table.get_mut().set_limit(self.line_max);
            let is_there = self.table.read_record(&mut self.record).map_err(|error| {
                let detail = error.to_string();
                match error.into_kind() {
                    ErrorKind::Io(source) => ArrayError::read(self.path)(source),
                    _ => broken(self.path, ".csv", &detail),
                }
            })?;
            if self.table.get_ref().limit() == 0 {
                let problem = format!(
                    "has more than {} bytes in line {}, and no line of its numbers takes as many: write one row in every line",
                    self.line_max,
                    self.number()
                );
                return Err(contents_error(self.path, problem));
            }
            // The csv crate gives an empty record for a comment that ends the file without a line break.
            let is_blank = self.fields().nth(1).is_none() && self.fields().all(str::is_empty);
            if !is_there || !is_blank {
                return Ok(is_there);
            }
        }
    }

    /// The fields of the line. Numbers in columns are padded with several blanks.
    fn fields(&self) -> impl Iterator<Item = &str> {
        let is_field = |field: &&str| self.separator != b' ' || !field.is_empty();
        self.record.iter().filter(is_field)
    }

    /// The number of the line in the file.
    fn number(&self) -> u64 {
        self.record.position().map_or(0, csv::Position::line)
    }
}

/// The number of a field in the row and column `at`, which stand in this line of the file.
fn number(path: &Path, field: &str, at: [usize; 2], line: u64) -> Result<f64, ArrayError> {
    field.parse().map_err(|_| {
        let field = format!("`{}` in line {line},", excerpt(field));
        value_error(path, &field, at, "a number with a decimal point")
    })
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

/// Separator of the fields of the first line that is no comment, from the beginning of a table: a semicolon,
/// a tab, a comma or a blank.
///
/// The semicolon comes before the comma, so that a decimal comma is recognised.
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
