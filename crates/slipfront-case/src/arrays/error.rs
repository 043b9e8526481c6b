//! Errors of array and image files.

use std::io;
use std::path::{Path, PathBuf};

use slipfront_base::text::single_line;

use crate::nearest::why_unread;

/// An error of an array or image file: one sentence that ends with the remedy.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum ArrayError {
    #[error(
        "cannot read `{}`: {}; check the path (relative to the case file) and its permissions",
        path.display(),
        why_unread(path, source)
    )]
    Read { path: PathBuf, source: io::Error },
    #[error(
        "cannot determine the format of `{}` from {found}; give a file with the extension {known}",
        path.display()
    )]
    Extension {
        path: PathBuf,
        found: String,
        known: &'static str,
    },
    #[error("`{}` {problem}", path.display())]
    Contents { path: PathBuf, problem: String },
    #[error(
        "`{}` has {width} x {height} pixels; at most {limit} pixels are read, and at most {side_limit} along a side: scale it \
         down",
        path.display()
    )]
    TooManyPixels {
        path: PathBuf,
        width: u64,
        height: u64,
        limit: u64,
        side_limit: u64,
    },
    #[error("cannot write `{}`: {source}; check that the folder exists, is writable and has room", path.display())]
    Write { path: PathBuf, source: io::Error },
    #[error("stopped while a file was read")]
    Stopped,
}

impl ArrayError {
    /// A system error about a file that is read.
    pub(crate) fn read(path: &Path) -> impl Fn(io::Error) -> Self {
        move |source| Self::Read {
            path: path.to_owned(),
            source,
        }
    }

    /// A system error about a file that is written.
    pub(crate) fn write(path: &Path) -> impl Fn(io::Error) -> Self {
        move |source| Self::Write {
            path: path.to_owned(),
            source,
        }
    }
}

/// An error about the contents of a file; `problem` continues the sentence after the name of the file.
pub(super) fn contents_error(path: &Path, problem: String) -> ArrayError {
    let path = path.to_owned();
    ArrayError::Contents { path, problem }
}

/// Refuses a file of more than `longest` bytes; `takes` is what takes at most as many, with its verb.
pub(super) fn at_most(
    path: &Path,
    found: u64,
    longest: u64,
    takes: &str,
    remedy: &str,
) -> Result<(), ArrayError> {
    if found <= longest {
        return Ok(());
    }
    let problem = format!("has {found} bytes where {takes} at most {longest}; {remedy}");
    Err(contents_error(path, problem))
}

/// An error about a file that does not have the format of its extension.
pub(super) fn broken(path: &Path, format: &str, detail: &str) -> ArrayError {
    let detail = single_line(detail);
    let problem = format!("is not a readable {format} file: {detail}; write the file again");
    contents_error(path, problem)
}

/// An error about a value in the row and column `at`.
pub(super) fn value_error(path: &Path, value: &str, at: [usize; 2], wanted: &str) -> ArrayError {
    let [row, column] = at;
    let problem = format!(
        "has {value} in row {row}, column {column} (both counted from 0), but must be {wanted}; correct this value"
    );
    contents_error(path, problem)
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
