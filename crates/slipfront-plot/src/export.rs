//! How a drawn picture becomes SVG and PNG.

use std::fmt::Write as _;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD as BASE64;
use kuva::backend::svg::SvgBackend;
use kuva::render::color::Color;
use kuva::render::render::{Primitive, Scene};

use crate::canvas::{Area, Image, LEVEL_BLANK, color, level_colour};
use crate::picture::{Picture, PictureError};
use crate::style::DPI;

/// The font `DejaVu` Sans, cut down; `font/README.md` says how and under which licence.
const FONT: &[u8] = include_bytes!("font/DejaVuSans-subset.woff2");

/// A PNG of more pixels is refused, and oversampling stops short of a few times that.
const MOST_PIXELS: f64 = 1e8;

/// How many times larger the PNG is drawn before it is averaged down: `kuva` smooths lines along one
/// direction only, and sets letters on whole pixels. Very large pictures, which nobody prints, are spared the
/// memory.
fn oversampling(width: f64, height: f64) -> u32 {
    let fits = |&times: &u32| width * height * f64::from(times * times) < 0.5 * MOST_PIXELS;
    (1..=3).rev().find(fits).unwrap_or(1)
}

/// Makes both files of a picture, `width` by `height` pixels; images lie below all elements.
pub(crate) fn write(
    width: f64,
    height: f64,
    elements: Vec<Primitive>,
    images: &[Image],
) -> Result<Picture, PictureError> {
    if width * height > MOST_PIXELS {
        return Err(PictureError::Png("it would be too large".to_string()));
    }
    let times = oversampling(width, height);
    let mut scene = Scene::new(width, height);
    scene.background_color = None;
    scene.elements = elements;
    let svg = svg(&scene, images)?;
    let drawn = std::mem::take(&mut scene.elements);
    scene.elements = images
        .iter()
        .map(|image| rectangles(image, times))
        .chain(drawn)
        .collect();
    Ok(Picture {
        svg,
        png: png(&scene, times)?,
    })
}

/// The scene as an SVG document with a physical size, its font and its images.
fn svg(scene: &Scene, images: &[Image]) -> Result<String, PictureError> {
    let (width, height) = (scene.width, scene.height);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.2}mm\" height=\"{:.2}mm\" \
         viewBox=\"0 0 {width} {height}\" \
         font-family=\"'DejaVu Sans',Verdana,sans-serif\" stroke-linejoin=\"round\">\n\
         <style>@font-face{{font-family:'DejaVu Sans';\
         src:url('data:font/woff2;base64,{}') format('woff2');}}</style>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n",
        width / DPI * 25.4,
        height / DPI * 25.4,
        BASE64.encode(FONT),
    );
    for image in images {
        let Area { x, y, width, height } = image.area;
        // Both properties: the second is what browsers know, the first what older viewers know.
        let _ = writeln!(
            svg,
            "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" \
             preserveAspectRatio=\"none\" image-rendering=\"optimizeSpeed\" \
             style=\"image-rendering:pixelated\" \
             href=\"data:image/png;base64,{}\"/>",
            BASE64.encode(&image_png(image)?),
        );
    }
    // kuva's opening tag knows neither a physical size nor a view box, so that the picture could not be
    // scaled.
    let drawn = SvgBackend::new().with_pretty(true).render_scene(scene);
    svg.push_str(
        drawn
            .split_once('>')
            .map_or("</svg>", |(_, body)| body.trim_start()),
    );
    Ok(svg)
}

/// An image as a PNG of its own, in which a pixel is repeated so often that a viewer's smoothing blurs its
/// edge only.
fn image_png(image: &Image) -> Result<Vec<u8>, PictureError> {
    let rows = image.levels.len() / image.columns;
    let repeat = (400 / image.columns.max(rows)).max(1);
    let mut pixels = Vec::with_capacity(image.levels.len() * repeat * repeat);
    for row in image.levels.chunks_exact(image.columns) {
        let wide: Vec<u8> = row
            .iter()
            .flat_map(|&level| std::iter::repeat_n(level, repeat))
            .collect();
        for _ in 0..repeat {
            pixels.extend_from_slice(&wide);
        }
    }
    let palette: Vec<u8> = (0..=LEVEL_BLANK).flat_map(level_colour).collect();
    encode(image.columns * repeat, rows * repeat, &pixels, Some(palette))
}

