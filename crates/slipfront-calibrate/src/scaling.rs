//! Scaling of features of records.

use slipfront_run::measured::Measure;

use crate::features::{features, level};
use crate::sample_points::SamplePoints;
use crate::training::Training;

/// Units of friction in the features of several records: 1 for a coefficient, and the mean of the training
/// for a force. Forces may be nanonewtons or meganewtons, while the lower bounds of features are fixed small
/// numbers in these units.
pub(crate) fn units_of_friction(training: &Training, grids: &[SamplePoints]) -> Vec<f64> {
    let mean = |record: usize| {
        let levels = training.curves.iter().map(|curves| level(&curves[record]).abs());
        levels.sum::<f64>() / training.curves.len() as f64
    };
    let units = grids
        .iter()
        .enumerate()
        .map(|(record, grid)| match grid.quantity {
            Measure::Force => mean(record),
            _ => 1.0,
        });
    // Without friction, do not divide by a mean of 0.
    units.map(|unit| if unit > 0.0 { unit } else { 1.0 }).collect()
}

/// Features of several records, concatenated, with friction in these units.
pub(crate) fn features_of(curves: &[Vec<f64>], units: &[f64]) -> Vec<f64> {
    let records = curves.iter().zip(units);
    let in_units = records.map(|(curve, unit)| curve.iter().map(|y| y / unit).collect::<Vec<f64>>());
    in_units.flat_map(|curve| features(&curve)).collect()
}

/// Means and standard deviations for scaling features.
#[derive(Clone, Debug)]
pub(crate) struct Scaling {
    means: Vec<f64>,
    deviations: Vec<f64>,
}

/// Limit of the distance of a feature from its mean, in standard deviations: no extrapolation to a record
/// outside of the training.
const MAX_AWAY: f64 = 4.0;

impl Scaling {
    pub(crate) fn from_rows(rows: &[Vec<f64>]) -> Self {
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

    /// Features in standard deviations from their mean; 0 for constant ones.
    pub(crate) fn scaled(&self, row: &[f64]) -> Vec<f64> {
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
