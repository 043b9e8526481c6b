//! A canvas as a PDF of one page of its physical size: lines and areas as paths, text as text in the embedded
//! font, maps as images. The page has no background, so that the paper shows.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::LineJoinStyle;
use pdf_writer::{Content, Filter, Finish as _, Name, Pdf, Rect, Ref, Str};

use crate::canvas::{Canvas, Element, Primitive};
use crate::color_image::palette;
use crate::geometry::{CanvasPoint, length};
use crate::pdf_font::{FontObjects, PdfFont};
use crate::style::DPI;

/// Points in an inch.
const POINTS: f64 = 72.0;
/// Distance of the control points of a quarter of a circle from its ends, over the radius.
const QUARTER: f64 = 0.552_284_75;
/// Name of the font on the page.
const FONT: Name = Name(b"F");

/// The objects of the file before those of its images.
const CATALOG: Ref = Ref::new(1);
const PAGES: Ref = Ref::new(2);
const PAGE: Ref = Ref::new(3);
const CONTENT: Ref = Ref::new(4);
const OBJECTS: FontObjects = FontObjects {
    font: Ref::new(5),
    glyphs: Ref::new(6),
    descriptor: Ref::new(7),
    file: Ref::new(8),
    characters: Ref::new(9),
};
const FIRST_IMAGE: i32 = 10;

/// The canvas as the bytes of a PDF file.
pub(crate) fn pdf(canvas: &Canvas) -> Vec<u8> {
    let [width, height] = canvas.millimetres().map(|mm| (mm / 25.4 * POINTS) as f32);
    let font = PdfFont::new(canvas);
    let opacities = opacities(canvas);
    let mut pdf = Pdf::new();
    pdf.catalog(CATALOG).pages(PAGES);
    pdf.pages(PAGES).kids([PAGE]).count(1);
    let mut page = pdf.page(PAGE);
    page.media_box(Rect::new(0.0, 0.0, width, height))
        .parent(PAGES)
        .contents(CONTENT);
    let mut resources = page.resources();
    resources.fonts().pair(FONT, OBJECTS.font);
    let mut images = resources.x_objects();
    for index in 0..canvas.images.len() {
        images.pair(Name(image_name(index).as_bytes()), image_object(index));
    }
    images.finish();
    let mut states = resources.ext_g_states();
    for (index, opacity) in opacities.iter().enumerate() {
        states
            .insert(Name(state_name(index).as_bytes()))
            .start::<pdf_writer::writers::ExtGraphicsState<'_>>()
            .non_stroking_alpha(*opacity as f32);
    }
    states.finish();
    resources.finish();
    page.finish();
    font.write(&mut pdf, &OBJECTS, packed);
    for (index, image) in canvas.images.iter().enumerate() {
        let (columns, rows, levels) = image.repeated();
        let levels = packed(&levels);
        let mut object = pdf.image_xobject(image_object(index), &levels);
        object.filter(Filter::FlateDecode);
        object
            .width(columns as i32)
            .height(rows as i32)
            .bits_per_component(8)
            .color_space()
            .indexed(Name(b"DeviceRGB"), 255, &palette().concat());
    }
    let content = content(canvas, height, &font, &opacities);
    pdf.stream(CONTENT, &packed(&content)).filter(Filter::FlateDecode);
    pdf.finish()
}

/// A coordinate of the canvas as it is written.
fn rounded(pixels: f64) -> f32 {
    length(pixels) as f32
}

/// The contents of a stream, compressed.
fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::default());
    // Writing to memory cannot fail.
    let written = packer.write_all(bytes).and_then(|()| packer.finish());
    written.unwrap_or_default()
}

/// The opacities of areas, each once.
fn opacities(canvas: &Canvas) -> Vec<f64> {
    let mut opacities: Vec<f64> = canvas.elements.iter().map(|element| element.opacity).collect();
    opacities.sort_unstable_by(f64::total_cmp);
    opacities.dedup();
    opacities
}

