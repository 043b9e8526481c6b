//! Limits on the number of pixels of an image or height map.

use std::path::Path;

use super::error::ArrayError;

/// Largest number of pixels, more than any lattice has blocks.
const PIXELS_MAX: u64 = 1 << 28;
/// Largest number of pixels along a side, more than any lattice has blocks. Decoders hold some rows in
/// memory, with eight bytes per pixel.
pub(super) const SIDE_MAX: u64 = 1 << 20;
/// Largest length of a file in bytes.
pub(super) const FILE_MAX_BYTES: u64 = PIXELS_MAX;

/// Refuses a file with too many pixels.
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
