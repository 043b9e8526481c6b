//! Scaling of summaries of records.

use super::summaries::summaries;

/// Summaries of several records in a row.
pub(super) fn summaries_of(curves: &[Vec<f64>]) -> Vec<f64> {
    curves.iter().flat_map(|curve| summaries(curve)).collect()
}

/// Means and standard deviations by which summaries are scaled, and the least and the largest of each in the training.
#[derive(Clone, Debug)]
pub(super) struct Scaling {
    means: Vec<f64>,
    deviations: Vec<f64>,
    ranges: Vec<[f64; 2]>,
}

/// Largest distance of a summary from its mean that counts, in standard deviations: there is no extrapolation to a record
/// outside of the training.
const MAX_AWAY: f64 = 4.0;

impl Scaling {
    pub(super) fn of(rows: &[Vec<f64>]) -> Self {
        let n = rows.len() as f64;
        let d = rows.first().map_or(0, Vec::len);
        let mean = |f: usize| rows.iter().map(|row| row[f]).sum::<f64>() / n;
        let means: Vec<f64> = (0..d).map(mean).collect();
        let deviation = |f: usize| {
            let squares: f64 = rows
                .iter()
                .map(|row| (row[f] - means[f]) * (row[f] - means[f]))
                .sum();
            (squares / n).sqrt()
        };
        let deviations = (0..d).map(deviation).collect();
        let range = |f: usize| {
            let values = rows.iter().map(|row| row[f]);
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
                [low.min(value), high.max(value)]
            })
        };
        Self {
            means,
            deviations,
            ranges: (0..d).map(range).collect(),
        }
    }

    /// How far the summary lies outside of the training that lies farthest outside, over the width of its range there; 0 if all lie
    /// within. Scaled summaries do not tell it, since what is far away is drawn nearer there.
    pub(super) fn outside(&self, row: &[f64]) -> f64 {
        let columns = row.iter().zip(&self.ranges);
        let outside = columns.map(|(value, [low, high])| {
            let beyond = (low - value).max(value - high);
            if high > low && beyond > 0.0 {
                beyond / (high - low)
            } else {
                0.0
            }
        });
        outside.fold(0.0, f64::max)
    }

    /// Summaries in standard deviations from their mean; 0 for those that never differ.
    pub(super) fn scaled(&self, row: &[f64]) -> Vec<f64> {
        let columns = row.iter().zip(&self.means).zip(&self.deviations);
        columns
            .map(|((value, mean), &deviation)| {
                if deviation > 0.0 {
                    ((value - mean) / deviation).clamp(-MAX_AWAY, MAX_AWAY)
                } else {
                    0.0
                }
            })
            .collect()
    }
}