fn image_object(index: usize) -> Ref {
    Ref::new(FIRST_IMAGE + index as i32)
}

fn image_name(index: usize) -> String {
    format!("I{index}")
}

fn state_name(index: usize) -> String {
    format!("S{index}")
}

/// Operators that draw a canvas on a page of this height.
fn content(canvas: &Canvas, height: f32, font: &PdfFont, opacities: &[f64]) -> Vec<u8> {
    let mut content = Content::new();
    // From pixels, y downwards, to points, y upwards.
    let scale = (canvas.scale * POINTS / DPI) as f32;
    content.transform([scale, 0.0, 0.0, -scale, 0.0, height]);
    content.set_line_join(LineJoinStyle::RoundJoin);
    for (index, image) in canvas.images.iter().enumerate() {
        let [x, y, width, height] = image.area.sides().map(rounded);
        content.save_state();
        content.transform([width, 0.0, 0.0, -height, x, y + height]);
        content.x_object(Name(image_name(index).as_bytes()));
        content.restore_state();
    }
    let mut opacity = 1.0;
    for element in &canvas.elements {
        if element.opacity != opacity {
            opacity = element.opacity;
            let state = opacities.iter().position(|known| *known == opacity);
            content.set_parameters(Name(state_name(state.unwrap_or_default()).as_bytes()));
        }
        draw(&mut content, element, font);
    }
    content.finish().into_vec()
}

fn draw(content: &mut Content, element: &Element, font: &PdfFont) {
    let [red, green, blue] = element.colour.map(|channel| f32::from(channel) / 255.0);
    if let Primitive::Line(_) = element.primitive {
        content.set_stroke_rgb(red, green, blue);
    } else {
        content.set_fill_rgb(red, green, blue);
    }
    match &element.primitive {
        Primitive::Line(line) => {
            content.set_line_width(line.width as f32);
            content.set_dash_pattern(line.dashes.iter().map(|&dash| rounded(dash)), 0.0);
            path(content, &line.points);
            if line.closed {
                content.close_path();
            }
            content.stroke();
        }
        Primitive::Polygon(points) => {
            path(content, points);
            content.close_path().fill_nonzero();
        }
        Primitive::Rectangle(area) => {
            let [x, y, width, height] = area.sides().map(rounded);
            content.rect(x, y, width, height).fill_nonzero();
        }
        Primitive::Disc { centre, radius } => disc(content, *centre, *radius),
        Primitive::Letters(letters) => {
            let (x, y) = (rounded(letters.at.0), rounded(letters.at.1));
            let [along, above] = letters.directions();
            content.begin_text().set_font(FONT, letters.size as f32);
            content.set_text_matrix([along[0], along[1], above[0], above[1], x, y]);
            content.show(Str(&font.encoded(&letters.text))).end_text();
        }
    }
}

/// A path through points; points that are not finite are left out.
fn path(content: &mut Content, points: &[CanvasPoint]) {
    let points = points.iter().filter(|(x, y)| x.is_finite() && y.is_finite());
    for (index, &(x, y)) in points.enumerate() {
        if index == 0 {
            content.move_to(rounded(x), rounded(y));
        } else {
            content.line_to(rounded(x), rounded(y));
        }
    }
}

