//! What can be wrong with an array or image file.

use std::io;
use std::path::{Path, PathBuf};

use crate::text::single_line;

/// What is wrong with an array or image file: one sentence that ends with the remedy.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum ArrayError {
    #[error(
        "cannot read `{}`: {source}; check the path (relative to the case file) and its permissions",
        path.display()
    )]
    Read { path: PathBuf, source: io::Error },
    #[error(
        "cannot tell the format of `{}` from {found}; name a file that ends in {known}",
        path.display()
    )]
    Extension {
        path: PathBuf,
        found: String,
        known: &'static str,
    },
    #[error("`{}` is not a readable {format} file: {}; write the file again", path.display(), single_line(detail))]
    Broken {
        path: PathBuf,
        format: &'static str,
        detail: String,
    },
    #[error(
        "`{}` holds values of type {found} where real numbers, integers or booleans are wanted; \
         convert the array with `.astype(float)` before saving it",
        path.display()
    )]
    Dtype { path: PathBuf, found: String },
    #[error("`{}` has {found} bytes where {wanted}; {remedy}", path.display())]
    TooLong {
        path: PathBuf,
        found: u64,
        wanted: String,
        remedy: &'static str,
    },
    #[error("`{}` has {found} where {wanted} is wanted; {remedy}", path.display())]
    Shape {
        path: PathBuf,
        found: String,
        wanted: String,
        remedy: &'static str,
    },
    #[error(
        "`{}` has {value} in row {row}, column {column} (both counted from 0), where {wanted} is wanted; \
         correct this value",
        path.display()
    )]
    Value {
        path: PathBuf,
        row: usize,
        column: usize,
        value: String,
        wanted: &'static str,
    },
    #[error(
        "the image `{}` has {width} x {height} pixels where at most {limit} pixels are read; scale it down",
        path.display()
    )]
    TooManyPixels {
        path: PathBuf,
        width: u32,
        height: u32,
        limit: u64,
    },
    #[error("cannot write `{}`: {source}; check that the folder exists, is writable and has room", path.display())]
    Write { path: PathBuf, source: io::Error },
}

/// An error about a file that cannot be read as what its name says.
pub(super) fn broken(path: &Path, format: &'static str, detail: impl Into<String>) -> ArrayError {
    ArrayError::Broken {
        path: path.to_owned(),
        format,
        detail: detail.into(),
    }
}

/// Refuses an array of `nx` columns for the first of its values that is wrong.
pub(super) fn refuse_value(
    path: &Path,
    values: &[f64],
    nx: usize,
    wanted: &'static str,
    is_wrong: impl Fn(f64) -> bool,
) -> Result<(), ArrayError> {
    let Some(at) = values.iter().position(|value| is_wrong(*value)) else {
        return Ok(());
    };
    Err(ArrayError::Value {
        path: path.to_owned(),
        row: at / nx,
        column: at % nx,
        value: values[at].to_string(),
        wanted,
    })
}

/// The extension in lower case, empty if there is none.
pub fn extension(path: &Path) -> String {
    path.extension()
        .map(|text| text.to_string_lossy().to_lowercase())
        .unwrap_or_default()
}

pub(super) fn unknown_extension(path: &Path, extension: &str, known: &'static str) -> ArrayError {
    let found = match extension {
        "" => "a name without extension".to_owned(),
        other => format!("the extension `.{other}`"),
    };
    ArrayError::Extension {
        path: path.to_owned(),
        found,
        known,
    }
}
