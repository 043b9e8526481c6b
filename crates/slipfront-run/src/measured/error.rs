//! Reasons why a table is not a record.

use std::path::{Path, PathBuf};

use slipfront_base::text::display_path;
use slipfront_case::nearest::why_unread;
use slipfront_case::table::TableError;
use thiserror::Error;

/// Reason why a table is not a record.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum MeasuredError {
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
    #[error("{0}")]
    Refused(String),
}

impl MeasuredError {
    /// Refuses a table for a reason that no caller words in another way: a sentence that names its path.
    pub(super) fn refuse<T>(sentence: String) -> Result<T, Self> {
        Err(Self::Refused(sentence))
    }

    /// The error of a file that cannot be read.
    pub(super) fn unreadable(path: &Path) -> impl Fn(std::io::Error) -> Self {
        move |source| {
            let why = why_unread(path, &source);
            Self::Refused(format!("cannot read {}: {why}", display_path(path)))
        }
    }

    /// The error of a text that is no table.
    pub(super) fn of_table(path: &Path) -> impl Fn(TableError) -> Self {
        move |source| Self::Refused(format!("{} {source}", display_path(path)))
    }
}

/// The end of a sentence on a unit that is missing: an example of an option.
fn such_as(axis: &str, example: &Option<&str>) -> String {
    example.map_or(String::new(), |unit| format!(", such as `--{axis}-unit {unit}`"))
}
