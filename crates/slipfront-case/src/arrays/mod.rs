//! Arrays and images that a case reads: friction coefficients block by block, texture masks, and height maps.
//!
//! The files may hold anything. Every parser therefore compares the sizes in a header with the length of the
//! file before it allocates memory, refuses files longer than their lattice can need, and returns an
//! [`ArrayError`] for invalid contents. Arrays are (ny, nx) and row-major, row j = 0 (the smallest y) first.
//!
//! A file is never in memory as a whole: only the requested rows are kept. Where several ranks read their
//! rows of one file, the error of the lowest rank is the error of reading all rows.

mod array_file;
mod drawing;
mod error;
mod height_map;
mod mask;
mod npy;
mod npy_header;
mod number_type;
mod pixels;
mod slab;
mod table;

use std::fs::File;
use std::io::{BufRead, Seek};
use std::path::Path;

pub(crate) use drawing::SLIDER_LAYER;
pub use drawing::{Drawing, drawing, limit_length_of_drawing};
pub use error::{ArrayError, extension};
pub use height_map::{HeightMap, HeightMapUnits, Preparation, Room, Roughness, height_map};
pub use mask::{mask_png, png_of_mask};
pub use npy::{head_of_state, mask_npy, npy_of_mask, state_npy};
pub use slab::Slab;

use array_file::ArrayFile;
use error::{at_most, unknown_extension};
use slipfront_base::disk::open_regular;

/// Opens a file; returns it and its length in bytes.
///
/// # Errors
/// [`ArrayError`] if the file is missing or not a regular file.
pub fn open(path: &Path) -> Result<(File, u64), ArrayError> {
    let read_error = ArrayError::read(path);
    let file = open_regular(path).map_err(&read_error)?;
    let length = file.metadata().map_err(&read_error)?.len();
    Ok((file, length))
}

/// Refuses a file that is longer than a lattice of `nx` x `ny` blocks can need.
///
/// # Errors
/// [`ArrayError`] with both lengths.
pub fn limit_length(path: &Path, found: u64, nx: usize, ny: usize) -> Result<(), ArrayError> {
    let blocks = (nx as u64).saturating_mul(ny as u64);
    let of_blocks = |head: u64, number: u64| Some(blocks.saturating_mul(number).saturating_add(head));
    // A `.npy` holds a header and 64 bits per block, a `.csv` numbers, separators and comments.
    let of_array = match extension(path).as_str() {
        "npy" => of_blocks(npy::HEADER_MAX_BYTES, 8),
        "csv" => of_blocks(table::PREAMBLE_MAX_BYTES, table::NUMBER_MAX_BYTES),
        _ => None,
    };
    let Some(longest) = of_array else {
        return at_most(
            path,
            found,
            pixels::FILE_MAX_BYTES,
            "an image takes",
            "scale it down",
        );
    };
    let takes = format!("{ny} rows of {nx} numbers take");
    at_most(
        path,
        found,
        longest,
        &takes,
        "write one number per block, or change `blocks`",
    )
}
/// Refuses a height map that is longer than 256 MiB. The map may have any number of points per block.
///
/// # Errors
/// [`ArrayError`] with both lengths.
pub fn limit_length_of_height_map(path: &Path, found: u64) -> Result<(), ArrayError> {
    at_most(
        path,
        found,
        pixels::FILE_MAX_BYTES,
        "a height map takes",
        "scale it down",
    )
}

/// Reads one number per block of some rows from a `.npy` or `.csv` file called `path`.
///
/// A `.npy` file has the shape (ny, nx), any real, integer or boolean type, either byte order and either
/// memory order. A `.csv` file has `ny` lines of `nx` numbers, separated by commas, semicolons, tabs or
/// blanks, with decimal points, or decimal commas where no commas separate; blank lines and lines that start
/// with `#` are skipped. Returns the values in row-major order, the smallest y first, in the unit of the
/// file; a friction coefficient has none.
///
/// # Errors
/// [`ArrayError`] if the file is of another format or shape, or has a value that is not finite or is below
/// zero.
pub fn field(path: &Path, source: &mut (impl BufRead + Seek), slab: &Slab) -> Result<Vec<f64>, ArrayError> {
    let is_wrong = |value: f64| !value.is_finite() || value < 0.0;
    values(
        &mut ArrayFile { path, source },
        slab,
        "a finite number >= 0",
        is_wrong,
    )
}

/// Reads one number per block of some rows from a `.npy` or `.csv` file called `path`, as [`field`] does,
/// whatever its sign.
///
/// # Errors
/// [`ArrayError`] if the file is of another format or shape, or has a value that is not finite.
pub fn signed_field(
    path: &Path,
    source: &mut (impl BufRead + Seek),
    slab: &Slab,
) -> Result<Vec<f64>, ArrayError> {
    let is_wrong = |value: f64| !value.is_finite();
    values(&mut ArrayFile { path, source }, slab, "a finite number", is_wrong)
}

fn values(
    file: &mut ArrayFile,
    slab: &Slab,
    wanted: &str,
    is_wrong: impl Fn(f64) -> bool,
) -> Result<Vec<f64>, ArrayError> {
    match extension(file.path).as_str() {
        "npy" => npy::values(file, slab, wanted, is_wrong),
        "csv" => table::values(file, slab, wanted, is_wrong),
        other => Err(unknown_extension(file.path, other, ".npy or .csv")),
    }
}

#[cfg(test)]
mod tests;
