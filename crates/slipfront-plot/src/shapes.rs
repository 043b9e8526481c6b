//! Outlines of cavities, side by side.

use serde::{Deserialize, Serialize};

use crate::canvas::Canvas;
use crate::geometry::Align;
use crate::picture::Picture;
use crate::picture_error::PictureError;
use crate::style::{BLACK, COLUMN_WIDTH, CURVES, MARGIN, SIZE_TEXT};
use crate::text::Text;

const COLUMNS: usize = 3;
const GAP: f64 = 20.0;

/// A closed outline.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Shape {
    /// Name of the outline, below it.
    pub label: String,
    /// Corners of the outline, y upwards.
    pub points: Vec<[f64; 2]>,
}

/// Draws outlines three in a row on one scale, as wide as a journal's column (85 mm).
///
/// # Errors
///
/// No outline, or an outline without extent.
pub fn shapes(shapes: &[Shape]) -> Result<Picture, PictureError> {
    let reach = shapes
        .iter()
        .flat_map(|shape| shape.points.iter().flatten())
        .fold(0.0, |reach: f64, &at| reach.max(at.abs()));
    if shapes.is_empty() || reach.is_nan() || reach <= 0.0 {
        return Err(PictureError::Nothing("outline"));
    }
    let room = ((COLUMN_WIDTH - 2.0 * MARGIN + GAP) / COLUMNS as f64 - GAP).round();
    let label_room = 1.9 * f64::from(SIZE_TEXT);
    let scale = 0.47 * room / reach;
    // A row is no higher than its highest outline.
    let rows: Vec<f64> = shapes
        .chunks(COLUMNS)
        .map(|row| {
            let heights = row.iter().flat_map(|shape| &shape.points).map(|[_, y]| y.abs());
            (2.0 * scale * heights.fold(0.0, f64::max)).round() + GAP
        })
        .collect();
    let height = rows.iter().map(|row| row + label_room).sum::<f64>();
    let mut canvas = Canvas::new(COLUMN_WIDTH, 2.0 * MARGIN + height);
    let mut top = MARGIN;
    for (row, height) in shapes.chunks(COLUMNS).zip(rows) {
        for (column, shape) in row.iter().enumerate() {
            let x = MARGIN + column as f64 * (room + GAP) + 0.5 * room;
            let y = top + 0.5 * height;
            let points = shape
                .points
                .iter()
                .map(|[px, py]| (x + scale * px, y - scale * py));
            canvas.edged_area(points.collect(), CURVES[0], 0.25, CURVES[0]);
            let label = Text::shortened(&shape.label, SIZE_TEXT, room + GAP);
            let baseline = top + height + f64::from(SIZE_TEXT);
            canvas.text(&label, (x, baseline), Align::Middle, BLACK);
        }
        top += height + label_room;
    }
    canvas.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_outline_is_filled_edged_and_named() {
        let square = |label: &str| Shape {
            label: label.to_owned(),
            points: vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]],
        };
        let svg = shapes(&[square("a"), square("b")]).unwrap().svg;
        // A filled area and an edge each.
        assert_eq!(svg.matches("<path").count(), 4);
        assert!(svg.contains(">a</text>") && svg.contains(">b</text>"));
        assert!(shapes(&[]).is_err() && shapes(&[Shape::default()]).is_err());
    }
}