/// An image as rectangles that end on the pixels of the enlarged PNG.
fn rectangles(image: &Image, times: u32) -> Primitive {
    let rows = image.levels.len() / image.columns;
    let fine = f64::from(times);
    let across = |column: usize| {
        ((image.area.x + image.area.width * column as f64 / image.columns as f64) * fine).round() / fine
    };
    let down =
        |row: usize| ((image.area.y + image.area.height * row as f64 / rows as f64) * fine).round() / fine;
    let colours: Vec<Color> = (0..=LEVEL_BLANK)
        .map(|level| color(level_colour(level)))
        .collect();
    let (mut x, mut y, mut w, mut h, mut fills) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (row, levels) in image.levels.chunks_exact(image.columns).enumerate() {
        let mut column = 0;
        for run in levels.chunk_by(|a, b| a == b) {
            x.push(across(column));
            y.push(down(row));
            w.push(across(column + run.len()) - across(column));
            h.push(down(row + 1) - down(row));
            fills.push(colours[usize::from(run[0])].clone());
            column += run.len();
        }
    }
    Primitive::RectBatch { x, y, w, h, fills }
}

/// The scene as a PNG file.
fn png(scene: &Scene, times: u32) -> Result<Vec<u8>, PictureError> {
    let large = kuva::RasterBackend::new()
        .with_scale(times as f32)
        .render_scene(scene)
        .map_err(PictureError::Png)?;
    let (columns, pixels) = decode(&large)?;
    let fine = times as usize;
    let (width, height) = (columns / fine, pixels.len() / 4 / columns / fine);
    let mut averaged = Vec::with_capacity(width * height * 3);
    let mut sums = vec![[0u32; 3]; width];
    for band in pixels.chunks_exact(columns * 4 * fine) {
        sums.fill([0; 3]);
        for row in band.chunks_exact(columns * 4) {
            for (sum, block) in sums.iter_mut().zip(row.chunks_exact(4 * fine)) {
                for pixel in block.chunks_exact(4) {
                    for (channel, &value) in sum.iter_mut().zip(pixel) {
                        *channel += u32::from(value);
                    }
                }
            }
        }
        let count = times * times;
        averaged.extend(sums.iter().flatten().map(|sum| ((sum + count / 2) / count) as u8));
    }
    encode(width, height, &averaged, None)
}

/// The width and the RGBA pixels of a PNG file.
fn decode(file: &[u8]) -> Result<(usize, Vec<u8>), PictureError> {
    let failed = |error: png::DecodingError| PictureError::Png(error.to_string());
    let mut reader = png::Decoder::new(std::io::Cursor::new(file))
        .read_info()
        .map_err(failed)?;
    let size = reader
        .output_buffer_size()
        .ok_or_else(|| PictureError::Png("it is too large".to_string()))?;
    let mut pixels = vec![0; size];
    let info = reader.next_frame(&mut pixels).map_err(failed)?;
    Ok((info.width as usize, pixels))
}

/// A PNG file of RGB pixels, or of indices into a palette.
fn encode(
    width: usize,
    height: usize,
    pixels: &[u8],
    palette: Option<Vec<u8>>,
) -> Result<Vec<u8>, PictureError> {
    let failed = |error: png::EncodingError| PictureError::Png(error.to_string());
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_depth(png::BitDepth::Eight);
    if let Some(palette) = palette {
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(palette);
        encoder.set_filter(png::Filter::Up);
    } else {
        let per_metre = (DPI / 0.0254).round() as u32;
        let unit = png::Unit::Meter;
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_pixel_dims(Some(png::PixelDimensions {
            xppu: per_metre,
            yppu: per_metre,
            unit,
        }));
    }
    encoder
        .write_header()
        .and_then(|mut writer| writer.write_image_data(pixels))
        .map_err(failed)?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::Canvas;

    #[test]
    fn an_image_has_no_seams() {
        // 7 columns over 50 pixels, all alike but for the level: between them the white ground must not shine
        // through.
        let mut canvas = Canvas::new(60.0, 60.0);
        let levels = (0..49).map(|index| (index % 2) as u8).collect();
        canvas.image(Image {
            area: Area {
                x: 5.0,
                y: 5.0,
                width: 50.0,
                height: 50.0,
            },
            columns: 7,
            levels,
        });
        let (columns, pixels) = decode(&canvas.finish().unwrap().png).unwrap();
        assert_eq!(columns, 60);
        let brightest = (0..50 * 50)
            .map(|index| pixels[((5 + index / 50) * 60 + 5 + index % 50) * 3])
            .max();
        assert!(brightest < Some(100), "{brightest:?}");
    }
}
