//! Contour lines of a grid of values.

use std::collections::BTreeMap;

use crate::geometry::CanvasPoint;

/// Moving averages over `2 reach + 1` columns and rows around each value, row by row. NaN values are left out
/// of the averages and stay NaN.
pub(crate) fn smoothed(values: &[f32], columns: usize, reach: usize) -> Vec<f32> {
    let rows = values.len() / columns;
    let mean = |(cell, value): (usize, &f32)| {
        if value.is_nan() {
            return f32::NAN;
        }
        let (column, row) = (cell % columns, cell / columns);
        let around = |at: usize, count: usize| at.saturating_sub(reach)..(at + reach + 1).min(count);
        let (mut sum, mut n) = (0.0, 0);
        for row in around(row, rows) {
            for value in &values[row * columns..][around(column, columns)] {
                if !value.is_nan() {
                    sum += f64::from(*value);
                    n += 1;
                }
            }
        }
        (sum / f64::from(n)) as f32
    };
    values.iter().enumerate().map(mean).collect()
}

/// Contour lines at `level` of values that are interpolated linearly between cell centres. Each line is a
/// chain of points, in columns and rows from the centre of the first cell; it is closed if it ends where it
/// starts. Lines do not pass through cells without a value.
pub(crate) fn contours(values: &[f32], columns: usize, level: f64) -> Vec<Vec<CanvasPoint>> {
    let rows = values.len() / columns;
    let value = |column: usize, row: usize| f64::from(values[row * columns + column]);
    // A contour crosses links between neighbouring cell centres. A link is identified by its first cell and
    // by whether it leads upwards.
    let mut links: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for row in 0..rows.saturating_sub(1) {
        for column in 0..columns - 1 {
            let corners = [
                value(column, row),
                value(column + 1, row),
                value(column + 1, row + 1),
                value(column, row + 1),
            ];
            if !corners.iter().all(|value| value.is_finite()) {
                continue;
            }
            let cell = row * columns + column;
            let sides = [2 * cell, 2 * (cell + 1) + 1, 2 * (cell + columns), 2 * cell + 1];
            let above = corners.map(|value| value >= level);
            let crossed: Vec<usize> = (0..4).filter(|&k| above[k] != above[(k + 1) % 4]).collect();
            let pairs = match crossed[..] {
                [one, other] => vec![[one, other]],
                // A saddle: the corners on the same side of the level as its centre are connected.
                [_, _, _, _] if (corners.iter().sum::<f64>() / 4.0 >= level) == above[0] => {
                    vec![[0, 1], [2, 3]]
                }
                [_, _, _, _] => vec![[3, 0], [1, 2]],
                _ => Vec::new(),
            };
            for pair in pairs {
                let [one, other] = pair.map(|k| sides[k]);
                links.entry(one).or_default().push(other);
                links.entry(other).or_default().push(one);
            }
        }
    }
    let point = |side: usize| {
        let (cell, is_upwards) = (side / 2, side % 2 == 1);
        let (column, row) = (cell % columns, cell / columns);
        let next = if is_upwards {
            (column, row + 1)
        } else {
            (column + 1, row)
        };
        let (from, to) = (value(column, row), value(next.0, next.1));
        let share = (level - from) / (to - from);
        let at = |from: usize, to: usize| from as f64 + share * (to - from) as f64;
        (at(column, next.0), at(row, next.1))
    };
    let ends: Vec<usize> = links
        .iter()
        .filter(|(_, to)| to.len() == 1)
        .map(|(side, _)| *side)
        .collect();
    let all: Vec<usize> = links.keys().copied().collect();
    let mut lines = Vec::new();
    // Open lines first: they must be entered at an end.
    for start in ends.into_iter().chain(all) {
        let mut line = vec![point(start)];
        let mut side = start;
        while let Some(next) = links.get_mut(&side).and_then(Vec::pop) {
            if let Some(back) = links.get_mut(&next)
                && let Some(at) = back.iter().position(|&other| other == side)
            {
                back.swap_remove(at);
            }
            line.push(point(next));
            side = next;
        }
        if line.len() > 1 {
            lines.push(line);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(columns: usize, rows: usize, value: impl Fn(f64, f64) -> f64) -> Vec<f32> {
        let cells = 0..columns * rows;
        cells
            .map(|cell| value((cell % columns) as f64, (cell / columns) as f64) as f32)
            .collect()
    }

    #[test]
    fn a_plane_has_one_straight_line_and_a_cone_a_ring() {
        let lines = contours(&grid(9, 7, |x, _| x), 9, 2.25);
        assert_eq!(lines.len(), 1);
        assert_eq!(
            lines[0],
            (0..7).map(|row| (2.25, f64::from(row))).collect::<Vec<_>>()
        );

        let cone = grid(21, 21, |x, y| ((x - 10.0).powi(2) + (y - 10.0).powi(2)).sqrt());
        let lines = contours(&cone, 21, 6.0);
        assert_eq!(lines.len(), 1);
        let ring = &lines[0];
        assert!(ring.len() > 30 && ring.first() == ring.last());
        for (x, y) in ring {
            let radius = ((x - 10.0).powi(2) + (y - 10.0).powi(2)).sqrt();
            // A chord of a cell lies within 1/(8 R) of the circle.
            assert!((radius - 6.0).abs() < 0.03, "{radius}");
        }
    }

    #[test]
    fn a_saddle_is_passed_on_either_side_and_blanks_end_lines() {
        let saddle = [0.0, 1.0, 1.0, 0.0];
        let both = contours(&saddle, 2, 0.4);
        assert_eq!(both.len(), 2);
        // At a level above the value of the centre, the high corners are separate; below it, the low ones
        // are.
        assert_ne!(contours(&saddle, 2, 0.6)[0], both[0]);
        let mut plane = grid(9, 9, |x, _| x);
        plane[4 * 9 + 4] = f32::NAN;
        assert_eq!(contours(&plane, 9, 4.5).len(), 2);
        for (columns, rows) in [(1, 1), (1, 9), (9, 1)] {
            assert!(contours(&grid(columns, rows, |x, y| x + y), columns, 0.5).is_empty());
        }
    }

    #[test]
    fn smoothing_leaves_blanks_blank() {
        let nan = f32::NAN;
        let found = smoothed(&[1.0, nan, 5.0, 3.0, 3.0, nan], 3, 1);
        assert_eq!(found[0], 7.0 / 3.0);
        assert!(found[1].is_nan() && found[5].is_nan());
        assert_eq!(found[2], 4.0);
    }
}
