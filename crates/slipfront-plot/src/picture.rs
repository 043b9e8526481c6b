//! A finished picture.

use std::borrow::Cow;

use crate::canvas::Canvas;
use crate::look::PictureFormat;
use crate::pdf::pdf;

/// One picture in several formats, ready to be written to files.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// An SVG document that carries its own font.
    pub svg: String,
    /// A PNG file, 300 dots per inch.
    pub png: Vec<u8>,
    /// The drawing, from which a PDF is made when it is asked for.
    pub(crate) canvas: Canvas,
}

impl Picture {
    /// The file of the picture in this format.
    pub fn file(&self, format: PictureFormat) -> Cow<'_, [u8]> {
        match format {
            PictureFormat::Svg => self.svg.as_bytes().into(),
            PictureFormat::Png => self.png.as_slice().into(),
            PictureFormat::Pdf => pdf(&self.canvas).into(),
        }
    }
}
