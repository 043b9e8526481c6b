//! A canvas as an SVG document.

use std::fmt::Write as _;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD as BASE64;

use crate::canvas::{Canvas, Element, Primitive};
use crate::color_image::{Image, palette};
use crate::font::WOFF2;
use crate::geometry::{Area, CanvasPoint, length};
use crate::picture_error::PictureError;
use crate::png_file;
use crate::style::Rgb;

/// The canvas as an SVG document with a physical size, its font and its images.
pub(crate) fn svg(canvas: &Canvas) -> Result<String, PictureError> {
    let [width, height] = [canvas.width, canvas.height].map(length);
    let [width_mm, height_mm] = canvas.millimetres();
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width_mm:.2}mm\" height=\"{height_mm:.2}mm\" \
         viewBox=\"0 0 {width} {height}\" \
         font-family=\"'DejaVu Sans',Verdana,sans-serif\" stroke-linejoin=\"round\">\n\
         <style>@font-face{{font-family:'DejaVu Sans';\
         src:url('data:font/woff2;base64,{}') format('woff2');}}</style>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n",
        BASE64.encode(WOFF2),
    );
    for image in &canvas.images {
        svg += &image_tag(image)?;
    }
    for element in &canvas.elements {
        svg += &tag(element);
    }
    svg += "</svg>\n";
    Ok(svg)
}

/// One line of the document.
fn tag(element: &Element) -> String {
    let colour = hex(element.colour);
    let fill = match element.opacity {
        1.0 => format!("fill=\"{colour}\""),
        opacity => format!("fill=\"{colour}\" fill-opacity=\"{opacity}\""),
    };
    match &element.primitive {
        Primitive::Line(line) => {
            let data = path_data(&line.points) + if line.closed { "Z" } else { "" };
            let width = line.width;
            let lengths: Vec<String> = line.dashes.iter().map(f64::to_string).collect();
            let dashed = match lengths.join(" ") {
                none if none.is_empty() => none,
                lengths => format!(" stroke-dasharray=\"{lengths}\""),
            };
            format!(
                "<path d=\"{data}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"{dashed}/>\n"
            )
        }
        Primitive::Polygon(points) => format!("<path d=\"{}Z\" {fill}/>\n", path_data(points)),
        Primitive::Rectangle(area) => format!("<rect {} {fill}/>\n", sides(area)),
        Primitive::Disc { centre, radius } => {
            let [x, y, radius] = [centre.0, centre.1, *radius].map(length);
            format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" {fill}/>\n")
        }
        Primitive::Letters(letters) => {
            let (x, y, size) = (length(letters.at.0), length(letters.at.1), letters.size);
            let turn = if letters.upwards {
                format!(" transform=\"rotate(-90 {x} {y})\"")
            } else {
                String::new()
            };
            let text = escaped(&letters.text);
            format!("<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\"{turn} {fill}>{text}</text>\n")
        }
    }
}

/// An image scaled to its area. Cells are pixels, because neighbouring rectangles leave hairline seams
/// between them in most viewers.
fn image_tag(image: &Image) -> Result<String, PictureError> {
    // Sets both properties: browsers support the second one, older viewers the first one.
    Ok(format!(
        "<image {} preserveAspectRatio=\"none\" image-rendering=\"optimizeSpeed\" \
         style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>\n",
        sides(&image.area),
        BASE64.encode(image_png(image)?),
    ))
}

/// An image as a separate PNG.
fn image_png(image: &Image) -> Result<Vec<u8>, PictureError> {
    let (columns, rows, levels) = image.repeated();
    png_file::encode(columns, rows, &levels, Some(palette().concat()))
}

/// The data of a path through points: after the first pair of coordinates, each is the end of a line.
fn path_data(points: &[CanvasPoint]) -> String {
    let mut data = String::new();
    for (x, y) in points {
        let before = if data.is_empty() { 'M' } else { ' ' };
        let _ = write!(data, "{before}{} {}", length(*x), length(*y));
    }
    data
}

