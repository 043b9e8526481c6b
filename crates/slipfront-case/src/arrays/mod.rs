//! Arrays and images that a case reads: friction coefficients block by block, and texture masks.
//!
//! The files may hold anything, so every parser compares the sizes in a header with the length of the file before it
//! allocates memory, files longer than their lattice can need are refused, and any invalid contents give an
//! [`ArrayError`]. Arrays are (ny, nx) and row-major, row j = 0 (the smallest y) first.

mod error;
mod mask;
mod npy;
mod table;

use std::io::Read;
use std::path::Path;

pub use error::{ArrayError, extension};
pub use mask::{mask_png, write_mask_png};
pub use npy::mask_npy;

use crate::disk::open_regular;
use error::{contents_error, refuse_value, unknown_extension};

/// Reads the bytes of a file for a lattice of `nx` x `ny` blocks. They are read once, so that the copy in the run folder
/// holds what the case was made of even if the file changes.
///
/// # Errors
/// [`ArrayError`] if the file is missing, not a regular file, or longer than that lattice can need.
pub fn read_file(path: &Path, nx: usize, ny: usize) -> Result<Vec<u8>, ArrayError> {
    let read_error = |source| ArrayError::Read {
        path: path.to_owned(),
        source,
    };
    let file = open_regular(path).map_err(read_error)?;
    let found = file.metadata().map_err(read_error)?.len();
    let blocks = (nx as u64).saturating_mul(ny as u64);
    let of_blocks = |head: u64, number: u64| Some(blocks.saturating_mul(number).saturating_add(head));
    // A `.npy` holds a header and 64 bits per block, a `.csv` numbers, separators and comments.
    let of_array = match extension(path).as_str() {
        "npy" => of_blocks(npy::HEADER_MAX_BYTES as u64, 8),
        "csv" => of_blocks(table::PREAMBLE_MAX_BYTES, table::NUMBER_MAX_BYTES),
        _ => None,
    };
    let longest = of_array.unwrap_or(mask::FILE_MAX_BYTES);
    if found > longest {
        let (what, remedy) = match of_array {
            Some(_) => (
                format!("{ny} rows of {nx} numbers take"),
                "write one number per block, or change `blocks`",
            ),
            None => ("an image takes".to_owned(), "scale it down"),
        };
        let problem = format!("has {found} bytes where {what} at most {longest}; {remedy}");
        return Err(contents_error(path, problem));
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
/// [`ArrayError`] if the bytes are of another format or shape, or have a value that is not finite or is below zero.
pub fn field(path: &Path, bytes: &[u8], nx: usize, ny: usize) -> Result<Vec<f64>, ArrayError> {
    let values = match extension(path).as_str() {
        "npy" => npy::values(path, bytes, nx, ny)?,
        "csv" => table::values(path, bytes, nx, ny)?,
        other => return Err(unknown_extension(path, other, ".npy or .csv")),
    };
    refuse_value(path, &values, nx, "a finite number >= 0", |value| {
        !value.is_finite() || value < 0.0
    })?;
    Ok(values)
}

#[cfg(test)]
mod tests;
