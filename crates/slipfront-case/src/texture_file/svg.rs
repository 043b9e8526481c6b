//! Outlines as SVG, with millimetres as user units and y downwards: a layer of its own colour for
//! each texture, and one for the edge of the slider.

use std::fmt::Write;

use slipfront::surface::{Contour, Ellipse, Piece};

use super::drawing::OutlineDrawing;
use crate::arrays::SLIDER_LAYER;

/// Line width of the slider's edge relative to a block edge; a program that cuts follows the centre line.
const EDGE_WIDTH: f64 = 0.05;

/// The drawing as a page of the slider's size.
pub(super) fn text(drawing: &OutlineDrawing) -> String {
    let [width, height] = drawing.size.map(|blocks| blocks as f64 * drawing.block);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"{width}mm\" height=\"{height}mm\" viewBox=\"0 0 {width} {height}\">\n"
    );
    let stroke = EDGE_WIDTH * drawing.block;
    let mut group = |name: &str, fill: &str, line: &str, elements: &str| {
        svg += &format!(
            "<g id=\"{name}\" inkscape:groupmode=\"layer\" inkscape:label=\"{name}\" fill=\"{fill}\" fill-rule=\"evenodd\" \
             stroke=\"{line}\" stroke-width=\"{stroke}\">\n{elements}</g>\n"
        );
    };
    for layer in &drawing.layers {
        let (color, _) = layer.color();
        group(
            &layer.name,
            color,
            color,
            &elements(drawing, layer.nests, &layer.contours),
        );
    }
    group(
        SLIDER_LAYER,
        "none",
        "#000000",
        &elements(drawing, false, &drawing.slider),
    );
    svg + "</svg>\n"
}

fn elements(drawing: &OutlineDrawing, nests: bool, contours: &[Contour]) -> String {
    let page = SvgPage(drawing);
    if !nests {
        return contours.iter().map(|contour| page.element(contour)).collect();
    }
    // Holes need a single path for all outlines.
    let path: Vec<String> = contours.iter().map(|contour| page.path(contour)).collect();
    format!("<path d=\"{}\"/>\n", path.join(" "))
}

/// The page of a drawing.
struct SvgPage<'a>(&'a OutlineDrawing);

impl SvgPage<'_> {
    fn point(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let OutlineDrawing { block, size, .. } = *self.0;
        [x * block, (size[1] as f64 - y) * block]
    }

    fn element(&self, contour: &Contour) -> String {
        let Contour::Ellipse(ellipse) = contour else {
            return format!("<path d=\"{}\"/>\n", self.path(contour));
        };
        let [x, y] = self.point(ellipse.center);
        let [a, b] = ellipse.semi_axes.map(|axis| axis * self.0.block);
        if a == b {
            return format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{a}\"/>\n");
        }
        let turn = match turn(ellipse) {
            0.0 => String::new(),
            degrees => format!(" transform=\"rotate({degrees} {x} {y})\""),
        };
        format!("<ellipse cx=\"{x}\" cy=\"{y}\" rx=\"{a}\" ry=\"{b}\"{turn}/>\n")
    }

    fn path(&self, contour: &Contour) -> String {
        let mut path = String::new();
        let pieces = contour.pieces();
        for (at, piece) in pieces.iter().enumerate() {
            let [[x_0, y_0], [x, y]] = piece.ends().map(|end| self.point(end));
            // Writing to a string cannot fail.
            if at == 0 {
                let _ = write!(path, "M{x_0} {y_0}");
            }
            let _ = match piece {
                // Closing the path draws the last line.
                Piece::Line(_) if at + 1 == pieces.len() => Ok(()),
                Piece::Line(_) => write!(path, "L{x} {y}"),
                Piece::Arc(ellipse, [from, to]) => {
                    let [a, b] = ellipse.semi_axes.map(|axis| axis * self.0.block);
                    // Arcs are never more than a quarter turn. Because y points down, a sweep of 1 is
                    // clockwise.
                    let sweep = u8::from(from > to);
                    write!(path, "A{a} {b} {} 0 {sweep} {x} {y}", turn(ellipse))
                }
            };
        }
        path + "Z"
    }
}

/// Rotation in degrees from x towards y, which points down.
fn turn(ellipse: &Ellipse) -> f64 {
    0.0 - libm::atan2(ellipse.axis[1], ellipse.axis[0]).to_degrees()
}
