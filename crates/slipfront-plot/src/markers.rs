//! Points of a curve, each curve's in its own shape: colours alone do not survive a copier.

use crate::canvas::Canvas;
use crate::geometry::Point;
use crate::style::{Rgb, WHITE};

/// The corners of the shapes after the disc, for a size of 1; all look equally large.
const SHAPES: [&[(f64, f64)]; 4] = [
    &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
    &[(0.0, -1.3), (1.2, 0.8), (-1.2, 0.8)],
    &[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)],
    &[(0.0, 1.3), (-1.2, -0.8), (1.2, -0.8)],
];

/// Draws the marker of curve `index`, with a thin white rim that parts it from the curves below.
pub(crate) fn marker(canvas: &mut Canvas, index: usize, centre: Point, radius: f64, colour: Rgb) {
    let Some(corners) = (index % (SHAPES.len() + 1))
        .checked_sub(1)
        .map(|shape| SHAPES[shape])
    else {
        canvas.dot(centre, radius, colour);
        return;
    };
    for (size, colour) in [(radius + 1.5, WHITE), (radius, colour)] {
        let points = corners
            .iter()
            .map(|(x, y)| (centre.0 + size * x, centre.1 + size * y))
            .collect();
        canvas.polygon(points, colour, 1.0);
    }
}
