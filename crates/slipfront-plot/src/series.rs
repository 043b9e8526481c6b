//! Parts of a drawn series of values: lines with gaps, markers and error bars.

use crate::axis::{DrawnAxis, drawable};
use crate::canvas::Canvas;
use crate::geometry::CanvasPoint;
use crate::style::{BLACK, Rgb, WHITE, WIDTH_MARK};

/// Number of points above which curves are thinned.
const MAX_POINTS: usize = 4000;

/// A curve in pixels: one segment for every stretch without a gap.
pub(crate) fn segments(
    points: impl Iterator<Item = (f64, f64)>,
    x: &DrawnAxis,
    y: &DrawnAxis,
) -> Vec<Vec<CanvasPoint>> {
    let points: Vec<(f64, f64)> = points.collect();
    let pixel = |&(at, value): &(f64, f64)| (x.at(at), y.clamped(value));
    let pixels = |segment: &[(f64, f64)]| {
        let pixels: Vec<CanvasPoint> = segment.iter().map(pixel).collect();
        let is_long = points.len() > MAX_POINTS;
        if is_long { thinned(&pixels) } else { pixels }
    };
    let segments = points.split(|&(at, value)| !drawable(at) || !drawable(value));
    segments
        .filter(|segment| !segment.is_empty())
        .map(pixels)
        .collect()
}

/// The first, lowest, highest and last point of every pixel column, in their order.
fn thinned(points: &[CanvasPoint]) -> Vec<CanvasPoint> {
    let mut kept = Vec::new();
    for column in points.chunk_by(|a, b| a.0.floor() == b.0.floor()) {
        let by_height = |&a: &usize, &b: &usize| column[a].1.total_cmp(&column[b].1);
        let lowest = (0..column.len()).min_by(by_height).unwrap_or(0);
        let highest = (0..column.len()).max_by(by_height).unwrap_or(0);
        let mut chosen = vec![0, lowest, highest, column.len() - 1];
        chosen.sort_unstable();
        chosen.dedup();
        kept.extend(chosen.into_iter().map(|index| column[index]));
    }
    kept
}

/// The corners of the markers after the disc, for a size of 1; all look equally large.
const MARKERS: [&[CanvasPoint]; 4] = [
    &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
    &[(0.0, -1.3), (1.2, 0.8), (-1.2, 0.8)],
    &[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)],
    &[(0.0, 1.3), (-1.2, -0.8), (1.2, -0.8)],
];

/// Draws the marker of curve `index`, in a shape of its own because colours do not survive a copier, with a
/// thin white rim that separates it from the curves below.
pub(crate) fn marker(canvas: &mut Canvas, index: usize, (x, y): CanvasPoint, radius: f64, colour: Rgb) {
    let Some(shape) = (index % (MARKERS.len() + 1)).checked_sub(1) else {
        return canvas.dot((x, y), radius, colour);
    };
    for (size, colour) in [(radius + 1.5, WHITE), (radius, colour)] {
        let corner = |&(across, down): &CanvasPoint| (x + size * across, y + size * down);
        canvas.polygon(MARKERS[shape].iter().map(corner).collect(), colour, 1.0);
    }
}

/// Draws the cross of a marked point.
pub(crate) fn cross(canvas: &mut Canvas, (x, y): CanvasPoint) {
    /// Length of an arm of the cross.
    const ARM: f64 = 9.0;
    for slope in [ARM, -ARM] {
        canvas.line((x - ARM, y - slope), (x + ARM, y + slope), WIDTH_MARK, BLACK);
    }
}

/// Draws an error bar from one pixel of y to another.
pub(crate) fn error_bar(canvas: &mut Canvas, x: f64, low: f64, high: f64, colour: Rgb) {
    /// Length of the lines across the ends to each side.
    const CAP: f64 = 9.0;
    canvas.line((x, low), (x, high), WIDTH_MARK, colour);
    for y in [low, high] {
        canvas.line((x - CAP, y), (x + CAP, y), WIDTH_MARK, colour);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_the_spikes_and_the_order() {
        let mut points: Vec<CanvasPoint> = (0..10_000).map(|i| (0.05 * f64::from(i), 100.0)).collect();
        points[4321].1 = 3.0;
        points[4322].1 = 250.0;
        let kept = thinned(&points);
        assert!(kept.len() <= 4 * 500 && kept.contains(&points[4321]) && kept.contains(&points[4322]));
        assert!(kept.first() == points.first() && kept.last() == points.last());
        assert!(kept.is_sorted_by(|a, b| a.0 < b.0));
    }

    #[test]
    fn a_missing_value_leaves_a_gap() {
        let axis = DrawnAxis::linear(0.0, 4.0).placed(0.0, 4.0);
        let points = [(0.0, 0.0), (1.0, 1.0), (2.0, f64::NAN), (3.0, 3.0), (4.0, 4.0)];
        let parts = segments(points.into_iter(), &axis, &axis);
        assert_eq!(parts, [[(0.0, 0.0), (1.0, 1.0)], [(3.0, 3.0), (4.0, 4.0)]]);
    }
}
