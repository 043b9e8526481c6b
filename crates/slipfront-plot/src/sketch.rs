//! A sketch: lines, areas and arrows with names, all on one scale.

use serde::{Deserialize, Serialize};

use crate::canvas::Canvas;
use crate::geometry::{Align, CanvasPoint};
use crate::picture::Picture;
use crate::picture_error::PictureError;
use crate::style::{
    BLACK, BLANK, COLUMN_WIDTH, CURVES, GREY, MARGIN, SIZE_TEXT, WIDTH_CURVE, WIDTH_FRAME, WIDTH_MARK,
};
use crate::text::Text;

/// Length of an arrow's head, in pixels.
const HEAD: f64 = 24.0;

/// Lines and names, y upwards; later ones cover earlier ones.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sketch {
    /// Lines of the sketch.
    pub strokes: Vec<Stroke>,
    /// Names and the points that they are centred on; the character after an underscore is a subscript.
    pub labels: Vec<(String, [f64; 2])>,
}

/// A line through points, or the area that it encloses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stroke {
    /// Style of the stroke.
    pub style: StrokeStyle,
    /// Points of the stroke.
    pub points: Vec<[f64; 2]>,
}

/// Style of a stroke.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum StrokeStyle {
    /// An area with its edge, in the first colour of curves.
    Area,
    /// An area with its edge, in grey, that covers what lies below.
    Body,
    /// A line in this colour of curves.
    Line(usize),
    /// A thin grey line.
    Thin,
    /// A black line with a head at its end.
    Arrow,
}

/// Draws a sketch as wide as a journal's column (85 mm).
///
/// # Errors
///
/// No line, or lines without extent.
pub fn sketch(sketch: &Sketch) -> Result<Picture, PictureError> {
    let points = sketch.strokes.iter().flat_map(|stroke| &stroke.points);
    let points = points.chain(sketch.labels.iter().map(|(_, at)| at));
    let ends = |axis: usize| {
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        let along = points.clone().map(|point| point[axis]);
        along.fold(ends, |(low, high), at| (low.min(at), high.max(at)))
    };
    let ((left, right), (bottom, top)) = (ends(0), ends(1));
    if !(right - left > 0.0 && top - bottom > 0.0) {
        return Err(PictureError::Nothing("line"));
    }
    // Names are centred on their points and may extend half of their width beyond the outermost line.
    let edge = MARGIN + f64::from(SIZE_TEXT);
    let scale = (COLUMN_WIDTH - 2.0 * edge) / (right - left);
    let place = |&[x, y]: &[f64; 2]| (edge + scale * (x - left), edge + scale * (top - y));
    let mut canvas = Canvas::new(COLUMN_WIDTH, 2.0 * edge + scale * (top - bottom));
    for stroke in &sketch.strokes {
        draw(
            &mut canvas,
            stroke.style,
            stroke.points.iter().map(place).collect(),
        );
    }
    for (name, at) in &sketch.labels {
        let text = Text::math(name, SIZE_TEXT);
        let (x, y) = place(at);
        canvas.text(&text, (x, y + 0.5 * text.height()), Align::Middle, BLACK);
    }
    canvas.finish()
}

fn draw(canvas: &mut Canvas, style: StrokeStyle, mut points: Vec<CanvasPoint>) {
    match style {
        StrokeStyle::Area => canvas.edged_area(points, CURVES[0], 0.25, CURVES[0]),
        StrokeStyle::Body => canvas.edged_area(points, BLANK, 1.0, BLACK),
        StrokeStyle::Line(colour) => canvas.polyline(points, WIDTH_CURVE, CURVES[colour % CURVES.len()]),
        StrokeStyle::Thin => canvas.polyline(points, WIDTH_FRAME, GREY),
        StrokeStyle::Arrow => {
            if let [.., from, to] = points[..] {
                let length = libm::hypot(to.0 - from.0, to.1 - from.1);
                let (x, y) = (HEAD * (to.0 - from.0) / length, HEAD * (to.1 - from.1) / length);
                let side = |turn: f64| (to.0 - x + turn * y, to.1 - y - turn * x);
                canvas.polygon(vec![to, side(0.35), side(-0.35)], BLACK, 1.0);
                // The line ends within the head, so that the tip stays sharp.
                points.pop();
                points.push((to.0 - 0.5 * x, to.1 - 0.5 * y));
            }
            canvas.polyline(points, WIDTH_MARK, BLACK);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_areas_arrows_and_names_are_drawn_on_one_scale() {
        let stroke = |style, points: &[[f64; 2]]| Stroke {
            style,
            points: points.to_vec(),
        };
        let drawn = Sketch {
            strokes: vec![
                stroke(StrokeStyle::Area, &[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0]]),
                stroke(StrokeStyle::Arrow, &[[0.0, 0.0], [0.0, 1.0]]),
            ],
            labels: vec![("k_1".to_owned(), [1.0, 0.5])],
        };
        let picture = sketch(&drawn).unwrap();
        // A filled area and its edge; a head and its line.
        assert_eq!(picture.svg.matches("<path").count(), 4);
        assert!(picture.svg.contains(">k</text>") && picture.svg.contains(">1</text>"));
        assert!(sketch(&Sketch::default()).is_err());
    }
}
