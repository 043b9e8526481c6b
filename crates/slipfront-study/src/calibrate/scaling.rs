//! Scaling of summaries of records.

use super::summaries::summaries;

/// Summaries of several records in a row.
pub(super) fn summaries_of(curves: &[Vec<f64>]) -> Vec<f64> {
    curves.iter().flat_map(|curve| summaries(curve)).collect()
}

/// Means and standard deviations by which summaries are scaled.
#[derive(Clone, Debug)]
pub(super) struct Scaling {
    means: Vec<f64>,
    deviations: Vec<f64>,
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
        Self { means, deviations }
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