fn sides(area: &Area) -> String {
    let [x, y, width, height] = area.sides().map(length);
    format!("x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"")
}

fn hex([red, green, blue]: Rgb) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// A text, escaped for XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        // The only two characters, apart from control characters, that XML does not allow.
        .replace(['\u{fffe}', '\u{ffff}'], "\u{fffd}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Align;
    use crate::style::{BLACK, CURVES};
    use crate::text::Text;

    fn drawn(draw: impl Fn(&mut Canvas)) -> String {
        let mut canvas = Canvas::new(300.0, 150.0);
        draw(&mut canvas);
        let svg = svg(&canvas).unwrap();
        let (_, body) = svg.split_once("fill=\"#ffffff\"/>\n").unwrap();
        body.strip_suffix("</svg>\n").unwrap().to_string()
    }

    const AREA: Area = Area {
        x: 1.0,
        y: 2.5,
        width: 30.0,
        height: 40.125,
    };

    #[test]
    fn the_document_has_a_physical_size_and_its_font() {
        let svg = svg(&Canvas::new(300.0, 150.0)).unwrap();
        assert!(svg.starts_with(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"25.40mm\" height=\"12.70mm\" viewBox=\"0 0 300 150\" "
        ));
        assert!(svg.contains("src:url('data:font/woff2;base64,d09GMg"));
    }

    #[test]
    fn lines_are_open_or_closed() {
        assert_eq!(
            drawn(|canvas| canvas.line((0.0, 1.25), (10.004, -0.001), 2.0, BLACK)),
            "<path d=\"M0 1.25 10 0\" fill=\"none\" stroke=\"#1a1a1a\" stroke-width=\"2\"/>\n"
        );
        assert_eq!(
            drawn(|canvas| canvas.polyline(
                vec![(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 0.0)],
                2.5,
                CURVES[0]
            )),
            "<path d=\"M0 0 4 0 4 4Z\" fill=\"none\" stroke=\"#0072b2\" stroke-width=\"2.5\"/>\n"
        );
        assert_eq!(
            drawn(|canvas| canvas.frame(AREA)),
            "<path d=\"M1 2.5 31 2.5 31 42.63 1 42.63Z\" fill=\"none\" stroke=\"#1a1a1a\" stroke-width=\"2\"/>\n"
        );
    }

    #[test]
    fn areas_are_filled() {
        assert_eq!(
            drawn(|canvas| canvas.fill(AREA, CURVES[1], 0.25)),
            "<rect x=\"1\" y=\"2.5\" width=\"30\" height=\"40.13\" fill=\"#d55e00\" fill-opacity=\"0.25\"/>\n"
        );
        assert_eq!(
            drawn(|canvas| canvas.polygon(vec![(0.0, 0.0), (4.0, 0.0), (2.0, 3.0)], CURVES[1], 1.0)),
            "<path d=\"M0 0 4 0 2 3Z\" fill=\"#d55e00\"/>\n"
        );
        assert_eq!(
            drawn(|canvas| canvas.dot((5.0, 6.0), 7.0, BLACK)),
            "<circle cx=\"5\" cy=\"6\" r=\"8.5\" fill=\"#ffffff\"/>\n\
             <circle cx=\"5\" cy=\"6\" r=\"7\" fill=\"#1a1a1a\"/>\n"
        );
    }

    #[test]
    fn texts_keep_their_characters_and_may_read_upwards() {
        assert_eq!(
            drawn(|canvas| canvas.text(&Text::plain("a < b & c", 30), (10.0, 20.0), Align::Start, BLACK)),
            "<text x=\"10\" y=\"20\" font-size=\"30\" fill=\"#1a1a1a\">a &lt; b &amp; c</text>\n"
        );
        assert_eq!(
            drawn(|canvas| canvas.text_upwards(&Text::plain("0", 32), (10.0, 20.0), Align::End, BLACK)),
            "<text x=\"10\" y=\"40.36\" font-size=\"32\" transform=\"rotate(-90 10 40.36)\" fill=\"#1a1a1a\">0</text>\n"
        );
    }

    #[test]
    fn an_image_fills_its_area() {
        let svg = drawn(|canvas| {
            canvas.images.push(Image {
                area: AREA,
                columns: 2,
                levels: vec![0, 254],
            });
        });
        assert!(svg.starts_with(
            "<image x=\"1\" y=\"2.5\" width=\"30\" height=\"40.13\" preserveAspectRatio=\"none\" "
        ));
        assert!(svg.contains("href=\"data:image/png;base64,iVBORw0KGgo") && svg.ends_with("\"/>\n"));
    }
}
