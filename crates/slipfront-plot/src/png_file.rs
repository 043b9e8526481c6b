//! PNG files.

use crate::picture::PictureError;
use crate::style::DPI;

/// What the bytes of an image are.
pub(crate) enum Pixels {
    /// Red, green and blue of every pixel, printed at [`DPI`].
    Rgb,
    /// An index into this palette for every pixel.
    Indexed(Vec<u8>),
}

/// A PNG file of an image.
pub(crate) fn encode(
    width: usize,
    height: usize,
    bytes: &[u8],
    pixels: Pixels,
) -> Result<Vec<u8>, PictureError> {
    let failed = |error: png::EncodingError| PictureError::Png(error.to_string());
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_depth(png::BitDepth::Eight);
    match pixels {
        Pixels::Indexed(palette) => {
            encoder.set_color(png::ColorType::Indexed);
            encoder.set_palette(palette);
            encoder.set_filter(png::Filter::Up);
        }
        Pixels::Rgb => {
            let per_metre = (DPI / 0.0254).round() as u32;
            encoder.set_color(png::ColorType::Rgb);
            encoder.set_pixel_dims(Some(png::PixelDimensions {
                xppu: per_metre,
                yppu: per_metre,
                unit: png::Unit::Meter,
            }));
        }
    }
    encoder
        .write_header()
        .and_then(|mut writer| writer.write_image_data(bytes))
        .map_err(failed)?;
    Ok(file)
}
