//! What a picture is drawn on, and how it becomes SVG and PNG.
//!
//! Lines and texts go through a `kuva` scene. Images (colour maps) are kept apart: the SVG holds each as one pixelated
//! image and the PNG as rectangles that end on whole pixels, because neighbouring rectangles in an SVG leave hairline
//! seams between them in most viewers.

use std::fmt::Write as _;

use kuva::backend::svg::SvgBackend;
use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};

use super::style::{BLACK, BLANK, DPI, Rgb, TICK_LENGTH, WHITE, WIDTH_FRAME, ramp};
use super::text::{Run, Text};
use super::{Picture, PictureError};

/// DejaVu Sans, cut down; `font/README.md` says how and under which licence.
const FONT: &[u8] = include_bytes!("font/DejaVuSans-subset.woff2");

/// The PNG is drawn so many times larger and averaged down: `kuva` smooths lines along one direction only, and sets
/// letters on whole pixels.
const OVERSAMPLING: u32 = 3;

/// Where a text lies relative to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Align {
    Start,
    Middle,
    End,
}

impl Align {
    /// How far before the point a text of this width starts.
    fn before(self, width: f64) -> f64 {
        match self {
            Self::Start => 0.0,
            Self::Middle => 0.5 * width,
            Self::End => width,
        }
    }
}

/// A rectangle, in pixels, y downwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Area {
    pub(super) fn right(&self) -> f64 {
        self.x + self.width
    }

    pub(super) fn bottom(&self) -> f64 {
        self.y + self.height
    }
}

/// An image whose pixels are levels of the colour ramp.
pub(super) struct Image {
    pub(super) area: Area,
    pub(super) columns: usize,
    /// Row by row, the uppermost first; see [`level`].
    pub(super) levels: Vec<u8>,
}

/// The level of a blank pixel.
const LEVEL_BLANK: u8 = 255;

/// The level of a value from 0 to 1; NaN is blank.
pub(super) fn level(value: f32) -> u8 {
    if value.is_nan() { LEVEL_BLANK } else { (value.clamp(0.0, 1.0) * f32::from(LEVEL_BLANK - 1)).round() as u8 }
}

fn level_colour(level: u8) -> Rgb {
    if level == LEVEL_BLANK { BLANK } else { ramp(f64::from(level) / f64::from(LEVEL_BLANK - 1)) }
}

/// A picture being drawn.
pub(super) struct Canvas {
    width: f64,
    height: f64,
    images: Vec<Image>,
    elements: Vec<Primitive>,
}

impl Canvas {
    /// An empty canvas, `width` by `height` pixels.
    pub(super) fn new(width: f64, height: f64) -> Self {
        Self { width: width.round(), height: height.round(), images: Vec::new(), elements: Vec::new() }
    }

    /// Adds an image; images lie below everything else.
    pub(super) fn image(&mut self, image: Image) {
        self.images.push(image);
    }

    /// Adds a straight line.
    pub(super) fn line(&mut self, from: (f64, f64), to: (f64, f64), width: f64, colour: Rgb) {
        self.elements.push(Primitive::Line {
            x1: from.0,
            y1: from.1,
            x2: to.0,
            y2: to.1,
            stroke: color(colour),
            stroke_width: width,
            stroke_dasharray: None,
        });
    }

    /// Adds a line through points.
    pub(super) fn polyline(&mut self, points: Vec<(f64, f64)>, width: f64, colour: Rgb) {
        self.elements.push(Primitive::PolyLine {
            points,
            stroke: color(colour),
            stroke_width: width,
            stroke_dasharray: None,
        });
    }

    /// Fills a rectangle.
    pub(super) fn fill(&mut self, area: Area, colour: Rgb, opacity: f64) {
        self.elements.push(Primitive::Rect {
            x: area.x,
            y: area.y,
            width: area.width,
            height: area.height,
            fill: color(colour),
            stroke: None,
            stroke_width: None,
            opacity: Some(opacity),
        });
    }

    /// Draws the edge of a rectangle.
    pub(super) fn frame(&mut self, area: Area) {
        let (left, right, top, bottom) = (area.x, area.right(), area.y, area.bottom());
        self.elements.push(Primitive::Path(Box::new(PathData {
            d: format!("M {left} {top} L {right} {top} L {right} {bottom} L {left} {bottom} Z"),
            fill: None,
            stroke: color(BLACK),
            stroke_width: WIDTH_FRAME,
            opacity: None,
            stroke_dasharray: None,
        })));
    }

