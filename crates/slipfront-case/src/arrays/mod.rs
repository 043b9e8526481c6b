//! Arrays and images that a case reads: friction coefficients block by block, and texture masks.
//!
//! The files may hold anything, so every parser compares the sizes in a header with the length of the file before it
//! allocates memory, files longer than their lattice can need are refused, and any invalid contents give an
//! [`ArrayError`]. Arrays are (ny, nx) and row-major, row j = 0 (the smallest y) first.

mod mask;
mod npy;
mod table;

use std::io::{self, Read};
use std::path::{Path, PathBuf};

pub use mask::{mask_png, write_mask_png};
pub use npy::mask_npy;

use crate::disk::open_regular;
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

/// Reads the bytes of a file for a lattice of `nx` x `ny` blocks. They are read once, so that the copy in the run folder
/// holds what the case was made of even if the file changes.
///
/// # Errors
///
/// [`ArrayError`] if the file is missing, not a regular file, or longer than that lattice can need.
pub fn read_file(path: &Path, nx: usize, ny: usize) -> Result<Vec<u8>, ArrayError> {
    let read_error = |source| ArrayError::Read {
        path: path.to_owned(),
        source,
    };
    let file = open_regular(path).map_err(read_error)?;
    let found = file.metadata().map_err(read_error)?.len();
    let longest = longest(path, nx, ny);
    if found > longest {
        let (wanted, remedy) = match extension(path).as_str() {
            "npy" | "csv" => (
                format!("{ny} rows of {nx} numbers take at most {longest}"),
                "write one number per block, or change `blocks`",
            ),
            _ => (format!("an image takes at most {longest}"), "scale it down"),
        };
        return Err(ArrayError::TooLong {
            path: path.to_owned(),
            found,
            wanted,
            remedy,
        });
    }
    let mut bytes = Vec::new();
    file.take(longest).read_to_end(&mut bytes).map_err(read_error)?;
    Ok(bytes)
}

/// One number per block, of the bytes of a `.npy` or `.csv` file called `path`.
///
/// `nx` and `ny` are the numbers of blocks along x and y. A `.npy` file has the shape (ny, nx), any real, integer
/// or boolean type, either byte order and either memory order. A `.csv` file has `ny` lines of `nx` numbers with
/// a decimal point, separated by commas, semicolons, tabs or blanks; blank lines and lines that start with `#`
/// are skipped. Returns `nx * ny` values in row-major order, row j = 0 (the smallest y) first, in the unit of the
/// file; a friction coefficient has none.
///
/// # Errors
///
/// [`ArrayError`] if the bytes are of another format or shape, or have a value that is not finite or is below zero.
pub fn field(path: &Path, bytes: &[u8], nx: usize, ny: usize) -> Result<Vec<f64>, ArrayError> {
    let known = ".npy or .csv";
    let values = match extension(path).as_str() {
        "npy" => npy::values(path, bytes, nx, ny)?,
        "csv" => table::values(path, bytes, nx, ny)?,
        other => return Err(unknown_extension(path, other, known)),
    };
    match values.iter().position(|value| !value.is_finite() || *value < 0.0) {
        None => Ok(values),
        Some(at) => Err(ArrayError::Value {
            path: path.to_owned(),
            row: at / nx,
            column: at % nx,
            value: values[at].to_string(),
            wanted: "a finite number >= 0",
        }),
    }
}

/// The longest file that a lattice of `nx` x `ny` blocks can need, in bytes.
///
/// A `.npy` holds a header and 64 bits per block, a `.csv` numbers, separators and comments, an image at most one byte for
/// each pixel that it may have.
fn longest(path: &Path, nx: usize, ny: usize) -> u64 {
    let blocks = (nx as u64).saturating_mul(ny as u64);
    match extension(path).as_str() {
        "npy" => blocks
            .saturating_mul(8)
            .saturating_add(npy::HEADER_MAX_BYTES as u64),
        "csv" => blocks
            .saturating_mul(table::NUMBER_MAX_BYTES)
            .saturating_add(table::PREAMBLE_MAX_BYTES),
        _ => mask::FILE_MAX_BYTES,
    }
}

/// The extension in lower case, empty if there is none.
pub fn extension(path: &Path) -> String {
    path.extension()
        .map(|text| text.to_string_lossy().to_lowercase())
        .unwrap_or_default()
}

fn unknown_extension(path: &Path, extension: &str, known: &'static str) -> ArrayError {
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

#[cfg(test)]
mod tests;
