//! The texture of a case as a file for other programs, in true size: outlines for a laser or a drawing program, SVG and DXF, and
//! blocks as a picture or a height field, PNG and GSF.

mod drawing;
mod dxf;
mod gsf;
mod svg;

pub use self::drawing::{Fill, Layer, OutlineDrawing};

use std::path::Path;

use crate::arrays::{ArrayError, extension, png_of_mask};
use crate::case::Case;
use crate::case_file::CaseError;
use slipfront::surface::{Clearance, clearance};
use slipfront_base::disk::write_atomic;

/// Largest number of pixels of a picture along a side, and of all: no program, this one included, reads more.
const MAX_PIXELS: [usize; 2] = [1 << 20, 1 << 28];

/// An error of a file of a texture that was asked for.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum TextureFileError {
    #[error(
        "cannot tell the format of `{path}`; name a file that ends in .svg or .dxf for outlines, in .png for a picture or in .gsf for a \
         height field"
    )]
    Extension { path: String },
    #[error(
        "`--scale` is for pictures, and `{path}` is none: outlines and height fields have their true size"
    )]
    Scale { path: String },
    #[error(
        "the picture would have {width} x {height} pixels, and at most {} along a side and {} in all are read again: lower `--scale`",
        MAX_PIXELS[0],
        MAX_PIXELS[1]
    )]
    TooManyPixels { width: usize, height: usize },
    #[error(
        "the outlines would have {corners} corners, and at most {most} are written: write a .png or .gsf instead"
    )]
    TooManyCorners { corners: usize, most: usize },
    #[error(transparent)]
    Case(#[from] CaseError),
    #[error(transparent)]
    Write(#[from] ArrayError),
}

impl TextureFileError {
    /// Whether the request is to blame, so that another file could be asked for.
    pub fn is_input(&self) -> bool {
        !matches!(self, Self::Write(_))
    }
}

/// Whether each block is textured: a block that does not exist has no contact either, but is no texture.
pub fn textured_blocks(case: &Case) -> Vec<bool> {
    let (surface, slider) = (&case.model.surface, case.model.slider());
    let blocks = surface.textured.iter().enumerate();
    blocks
        .map(|(b, textured)| *textured && slider.exists(b))
        .collect()
}

/// The smallest feature and the smallest gap of the texture, in blocks.
pub fn smallest(case: &Case) -> Result<Clearance, CaseError> {
    Ok(clearance(&case.model.lattice, &case.textures_in_blocks()?))
}

/// Writes the texture of a case to `path`, in the format of its ending; `scale` is the number of pixels of a block along a
/// side of a picture, one if there is none. Returns notes about the file.
///
/// # Errors
/// [`TextureFileError`], if the ending names no format, the file would be too large, or cannot be written.
pub fn write(case: &Case, path: &Path, scale: Option<usize>) -> Result<Vec<String>, TextureFileError> {
    let (bytes, notes) = contents(case, path, scale)?;
    write_atomic(path, &bytes).map_err(|source| ArrayError::Write {
        path: path.to_owned(),
        source,
    })?;
    Ok(notes)
}

/// The bytes of the file that [`write()`] writes to `path`, and notes about it.
///
/// # Errors
/// [`TextureFileError`], if the ending names no format, or the file would be too large.
pub fn contents(
    case: &Case,
    path: &Path,
    scale: Option<usize>,
) -> Result<(Vec<u8>, Vec<String>), TextureFileError> {
    let name = || path.display().to_string();
    let ending = extension(path);
    if ending != "png" && scale.is_some() {
        return Err(TextureFileError::Scale { path: name() });
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
            let bytes = png_of_mask(width, height, &pixels);
            let failed = |source| ArrayError::Write {
                path: path.to_owned(),
                source,
            };
            (bytes.map_err(failed)?, Vec::new())
        }
        "gsf" => (gsf::field(case), Vec::new()),
        "svg" | "dxf" => {
            let drawing = OutlineDrawing::of(case)?;
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