    /// Adds a disc with a thin white rim, which parts it from the curve below.
    pub(super) fn dot(&mut self, centre: (f64, f64), radius: f64, fill: Rgb) {
        for (r, colour) in [(radius + 1.5, WHITE), (radius, fill)] {
            self.elements.push(Primitive::Circle {
                cx: centre.0,
                cy: centre.1,
                r,
                fill: color(colour),
                fill_opacity: None,
                stroke: None,
                stroke_width: None,
            });
        }
    }

    /// Adds a text on the baseline through `at`.
    pub(super) fn text(&mut self, text: &Text, at: (f64, f64), align: Align, colour: Rgb) {
        let mut x = at.0 - align.before(text.width());
        for run in &text.runs {
            self.run(run, x, |x| (x, at.1 + run.drop), None, colour);
            x += run.width();
        }
    }

    /// Adds a text that reads upwards, centred on `at`, its baseline the vertical through `at`.
    pub(super) fn text_upwards(&mut self, text: &Text, at: (f64, f64), colour: Rgb) {
        let mut along = -Align::Middle.before(text.width());
        for run in &text.runs {
            self.run(run, along, |along| (at.0 + run.drop, at.1 - along), Some(-90.0), colour);
            along += run.width();
        }
    }

    fn run(&mut self, run: &Run, along: f64, point: impl Fn(f64) -> (f64, f64), rotate: Option<f64>, colour: Rgb) {
        // SVG drops the spaces that a text starts with, so they are stepped over.
        let trimmed = run.text.trim_start();
        let spaces = Run { text: " ".repeat(run.text.len() - trimmed.len()), ..run.clone() };
        let (x, y) = point(along + spaces.width());
        self.elements.push(Primitive::Text {
            x,
            y,
            // kuva reads dollars as the edges of a formula.
            content: trimmed.replace('$', "\\$"),
            size: run.size,
            anchor: TextAnchor::Start,
            rotate,
            bold: false,
            color: Some(color(colour)),
        });
    }

    /// Adds a tick below `at` and its number.
    pub(super) fn tick_below(&mut self, at: (f64, f64), number: &Text) {
        self.line(at, (at.0, at.1 + TICK_LENGTH), WIDTH_FRAME, BLACK);
        let baseline = at.1 + TICK_LENGTH + 7.0 + number.height();
        self.text(number, (at.0, baseline), Align::Middle, BLACK);
    }

    /// Adds a tick left of `at` and its number.
    pub(super) fn tick_left(&mut self, at: (f64, f64), number: &Text) {
        self.line((at.0 - TICK_LENGTH, at.1), at, WIDTH_FRAME, BLACK);
        let place = (at.0 - TICK_LENGTH - 7.0, at.1 + 0.5 * number.height());
        self.text(number, place, Align::End, BLACK);
    }

    /// Adds a tick right of `at` and its number.
    pub(super) fn tick_right(&mut self, at: (f64, f64), number: &Text) {
        self.line(at, (at.0 + TICK_LENGTH, at.1), WIDTH_FRAME, BLACK);
        let place = (at.0 + TICK_LENGTH + 7.0, at.1 + 0.5 * number.height());
        self.text(number, place, Align::Start, BLACK);
    }

    /// Makes both files.
    pub(super) fn finish(self) -> Result<Picture, PictureError> {
        let mut scene = Scene::new(self.width, self.height);
        scene.background_color = None;
        scene.elements = self.elements;
        let svg = svg(&scene, &self.images)?;
        let mut elements: Vec<Primitive> = self.images.iter().map(rectangles).collect();
        elements.append(&mut scene.elements);
        scene.elements = elements;
        Ok(Picture { svg, png: png(&scene)? })
    }
}

fn color(colour: Rgb) -> Color {
    Color::Rgb(colour[0], colour[1], colour[2])
}

/// The scene as an SVG document with a physical size, its font and its images.
fn svg(scene: &Scene, images: &[Image]) -> Result<String, PictureError> {
    let (width, height) = (scene.width, scene.height);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.2}mm\" height=\"{:.2}mm\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"'DejaVu Sans',Verdana,sans-serif\" stroke-linejoin=\"round\">\n\
         <style>@font-face{{font-family:'DejaVu Sans';src:url('data:font/woff2;base64,{}') format('woff2');}}</style>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n",
        width / DPI * 25.4,
        height / DPI * 25.4,
        base64(FONT),
    );
    for image in images {
        let Area { x, y, width, height } = image.area;
        // Both properties: the second is what browsers know, the first what older viewers know.
        let _ = writeln!(
            svg,
            "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" \
             image-rendering=\"optimizeSpeed\" style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>",
            base64(&image_png(image)?),
        );
    }
    // kuva's opening tag knows neither a physical size nor a view box, so that the picture could not be scaled.
    let drawn = SvgBackend::new().with_pretty(true).render_scene(scene);
    svg.push_str(drawn.split_once('>').map_or("</svg>", |(_, body)| body.trim_start()));
    Ok(svg)
}

