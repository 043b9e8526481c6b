//! Detection of first rows and columns that are coordinates, not heights.

use slipfront_base::number_format::four_digits;

use super::grid::Line;

/// Least number of points of an axis: fewer heights may be evenly spaced by chance.
const LEAST_POINTS: usize = 8;

/// The first two rows and columns of a map.
#[derive(Default)]
pub(super) struct FirstLines {
    rows: [Vec<f64>; 2],
    columns: [Vec<f64>; 2],
}

impl FirstLines {
    pub(super) fn add(&mut self, line: &Line) {
        if let Some(row) = self.rows.get_mut(line.row) {
            row.extend(line.heights);
        }
        for (column, heights) in self.columns.iter_mut().enumerate() {
            let within = column.checked_sub(line.column);
            heights.extend(within.and_then(|at| line.heights.get(at)));
        }
    }

    /// A sentence on a first row or column that is evenly spaced, if the second is not.
    pub(super) fn axis_warning(&self) -> Option<String> {
        let [rows, columns] = [&self.rows, &self.columns].map(|[first, second]| {
            // The corner, which the row and the column share, belongs to neither.
            let (first, second) = (first.get(1..)?, second.get(1..)?);
            let is_axis = first.len() >= LEAST_POINTS && is_even(first) && !is_even(second);
            is_axis.then(|| [first[0], first[first.len() - 1]])
        });
        let (line, [from, to]) = match (rows, columns) {
            (Some(ends), _) => ("row", ends),
            (None, Some(ends)) => ("column", ends),
            (None, None) => return None,
        };
        Some(format!(
            "its first {line} goes evenly from {} to {}, as coordinates do: remove it, if it has no heights",
            four_digits(from),
            four_digits(to)
        ))
    }
}

/// Whether numbers have equal steps, to a thousandth: coordinates are written with few digits.
fn is_even(numbers: &[f64]) -> bool {
    let step = (numbers[numbers.len() - 1] - numbers[0]) / (numbers.len() - 1).max(1) as f64;
    step != 0.0
        && numbers
            .windows(2)
            .all(|pair| (pair[1] - pair[0] - step).abs() < 1e-3 * step.abs())
}
