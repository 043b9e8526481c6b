//! A series of values as lines on a panel.

use crate::axis::Axis;
use crate::geometry::Point;
use crate::range::drawable;

/// Longer curves are thinned.
const MAX_POINTS: usize = 4000;

/// A curve in pixels: one segment for every stretch without a gap.
pub(crate) fn segments(xs: &[f64], ys: &[f64], x: &Axis, y: &Axis) -> Vec<Vec<Point>> {
    let points: Vec<Point> = xs.iter().copied().zip(ys.iter().copied()).collect();
    points
        .split(|&(at, value)| !drawable(at) || !drawable(value))
        .filter(|segment| !segment.is_empty())
        .map(|segment| {
            let place = |&(at, value): &Point| (x.at(at), y.clamped(value));
            let pixels: Vec<Point> = segment.iter().map(place).collect();
            if xs.len() > MAX_POINTS {
                thinned(&pixels)
            } else {
                pixels
            }
        })
        .collect()
}

/// The first, lowest, highest and last point of every pixel column, in their order.
fn thinned(points: &[Point]) -> Vec<Point> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_the_spikes_and_the_order() {
        let mut points: Vec<Point> = (0..10_000).map(|i| (0.05 * f64::from(i), 100.0)).collect();
        points[4321].1 = 3.0;
        points[4322].1 = 250.0;
        let kept = thinned(&points);
        assert!(kept.len() <= 4 * 500 && kept.contains(&points[4321]) && kept.contains(&points[4322]));
        assert!(kept.first() == points.first() && kept.last() == points.last());
        assert!(kept.is_sorted_by(|a, b| a.0 < b.0));
    }

    #[test]
    fn a_missing_value_leaves_a_gap() {
        let axis = Axis::linear(0.0, 4.0).placed(0.0, 4.0);
        let times = [0.0, 1.0, 2.0, 3.0, 4.0];
        let parts = segments(&times, &[0.0, 1.0, f64::NAN, 3.0, 4.0], &axis, &axis);
        assert_eq!(parts, [[(0.0, 0.0), (1.0, 1.0)], [(3.0, 3.0), (4.0, 4.0)]]);
    }
}
