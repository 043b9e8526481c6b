//! What the readers of all formats give: the points of a height map, and what its file says of them.

use std::path::Path;

use crate::arrays::error::{ArrayError, broken};
use crate::arrays::pixels::limit_pixels;

/// Points that stand one after the other in a row.
pub(super) struct Line<'a> {
    /// The row, counted as the file has them.
    pub(super) row: usize,
    /// The column of the first.
    pub(super) column: usize,
    /// Their heights, in the unit of the file.
    pub(super) heights: &'a [f64],
}

/// Takes the points of a file, in any order.
pub(super) type Take<'a> = dyn FnMut(&Line) -> Result<(), ArrayError> + 'a;

/// What a file says of its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HeightGrid {
    /// Points along x and along y.
    pub(super) points: [usize; 2],
    /// Whether the first row is that of the largest y.
    pub(super) top_first: bool,
    /// Distance of neighbours along x and along y, m, if the file tells it.
    pub(super) pixel: Option<[f64; 2]>,
    /// What a height of 1 in the file is, m, if the file tells it.
    pub(super) height_unit: Option<f64>,
}

/// The points of a header that asks for this many along x and y.
pub(super) fn points(path: &Path, format: &str, width: u64, height: u64) -> Result<[usize; 2], ArrayError> {
    if width == 0 || height == 0 {
        let detail = format!("it has {width} x {height} points");
        return Err(broken(path, format, &detail));
    }
    limit_pixels(path, width, height)?;
    Ok([width as usize, height as usize])
}
