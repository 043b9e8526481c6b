//! A canvas becomes a picture: SVG and PNG.

use crate::canvas::Canvas;
use crate::picture::{Picture, PictureError};
use crate::png_file::{self, Pixels};
use crate::raster;
use crate::svg;

/// A PNG of more pixels is refused.
const MAX_PIXELS: f64 = 1e8;

impl Canvas {
    /// Makes both files.
    pub(crate) fn finish(&self) -> Result<Picture, PictureError> {
        if self.width * self.height > MAX_PIXELS {
            return Err(PictureError::Png("it would be too large".to_string()));
        }
        let pixels =
            raster::rgb(self).ok_or_else(|| PictureError::Png("it would be too large".to_string()))?;
        Ok(Picture {
            svg: svg::svg(self)?,
            png: png_file::encode(self.width as usize, self.height as usize, &pixels, Pixels::Rgb)?,
        })
    }
}
