//! Conversion of a canvas to a picture.

use crate::canvas::Canvas;
use crate::picture::Picture;
use crate::picture_error::PictureError;
use crate::png_file;
use crate::raster;
use crate::svg;

/// Largest number of pixels of a PNG.
const MAX_PIXELS: f64 = 1e8;

impl Canvas {
    /// Makes the SVG and the PNG of the canvas.
    pub(crate) fn finish(self) -> Result<Picture, PictureError> {
        let [width, height] = self.pixels();
        let pixels = Some(&self).filter(|_| f64::from(width) * f64::from(height) <= MAX_PIXELS);
        let pixels = pixels.and_then(raster::rgb);
        let pixels = pixels.ok_or_else(|| PictureError::Png("it would be too large".to_string()))?;
        Ok(Picture {
            svg: svg::svg(&self)?,
            png: png_file::encode(width as usize, height as usize, &pixels, None)?,
            canvas: self,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color_image::Image;
    use crate::geometry::Area;

    /// The width, the resolution per metre and the RGB pixels of a PNG file.
    fn decode(file: &[u8]) -> (usize, u32, Vec<u8>) {
        let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
        let per_metre = reader.info().pixel_dims.map(|dims| dims.xppu).unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        (info.width as usize, per_metre, pixels)
    }

    #[test]
    fn an_image_has_no_seams() {
        // 7 columns over 50 pixels, which differ only in level: the white background must not show between
        // them.
        let mut canvas = Canvas::new(60.0, 60.0);
        let levels = (0..49).map(|index| (index % 2) as u8).collect();
        canvas.images.push(Image {
            area: Area {
                x: 5.0,
                y: 5.0,
                width: 50.0,
                height: 50.0,
            },
            columns: 7,
            levels,
        });
        let (columns, per_metre, pixels) = decode(&canvas.finish().unwrap().png);
        assert_eq!((columns, per_metre), (60, 11811));
        let brightest = (0..50 * 50)
            .map(|index| pixels[((5 + index / 50) * 60 + 5 + index % 50) * 3])
            .max();
        assert!(brightest < Some(100), "{brightest:?}");
    }

    #[test]
    fn a_picture_that_is_too_large_is_refused() {
        let error = Canvas::new(1e5, 2e3).finish().unwrap_err().to_string();
        assert_eq!(error, "the PNG could not be written: it would be too large");
    }
}
