//! Outlines as SVG: user units are millimetres, and y points down. A group for each texture, and the edge of
//! the slider.

use std::fmt::Write;

use slipfront::surface::{Contour, Ellipse, Piece};

use super::drawing::{Fill, Layer, OutlineDrawing};

/// Width of the slider's edge over the edge of a block; a program that cuts takes its middle.
const EDGE_WIDTH: f64 = 0.05;

/// The drawing as a page of the slider's size.
pub(super) fn text(drawing: &OutlineDrawing) -> String {
    let [width, height] = drawing.size.map(|blocks| blocks as f64 * drawing.block);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}mm\" height=\"{height}mm\" viewBox=\"0 0 {width} {height}\">\n"
    );
    for layer in &drawing.layers {
        let name = &layer.name;
        svg += &format!("<g id=\"{name}\" fill=\"black\" fill-rule=\"evenodd\">\n");
        svg += &elements(drawing, layer);
        svg += "</g>\n";
    }
    let stroke = EDGE_WIDTH * drawing.block;
    svg += &format!(
        "<rect id=\"SLIDER\" width=\"{width}\" height=\"{height}\" fill=\"none\" stroke=\"black\" stroke-width=\"{stroke}\"/>\n"
    );
    svg + "</svg>\n"
}

fn elements(drawing: &OutlineDrawing, layer: &Layer) -> String {
    let page = SvgPage(drawing);
    match layer.fill {
        // Holes need one path for all.
        Fill::EvenOdd => {
            let paths = layer.contours.iter().map(|contour| page.path(contour));
            let path: Vec<String> = paths.collect();
            format!("<path d=\"{}\"/>\n", path.join(" "))
        }
        Fill::Each => layer
            .contours
            .iter()
            .map(|contour| page.element(contour))
            .collect(),
    }
}

/// The page on which a drawing is laid.
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
        // A string takes every text.
        match contour {
            Contour::Polygon(corners) => {
                for (corner, letter) in corners.iter().zip("M".chars().chain(std::iter::repeat('L'))) {
                    let [x, y] = self.point(*corner);
                    let _ = write!(path, "{letter}{x} {y}");
                }
            }
            Contour::Ellipse(ellipse) => {
                let quarter = |k: u32| std::f64::consts::FRAC_PI_2 * f64::from(k);
                let pieces: Vec<Piece> = (0..4)
                    .map(|k| Piece::Arc(*ellipse, [quarter(k), quarter(k + 1)]))
                    .collect();
                self.add_pieces(&mut path, &pieces);
            }
            Contour::Pieces(pieces) => self.add_pieces(&mut path, pieces),
        }
        path + "Z"
    }

    fn add_pieces(&self, path: &mut String, pieces: &[Piece]) {
        for (at, piece) in pieces.iter().enumerate() {
            let [[x_0, y_0], [x, y]] = piece.ends().map(|end| self.point(end));
            if at == 0 {
                let _ = write!(path, "M{x_0} {y_0}");
            }
            let _ = match piece {
                Piece::Line(_) => write!(path, "L{x} {y}"),
                Piece::Arc(ellipse, _) => {
                    let [a, b] = ellipse.semi_axes.map(|axis| axis * self.0.block);
                    // Counterclockwise, and never more than a quarter.
                    write!(path, "A{a} {b} {} 0 0 {x} {y}", turn(ellipse))
                }
            };
        }
    }
}

/// Degrees from x towards y, which points down.
fn turn(ellipse: &Ellipse) -> f64 {
    0.0 - libm::atan2(ellipse.axis[1], ellipse.axis[0]).to_degrees()
}