/// A filled circle, in four curves.
fn disc(content: &mut Content, (x, y): CanvasPoint, radius: f64) {
    let at = |across: f64, down: f64| [rounded(x + radius * across), rounded(y + radius * down)];
    let [start_x, start_y] = at(1.0, 0.0);
    content.move_to(start_x, start_y);
    for [across, down] in [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]] {
        // The next quarter ends a right angle further on.
        let [next_across, next_down] = [-down, across];
        let [x1, y1] = at(across + QUARTER * next_across, down + QUARTER * next_down);
        let [x2, y2] = at(next_across + QUARTER * across, next_down + QUARTER * down);
        let [x3, y3] = at(next_across, next_down);
        content.cubic_to(x1, y1, x2, y2, x3, y3);
    }
    content.fill_nonzero();
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;

    use flate2::read::ZlibDecoder;

    use super::*;
    use crate::color_image::Image;
    use crate::geometry::{Align, Area};
    use crate::size::PictureSize;
    use crate::style::{BLACK, CURVES};
    use crate::text::Text;

    /// The streams of a file, inflated.
    fn streams(file: &[u8]) -> Vec<String> {
        let place = |from: usize, words: &[u8]| {
            let found = file[from..].windows(words.len()).position(|at| at == words);
            found.map(|at| from + at)
        };
        let mut streams = Vec::new();
        let mut from = 0;
        while let Some(start) = place(from, b">>\nstream\n").map(|at| at + 10) {
            let mut inflated = Vec::new();
            let mut stream = ZlibDecoder::new(&file[start..]);
            stream.read_to_end(&mut inflated).unwrap();
            streams.push(String::from_utf8_lossy(&inflated).into_owned());
            from = place(start, b"endstream").unwrap();
        }
        streams
    }

    fn canvas(size: PictureSize) -> Canvas {
        let mut canvas = Canvas::sized(size.width(1000.0), 300.0, size);
        canvas.line((1.0, 2.0), (3.25, 4.0), 2.0, BLACK);
        canvas.fill(Area::new(10.0, 20.0, 30.0, 40.0), CURVES[0], 0.25);
        canvas.text(&Text::math("\u{3bc}_s", 33), (50.0, 60.0), Align::Start, BLACK);
        canvas.text_upwards(&Text::plain("\u{4e00}", 33), (70.0, 80.0), Align::Start, BLACK);
        canvas.images.push(Image {
            area: Area::new(100.0, 110.0, 120.0, 130.0),
            columns: 2,
            levels: vec![0, 254],
        });
        canvas
    }

    #[test]
    fn the_page_has_the_size_that_is_asked_for() {
        let size = PictureSize {
            width_mm: Some(89.0),
            font_pt: Some(8.0),
            ..PictureSize::default()
        };
        let file = pdf(&canvas(size));
        let text = String::from_utf8_lossy(&file);
        assert!(text.starts_with("%PDF-1.7") && text.ends_with("%%EOF"));
        // 89 mm are 252.283 pt; 300 pixels are 72.727 pt, because 33 pixels are 8 pt.
        assert!(text.contains("/MediaBox [0 0 252.28346 72.72727]"), "{text}");
        let content = streams(&file).pop().unwrap();
        assert!(
            content.starts_with("0.24242425 0 0 -0.24242425 0 72.72727 cm\n1 j\n"),
            "{content}"
        );
    }

    #[test]
    fn everything_is_drawn_where_it_is() {
        let streams = streams(&pdf(&canvas(PictureSize::default())));
        let content = streams.last().unwrap();
        for drawn in [
            "2 w\n[] 0 d\n1 2 m\n3.25 4 l\nS\n",
            "/S0 gs\n0 0.44705883 0.69803923 rg\n10 20 30 40 re\nf\n/S1 gs\n",
            "120 0 0 -130 100 240 cm\n/I0 Do\n",
            "BT\n/F 33 Tf\n1 0 0 -1 50 60 Tm\n",
            "BT\n/F 33 Tf\n0 -1 -1 0 70 80 Tm\n",
        ] {
            assert!(content.contains(drawn), "{drawn} in {content}");
        }
        // All characters can be searched, also one that the font lacks.
        let characters = streams
            .iter()
            .find(|stream| stream.contains("beginbfchar"))
            .unwrap();
        for pair in ["<0001> <0073>", "<0002> <03BC>", "<0003> <4E00>"] {
            assert!(characters.contains(pair), "{characters}");
        }
    }
}
