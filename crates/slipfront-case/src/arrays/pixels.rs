//! How many pixels an image or height map may have.

use std::path::Path;

use super::error::ArrayError;

/// More pixels than any lattice has blocks.
const PIXELS_MAX: u64 = 1 << 28;
/// More pixels than any lattice has blocks along a side. A row, of which a decoder holds some, takes eight bytes for each.
pub(super) const SIDE_MAX: u64 = 1 << 20;
/// A file of more bytes than this is refused.
pub(super) const FILE_MAX_BYTES: u64 = PIXELS_MAX;

/// Refuses a file of more pixels than are read.
pub(super) fn limit_pixels(path: &Path, width: u64, height: u64) -> Result<(), ArrayError> {
    if width.max(height) <= SIDE_MAX && width * height <= PIXELS_MAX {
        return Ok(());
    }
    Err(ArrayError::TooManyPixels {
        path: path.to_owned(),
        width,
        height,
        limit: PIXELS_MAX,
        side_limit: SIDE_MAX,
    })
}
