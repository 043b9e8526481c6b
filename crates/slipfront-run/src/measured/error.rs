//! Reasons why a table is not a record.

use std::path::PathBuf;

use slipfront_base::text::display_path;
use slipfront_case::nearest::why_unread;
use slipfront_case::table::TableError;
use thiserror::Error;

/// Reason why a table is not a record.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum MeasuredError {
    #[error("cannot read {}: {}", display_path(path), why_unread(path, source))]
    Unreadable { path: PathBuf, source: std::io::Error },
    #[error("{} {source}", display_path(path))]
    Table { path: PathBuf, source: TableError },
    #[error("{} {why}", display_path(path))]
    Workbook { path: PathBuf, why: String },
    #[error(
        "{} has `{name}` in several columns, {columns}: give the number of a column, such as {number}",
        display_path(path)
    )]
    Several {
        path: PathBuf,
        name: String,
        columns: String,
        number: usize,
    },
    #[error("{} has no column `{name}`: {known}", display_path(path))]
    Column {
        path: PathBuf,
        name: String,
        known: String,
    },
    #[error(
        "column `{column}` of {} has no unit: give it with --{axis}-unit, such as `--{axis}-unit {example}`",
        display_path(path)
    )]
    NoUnit {
        path: PathBuf,
        column: String,
        axis: &'static str,
        example: &'static str,
    },
    #[error(
        "column `{column}` of {} has the unit `{unit}`, which is none of a {quantity} that is known here: convert the column, or \
         give the unit that its numbers have with --{axis}-unit{}",
        display_path(path),
        such_as(axis, example)
    )]
    OtherUnit {
        path: PathBuf,
        column: String,
        unit: String,
        quantity: &'static str,
        axis: &'static str,
        example: Option<&'static str>,
    },
    #[error(
        "column `{column}` of {} {why}: give its cells the number format General, and the column the unit that they then have",
        display_path(path)
    )]
    Percentages {
        path: PathBuf,
        column: String,
        why: &'static str,
    },
    #[error("the unit of column `{column}` of {}: {why}", display_path(path))]
    Unit {
        path: PathBuf,
        column: String,
        why: String,
    },
    #[error(
        "line {line} of {}, {text:?}, has no number in column `{column}`: write one, remove the line, begin it with #, or choose one of several \
         segments by `segment`",
        display_path(path)
    )]
    NoNumber {
        path: PathBuf,
        line: u64,
        text: String,
        column: String,
    },
    #[error(
        "line {line} of {} has {value:e} in column `{column}`, as meters write where their range is exceeded: remove such lines, \
         or begin them with #",
        display_path(path)
    )]
    Overload {
        path: PathBuf,
        line: u64,
        column: String,
        value: f64,
    },
    #[error(
        "line {line} of {}: the time or displacement decreases from {before} to {value} in SI units; keep the lines of a single \
         step of the test, such as by `segment`",
        display_path(path)
    )]
    Falls {
        path: PathBuf,
        line: u64,
        before: f64,
        value: f64,
    },
    #[error(
        "{} has {found} lines of numbers; a record needs at least two",
        display_path(path)
    )]
    TooShort { path: PathBuf, found: usize },
    #[error(
        "{} has the same time or displacement, {at} in SI units, in all lines: choose another column",
        display_path(path)
    )]
    NoLength { path: PathBuf, at: f64 },
}

/// The end of a sentence on a unit that is missing: an example of an option.
fn such_as(axis: &str, example: &Option<&str>) -> String {
    example.map_or(String::new(), |unit| format!(", such as `--{axis}-unit {unit}`"))
}
