//! Predictions of the calibrated model for the records: runs at points that are drawn from the estimate.

use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use crate::normals::{Stream, noisy, normals};
use crate::set_up::{Curves, SetUp};
use crate::summaries::quantiles;
use slipfront_study::{StudyError, TrainingError};

/// Number of the surface of the first run; training draws from 1 on.
const FIRST_SURFACE: u64 = 1 << 32;

/// Number of runs from which a band is made.
pub(crate) const PREDICTED: usize = 60;

/// Shares of the runs below the lines of a band.
const LINES: [f64; 3] = [0.05, 0.5, 0.95];

/// Friction of a record as the calibrated model has it, noise included: 90 % of the runs at every place, and
/// their median.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Band {
    pub(crate) low: Vec<f64>,
    pub(crate) median: Vec<f64>,
    pub(crate) high: Vec<f64>,
}

impl Band {
    fn of(curves: &[&Vec<f64>]) -> Self {
        let places = curves.first().map_or(0, |curve| curve.len());
        let lines = (0..places).map(|place| {
            let values: Vec<f64> = curves.iter().map(|curve| curve[place]).collect();
            quantiles(&values, LINES)
        });
        let lines: Vec<[f64; 3]> = lines.collect();
        let [low, median, high] = [0, 1, 2].map(|line| lines.iter().map(|lines| lines[line]).collect());
        Self { low, median, high }
    }

    /// Share of the values of a record that lie within the band, %.
    pub(crate) fn holds_percent(&self, record: &[f64]) -> f64 {
        let ends = self.low.iter().zip(&self.high);
        let within = record
            .iter()
            .zip(ends)
            .filter(|(y, (low, high))| (**low..=**high).contains(*y));
        100.0 * within.count() as f64 / record.len() as f64
    }
}

/// The bands of all records at these points of the ranges; `noise` is that of a value, as a share of the mean
/// friction.
pub(crate) fn bands(
    set_up: &SetUp,
    points: &[Vec<f64>],
    noise: f64,
    stop: &AtomicBool,
) -> Result<Vec<Band>, StudyError> {
    let curves: Vec<Result<Option<Curves>, TrainingError>> = points
        .par_iter()
        .enumerate()
        .with_max_len(1)
        .map(|(run, point)| {
            let curves = set_up.curves(point, FIRST_SURFACE + run as u64, stop)?;
            let with_noise = |curves: Curves| {
                let records = curves.iter().zip(&set_up.conditions).enumerate();
                let noisy = records.map(|(record, (curve, conditions))| {
                    let noise = noise * conditions.grid.noise_share();
                    noisy(curve, noise, normals(Stream::Predicted, run, record))
                });
                noisy.collect()
            };
            Ok(curves.map(with_noise))
        })
        .collect();
    let curves: Option<Vec<Curves>> = curves.into_iter().collect::<Result<_, _>>()?;
    let curves = curves.ok_or(StudyError::Interrupted)?;
    let band = |record: usize| {
        let of_record: Vec<&Vec<f64>> = curves.iter().map(|curves| &curves[record]).collect();
        Band::of(&of_record)
    };
    Ok((0..set_up.conditions.len()).map(band).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_holds_nine_tenths() {
        let curves: Vec<Vec<f64>> = (0..=100).map(|k| vec![f64::from(k), 7.0]).collect();
        let band = Band::of(&curves.iter().collect::<Vec<_>>());
        assert_eq!((band.low[0], band.median[0], band.high[0]), (5.0, 50.0, 95.0));
        assert_eq!(band.holds_percent(&[4.0, 7.0]), 50.0);
    }
}