/// An image as a PNG of its own, in which a pixel is repeated so often that a viewer's smoothing blurs its edge only.
fn image_png(image: &Image) -> Result<Vec<u8>, PictureError> {
    let rows = image.levels.len() / image.columns;
    let repeat = (400 / image.columns.max(rows)).max(1);
    let mut pixels = Vec::with_capacity(image.levels.len() * repeat * repeat);
    for row in image.levels.chunks_exact(image.columns) {
        let wide: Vec<u8> = row.iter().flat_map(|&level| std::iter::repeat_n(level, repeat)).collect();
        for _ in 0..repeat {
            pixels.extend_from_slice(&wide);
        }
    }
    let palette: Vec<u8> = (0..=LEVEL_BLANK).flat_map(level_colour).collect();
    encode(image.columns * repeat, rows * repeat, &pixels, Some(palette))
}

/// An image as rectangles that end on the pixels of the enlarged PNG.
fn rectangles(image: &Image) -> Primitive {
    let rows = image.levels.len() / image.columns;
    let fine = f64::from(OVERSAMPLING);
    let across = |column: usize| {
        ((image.area.x + image.area.width * column as f64 / image.columns as f64) * fine).round() / fine
    };
    let down = |row: usize| ((image.area.y + image.area.height * row as f64 / rows as f64) * fine).round() / fine;
    let colours: Vec<Color> = (0..=LEVEL_BLANK).map(|level| color(level_colour(level))).collect();
    let (mut x, mut y, mut w, mut h, mut fills) = (Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new());
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
fn png(scene: &Scene) -> Result<Vec<u8>, PictureError> {
    let large = kuva::RasterBackend::new()
        .with_scale(OVERSAMPLING as f32)
        .render_scene(scene)
        .map_err(PictureError::Png)?;
    let (columns, pixels) = decode(&large)?;
    let fine = OVERSAMPLING as usize;
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
        let count = OVERSAMPLING * OVERSAMPLING;
        averaged.extend(sums.iter().flatten().map(|sum| ((sum + count / 2) / count) as u8));
    }
    encode(width, height, &averaged, None)
}

/// The width and the RGBA pixels of a PNG file.
fn decode(file: &[u8]) -> Result<(usize, Vec<u8>), PictureError> {
    let failed = |error: png::DecodingError| PictureError::Png(error.to_string());
    let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().map_err(failed)?;
    let size = reader.output_buffer_size().ok_or_else(|| PictureError::Png("it is too large".to_string()))?;
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
        encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: per_metre, yppu: per_metre, unit }));
    }
    encoder.write_header().and_then(|mut writer| writer.write_image_data(pixels)).map_err(failed)?;
    Ok(file)
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let byte = |index: usize| chunk.get(index).map_or(0, |&byte| u32::from(byte));
        let group = byte(0) << 16 | byte(1) << 8 | byte(2);
        for index in 0..4 {
            let digit = DIGITS[(group >> (18 - 6 * index)) as usize & 63];
            text.push(if index <= chunk.len() { char::from(digit) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_pads() {
        assert_eq!(["", "f", "fo", "foo", "foob"].map(|t| base64(t.as_bytes())), ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg=="]);
    }

    #[test]
    fn levels_span_the_ramp_and_leave_one_for_blank() {
        assert_eq!([0.0, 1.0, 2.0, -1.0, f32::NAN, f32::INFINITY].map(level), [0, 254, 254, 0, 255, 254]);
    }

    #[test]
    fn an_image_has_no_seams() {
        // 7 columns over 50 pixels, all alike but for the level: between them the white ground must not shine through.
        let mut canvas = Canvas::new(60.0, 60.0);
        let levels = (0..49).map(|index| (index % 2) as u8).collect();
        canvas.image(Image { area: Area { x: 5.0, y: 5.0, width: 50.0, height: 50.0 }, columns: 7, levels });
        let (columns, pixels) = decode(&canvas.finish().unwrap().png).unwrap();
        assert_eq!(columns, 60);
        let brightest = (0..50 * 50).map(|index| pixels[((5 + index / 50) * 60 + 5 + index % 50) * 3]).max();
        assert!(brightest < Some(100), "{brightest:?}");
    }
}
