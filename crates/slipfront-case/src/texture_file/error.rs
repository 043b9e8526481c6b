//! Reasons why a file of a texture is not written.

use crate::arrays::ArrayError;
use crate::case_file::CaseError;

/// Largest number of pixels of a picture along a side, and in total: no program, including this one, reads
/// more.
pub(super) const MAX_PIXELS: [usize; 2] = [1 << 20, 1 << 28];

/// An error in writing the file of a texture.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum TextureFileError {
    #[error(
        "cannot determine the format of `{path}`; use the extension .svg or .dxf for outlines, .png for a picture, .gsf for \
         a height field, or .stl for a solid"
    )]
    Extension { path: String },
    #[error(
        "`--scale` applies to pictures only, and `{path}` is not a picture: outlines and height fields have their true size"
    )]
    Scale { path: String },
    #[error(
        "a solid is a .stl with a depth of its texture, and only it has one: write `--depth \"20 um\" -o face.stl`, or leave \
         `--depth` out for `{path}`"
    )]
    Depth { path: String },
    #[error(
        "the solid would have more than {most} triangles: use fewer blocks, or write a .svg or .gsf instead"
    )]
    TooManyTriangles { most: usize },
    #[error(
        "the picture would have {width} x {height} pixels; at most {} along a side and {} in total can be read again: reduce `--scale`",
        MAX_PIXELS[0],
        MAX_PIXELS[1]
    )]
    TooManyPixels { width: usize, height: usize },
    #[error(
        "the outlines would have {corners} vertices; at most {most} are written: write a .png or .gsf instead"
    )]
    TooManyCorners { corners: usize, most: usize },
    #[error(transparent)]
    Case(#[from] CaseError),
    #[error(transparent)]
    Write(#[from] ArrayError),
}

impl TextureFileError {
    /// Whether the request is wrong, so that the user could ask for another file.
    pub fn is_input(&self) -> bool {
        !matches!(self, Self::Write(_))
    }
}
