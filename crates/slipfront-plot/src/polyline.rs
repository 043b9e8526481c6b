//! A series of values as lines on a panel.

use crate::axis::{Axis, drawable};

/// Longer curves are thinned.
const POINTS_KEPT: usize = 4000;

/// The curve in pixels: one piece for every stretch without a gap.
pub(crate) fn segments(times: &[f64], values: &[f64], time: &Axis, axis: &Axis) -> Vec<Vec<(f64, f64)>> {
    let points: Vec<(f64, f64)> = times.iter().copied().zip(values.iter().copied()).collect();
    points
        .split(|&(t, value)| !drawable(t) || !drawable(value))
        .filter(|piece| !piece.is_empty())
        .map(|piece| {
            let pixels: Vec<(f64, f64)> = piece
                .iter()
                .map(|&(t, value)| (time.at(t), axis.clamped(value)))
                .collect();
            if times.len() > POINTS_KEPT {
                thinned(&pixels)
            } else {
                pixels
            }
        })
        .collect()
}

/// The first, lowest, highest and last point of every pixel column, in their order.
fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
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
        let mut points: Vec<(f64, f64)> = (0..10_000).map(|i| (0.05 * f64::from(i), 100.0)).collect();
        points[4321].1 = 3.0;
        points[4322].1 = 250.0;
        let kept = thinned(&points);
        assert!(kept.len() <= 4 * 500 && kept.contains(&points[4321]) && kept.contains(&points[4322]));
        assert!(kept.first() == points.first() && kept.last() == points.last());
        assert!(kept.is_sorted_by(|a, b| a.0 < b.0));
    }

    #[test]
    fn a_missing_value_leaves_a_gap() {
        let axis = Axis {
            lo: 0.0,
            hi: 4.0,
            start: 0.0,
            end: 4.0,
        };
        let times = [0.0, 1.0, 2.0, 3.0, 4.0];
        let parts = segments(&times, &[0.0, 1.0, f64::NAN, 3.0, 4.0], &axis, &axis);
        assert_eq!(parts, [[(0.0, 0.0), (1.0, 1.0)], [(3.0, 3.0), (4.0, 4.0)]]);
    }
}
