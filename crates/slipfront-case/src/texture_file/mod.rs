//! The texture of a case as a file for other programs, in true size: as outlines for a laser or a drawing
//! program (SVG and DXF), or as blocks in a picture, a height field or a solid (PNG, GSF and STL).

mod drawing;
mod dxf;
mod error;
mod even_odd;
mod gsf;
mod stl;
mod svg;
mod textured_blocks;

pub use self::drawing::{Layer, OutlineDrawing};
use self::error::MAX_PIXELS;
pub use self::error::TextureFileError;
pub use self::textured_blocks::textured_blocks;

use std::path::Path;

use crate::arrays::{ArrayError, extension, png_of_mask};
use crate::case::Case;
use crate::case_file::CaseError;
use slipfront::surface::{Clearance, clearance};
use slipfront_base::disk::write_atomic;

/// The smallest feature and the smallest gap of the texture, in blocks.
pub fn smallest(case: &Case) -> Result<Clearance, CaseError> {
    Ok(clearance(&case.model.lattice, &even_odd::textures(case)?))
}

/// Options of the file of a texture.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// Number of pixels per block along a side of a picture, by default one.
    pub scale: Option<usize>,
    /// Depth of the texture of a solid, m.
    pub depth: Option<f64>,
}

/// Writes the texture of a case to `path`, in the format of its extension. Returns notes about the file.
///
/// # Errors
/// [`TextureFileError`] if the extension names no format, or if the file would be too large or cannot be
/// written.
pub fn write(case: &Case, path: &Path, options: Options) -> Result<Vec<String>, TextureFileError> {
    let (bytes, notes) = contents(case, path, options)?;
    write_atomic(path, &bytes).map_err(ArrayError::write(path))?;
    Ok(notes)
}

/// The bytes of the file that [`write()`] writes to `path`, and notes about it.
///
/// # Errors
/// [`TextureFileError`] if the extension names no format, or if the file would be too large.
pub fn contents(
    case: &Case,
    path: &Path,
    Options { scale, depth }: Options,
) -> Result<(Vec<u8>, Vec<String>), TextureFileError> {
    let name = || path.display().to_string();
    let ending = extension(path);
    if ending != "png" && scale.is_some() {
        return Err(TextureFileError::Scale { path: name() });
    }
    if (ending == "stl") != depth.is_some() {
        return Err(TextureFileError::Depth { path: name() });
    }
    let (nx, ny) = (case.model.lattice.nx, case.model.lattice.ny);
    Ok(match ending.as_str() {
        "png" => {
            let scale = scale.unwrap_or(1);
            let (width, height) = (nx * scale, ny * scale);
            if width.max(height) > MAX_PIXELS[0] || width * height > MAX_PIXELS[1] {
                return Err(TextureFileError::TooManyPixels { width, height });
            }
            let textured = textured_blocks(case);
            let pixel = |at: usize| textured[at / width / scale * nx + at % width / scale];
            let pixels: Vec<bool> = (0..width * height).map(pixel).collect();
            let bytes = png_of_mask(width, height, &pixels).map_err(ArrayError::write(path))?;
            (bytes, Vec::new())
        }
        "gsf" => (gsf::field(case), Vec::new()),
        "stl" => (stl::solid(case, depth.unwrap_or_default())?, Vec::new()),
        "svg" | "dxf" => {
            let drawing = OutlineDrawing::new(case)?;
            let text = if ending == "svg" {
                svg::text(&drawing)
            } else {
                dxf::text(&drawing)
            };
            (text.into_bytes(), drawing.notes)
        }
        _ => return Err(TextureFileError::Extension { path: name() }),
    })
}
