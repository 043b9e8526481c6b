//! Tables of numbers as text (`.csv`).

use std::path::Path;

use super::array_file::ArrayFile;
use super::error::{ArrayError, contents_error, value_error};
use super::pixels::{SIDE_MAX, limit_pixels};
use super::slab::Slab;
use crate::table::{HEAD_BYTES, TableError, TableLayout, TableOptions, TableRows, number};

/// Total length of the comment lines in which the separator is searched.
pub(super) const PREAMBLE_MAX_BYTES: u64 = 1 << 20;
/// Largest length of a number with its separator, blanks and share of the comments: numpy's longest number
/// takes 25.
pub(super) const NUMBER_MAX_BYTES: u64 = 64;
/// Largest length of a line of a table of any size. The whole line is in memory, with the position of each of
/// the fields that are read, eight bytes each.
const LINE_MAX_BYTES: u64 = 8 * SIDE_MAX;

/// The rows of a slab of `ny` lines of `nx` numbers. Earlier lines are only counted; later ones are not read.
pub(super) fn values(
    file: &mut ArrayFile,
    slab: &Slab,
    wanted: &str,
    is_wrong: impl Fn(f64) -> bool,
) -> Result<Vec<f64>, ArrayError> {
    let Slab { nx, ny, ref rows } = *slab;
    let line_max = PREAMBLE_MAX_BYTES.saturating_add((nx as u64).saturating_mul(NUMBER_MAX_BYTES));
    let path = file.path;
    let (length, layout) = layout_of(file)?;
    let mut lines = TableRows::new(&mut *file.source, &layout, line_max);
    // A number and its separator take at least two bytes.
    let mut values = Vec::with_capacity(slab.n_blocks().min(length as usize / 2 + 1));
    let mut row = 0;
    // The rank that reads the last row also checks that no further row follows.
    while row < rows.end || rows.end == ny {
        let Some((line, fields)) = lines.next_row().map_err(table_error(path))? else {
            break;
        };
        if row == ny {
            let found = format!("more than {ny} lines of numbers");
            return Err(wrong_shape(path, &found, nx, ny));
        }
        if rows.contains(&row) {
            if fields.len() != nx {
                let found = format!("{} numbers in line {line}", fields.len());
                return Err(wrong_shape(path, &found, nx, ny));
            }
            for (column, field) in fields.iter().enumerate() {
                let at = [row, column];
                let value = number(field, layout.decimal);
                let value = value.ok_or_else(|| no_number(path, field, layout.decimal, at, line))?;
                if is_wrong(value) {
                    let value = format!("{value} in line {line},");
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

/// Reads a table of any size row by row, below the header of an instrument, and returns its numbers of
/// columns and rows. `take` gets each row, with its index and the column 0. Where there may be `gaps`, fields
/// without a digit, such as empty ones, `Bad` or `---`, are NaN.
pub(super) fn rows(
    file: &mut ArrayFile,
    layout: &TableLayout,
    gaps: bool,
    mut take: impl FnMut([usize; 2], &[f64]) -> Result<(), ArrayError>,
) -> Result<[u64; 2], ArrayError> {
    let path = file.path;
    file.source.rewind().map_err(ArrayError::read(path))?;
    let mut lines = TableRows::new(&mut *file.source, layout, LINE_MAX_BYTES);
    let mut values = Vec::new();
    let (mut columns, mut row) = (None, 0);
    while let Some((line, fields)) = lines.next_row().map_err(table_error(path))? {
        values.clear();
        for (column, field) in fields.iter().enumerate() {
            let at = [row, column];
            let has_digit = || field.contains(|sign: char| sign.is_ascii_digit());
            values.push(match number(field, layout.decimal) {
                Some(value) => value,
                None if has_digit() => return Err(no_number(path, field, layout.decimal, at, line)),
                None if gaps => f64::NAN,
                None => return Err(gap_error(path, field, at, line)),
            });
        }
        let wanted = *columns.get_or_insert(values.len());
        if values.len() != wanted {
            let problem = format!(
                "has {} numbers in line {line}, where the lines before have {wanted}; write as many in every line",
                values.len()
            );
            return Err(contents_error(path, problem));
        }
        limit_pixels(path, wanted as u64, row as u64 + 1)?;
        take([row, 0], &values)?;
        row += 1;
    }
    Ok([columns.unwrap_or(0) as u64, row as u64])
}

/// The length of a table in bytes, and its layout. Every line must have numbers: a line of column names is
/// refused as a row.
fn layout_of(file: &mut ArrayFile) -> Result<(u64, TableLayout), ArrayError> {
    let (length, head) = file.length_and_head(HEAD_BYTES)?;
    let layout = TableLayout::find(&head, TableOptions::default()).map_err(table_error(file.path))?;
    Ok((length, layout.of_numbers_alone()))
}

/// Layout of a table that begins with `head`, and may have lines above its numbers.
pub(super) fn layout_of_map(
    path: &Path,
    head: &[u8],
    options: TableOptions,
) -> Result<TableLayout, ArrayError> {
    let layout = TableLayout::find(head, options).map_err(table_error(path))?;
    Ok(layout.without_names())
}

/// Converts an error of a table into an error about the file with this path.
fn table_error(path: &Path) -> impl Fn(TableError) -> ArrayError {
    move |error| match error {
        TableError::Read(source) => ArrayError::read(path)(source),
        error => contents_error(path, error.to_string()),
    }
}

/// The error of a field that is no number, in the row and column `at`, in line `line` of the file.
fn no_number(path: &Path, field: &str, decimal: char, at: [usize; 2], line: u64) -> ArrayError {
    let field = format!("`{}` in line {line},", excerpt(field));
    let wanted = match decimal {
        '.' => "a number with a decimal point",
        _ => "a number with a decimal comma, as others of the table have,",
    };
    value_error(path, &field, at, wanted)
}
/// The error of a field without a digit in a map, in the row and column `at`.
fn gap_error(path: &Path, field: &str, [row, column]: [usize; 2], line: u64) -> ArrayError {
    let what = if field.is_empty() {
        "an empty field".to_owned()
    } else {
        format!("`{}`", excerpt(field))
    };
    let remedy = if [row, column] == [0, 0] && field.is_empty() {
        "remove this row and this column if they are coordinates, and give their spacing as `pixel_size`"
    } else {
        "if such fields are points that were not measured, omit them with `missing = \"nan\"`"
    };
    let problem =
        format!("has {what} in line {line}, in row {row}, column {column} (both counted from 0): {remedy}");
    contents_error(path, problem)
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
