//! The common result of the readers of all formats: the points of a height map, and the properties that its
//! file states.

use std::path::Path;

use crate::arrays::error::{ArrayError, broken};
use crate::arrays::pixels::limit_pixels;

/// Consecutive points of a row.
pub(super) struct Line<'a> {
    /// The row, counted in the order of the file.
    pub(super) row: usize,
    /// The column of the first point.
    pub(super) column: usize,
    /// Heights of the points, in the unit of the file.
    pub(super) heights: &'a [f64],
}

impl<'a> Line<'a> {
    /// All points of a row.
    pub(super) fn of_row(row: usize, heights: &'a [f64]) -> Self {
        Self {
            row,
            column: 0,
            heights,
        }
    }
}

/// Receives the points of a file, in any order.
pub(super) type Take<'a> = dyn FnMut(&Line) -> Result<(), ArrayError> + 'a;

/// Properties of the points, as the file states them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct HeightGrid {
    /// Points along x and along y.
    pub(super) points: [usize; 2],
    /// Whether the first row lies at the largest y.
    pub(super) top_first: bool,
    /// Point spacing along x and along y, m, if the file states it.
    pub(super) pixel: Option<[f64; 2]>,
    /// Height in m of the value 1, if the file states it.
    pub(super) height_unit: Option<f64>,
    /// Sentences on how the file was read, and on doubtful features.
    pub(super) notes: Vec<String>,
}

impl HeightGrid {
    /// Points of a file that states no unit.
    pub(super) fn without_units(points: [usize; 2], top_first: bool) -> Self {
        Self {
            points,
            top_first,
            pixel: None,
            height_unit: None,
            notes: Vec::new(),
        }
    }
}

/// Number of points along x and along y from a header; an error if there are too many.
pub(super) fn points(path: &Path, format: &str, width: u64, height: u64) -> Result<[usize; 2], ArrayError> {
    if width == 0 || height == 0 {
        let detail = format!("it has {width} x {height} points");
        return Err(broken(path, format, &detail));
    }
    limit_pixels(path, width, height)?;
    Ok([width as usize, height as usize])
}
