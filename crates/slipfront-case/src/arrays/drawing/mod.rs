//! Outlines of a drawing: SVG and DXF as closed polylines.

#[cfg(feature = "drawings")]
mod chains;
#[cfg(feature = "drawings")]
mod dxf;
mod outlines;
#[cfg(feature = "drawings")]
mod pen;
#[cfg(feature = "drawings")]
mod splines;
#[cfg(feature = "drawings")]
mod svg;
#[cfg(feature = "drawings")]
mod svg_style;
#[cfg(feature = "drawings")]
mod tree;

use std::io::Read;
use std::path::Path;

pub use self::outlines::Drawing;
pub(crate) use self::outlines::SLIDER_LAYER;
use super::error::{ArrayError, at_most, contents_error, extension, unknown_extension};

/// Longest file, bytes.
const FILE_MAX_BYTES: u64 = 64 << 20;
/// Refuses a drawing that is longer than 64 MiB.
///
/// # Errors
/// [`ArrayError`] with both lengths.
pub fn limit_length_of_drawing(path: &Path, found: u64) -> Result<(), ArrayError> {
    let remedy = "draw one copy and repeat it by `array`, or export a picture for a mask";
    at_most(path, found, FILE_MAX_BYTES, "a drawing takes", remedy)
}

/// Reads the outlines of a drawing called `path`, for blocks with an edge of `block` mm. Curves become chords
/// at most a ten-thousandth of a block away.
///
/// # Errors
/// [`ArrayError`] if the file is neither SVG nor DXF, states no unit of length, contains an outline that is
/// not closed or something that has no outline, or has too many corners.
pub fn drawing(path: &Path, source: &mut impl Read, block: f64) -> Result<Drawing, ArrayError> {
    let read: fn(&[u8], f64) -> Result<Drawing, String> = match extension(path).as_str() {
        #[cfg(feature = "drawings")]
        "svg" => svg::read,
        #[cfg(feature = "drawings")]
        "dxf" => dxf::read,
        #[cfg(not(feature = "drawings"))]
        "svg" | "dxf" => |_, _| {
            Err("is a drawing, which is read by the command and in Python only: write its texture as a .png there, for a mask".to_owned())
        },
        other => return Err(unknown_extension(path, other, ".svg or .dxf")),
    };
    let mut bytes = Vec::new();
    source.read_to_end(&mut bytes).map_err(ArrayError::read(path))?;
    let drawing = read(&bytes, block).map_err(|problem| contents_error(path, problem))?;
    if drawing.parts.iter().all(|part| part.rings.is_empty()) {
        let notes: String = drawing.notes.iter().map(|note| format!(" ({note})")).collect();
        let problem =
            format!("has no outline of a texture{notes}: draw a closed line on a layer that is shown");
        return Err(contents_error(path, problem));
    }
    Ok(drawing)
}
