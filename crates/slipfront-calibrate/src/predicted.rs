//! Predictions of the calibrated model for the records: runs at points that are drawn from the estimate, and
//! how the records compare with them.

use rayon::prelude::*;
use serde::Serialize;
use slipfront_regression::distance_from;

use crate::features::{checked, checked_groups, level, quantiles};
use crate::progress::CalibrationStage;
use crate::runs::{RunMaker, Runs};
use crate::set_up::{Curves, SetUp};
use crate::synthetic_noise::{Stream, normals};
use slipfront_study::StudyError;

/// Number of the surface of the first run; those of training count from 1.
const FIRST_SURFACE: u64 = 1 << 32;

/// Number of runs of a prediction.
pub(crate) const PREDICTED: usize = 120;

/// Quantiles of the runs at the lines of a band.
const LINES: [f64; 3] = [0.05, 0.5, 0.95];

/// Share of good records that the comparison refuses, at most.
const REFUSED: f64 = 0.02;

/// Number of the nearest runs from which a distance between curves is taken.
const NEAREST: usize = 3;

/// Runs of the calibrated model, noise included.
#[derive(Clone, Debug)]
pub struct Predicted {
    /// Points of the ranges, for every run.
    pub(crate) points: Vec<Vec<f64>>,
    /// Friction of every record, for every run.
    pub(crate) curves: Vec<Curves>,
    /// Number of halvings of the time step of the case.
    pub(crate) halvings: u32,
}

/// Friction of the calibrated model for a record, noise included: the central 90 % of the runs at every
/// sample point, and their median.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FrictionBand {
    pub(crate) low: Vec<f64>,
    pub(crate) median: Vec<f64>,
    pub(crate) high: Vec<f64>,
}

/// Comparison of records with the runs of the calibrated model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Share of the runs that are at least as far from the others as the records are.
    pub rank: f64,
    /// Distance of the records from the runs, over the median distance of the runs.
    pub distance: f64,
    /// The groups of numbers in which the records differ most from the runs: names in words, and the mean
    /// square of their distances in standard deviations of the runs.
    pub differs_in: Vec<(&'static str, f64)>,
}

impl Comparison {
    /// Whether the records differ from those of the calibrated model.
    pub fn is_refused(&self) -> bool {
        self.rank < REFUSED
    }
}

impl FrictionBand {
    fn from_curves(curves: &[&Vec<f64>]) -> Self {
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

impl Predicted {
    /// Makes runs at these points of the ranges; `noise` is that of a value, as a share of the mean friction.
    ///
    /// # Errors
    /// When a run cannot be made or kept, and after a stop.
    pub fn run(
        maker: &mut RunMaker,
        stage: CalibrationStage,
        set_up: &SetUp,
        points: Vec<Vec<f64>>,
        noise: f64,
    ) -> Result<Self, StudyError> {
        let curves = maker.curves(stage, &Runs::new(set_up, &points, FIRST_SURFACE))?;
        let with_noise = |(run, curves): (usize, Curves)| {
            let records = curves.iter().zip(&set_up.conditions).enumerate();
            let noisy = records.map(|(record, (curve, conditions))| {
                let normals = normals(Stream::Predicted, run, record);
                conditions.grid.noisy(curve, noise, normals)
            });
            noisy.collect()
        };
        let curves = curves.into_par_iter().enumerate().map(with_noise).collect();
        Ok(Self {
            points,
            curves,
            halvings: set_up.halvings,
        })
    }

    /// The bands of all records.
    pub(crate) fn bands(&self) -> Vec<FrictionBand> {
        let records = self.curves.first().map_or(0, Vec::len);
        let band = |record: usize| {
            let of_record: Vec<&Vec<f64>> = self.curves.iter().map(|curves| &curves[record]).collect();
            FrictionBand::from_curves(&of_record)
        };
        (0..records).map(band).collect()
    }

    /// Compares records with the runs, by numbers that are mostly not used in the estimate.
    pub fn compare(&self, records: &[Vec<f64>]) -> Comparison {
        let (rows, own) = self.all_numbers(records);
        let found = distance_from(&rows, &self.points, &own.concat());
        let names: Vec<&'static str> = checked_groups().chain([CURVE]).collect();
        let mut begin = 0;
        let mut differs_in: Vec<(&'static str, f64)> = own
            .iter()
            .enumerate()
            .map(|(number, group)| {
                let part = &found.deviations[begin..begin + group.len()];
                begin += group.len();
                let mean_square = part.iter().map(|z| z * z).sum::<f64>() / part.len() as f64;
                (names[number % names.len()], mean_square)
            })
            .collect();
        differs_in.sort_by(|one, other| other.1.total_cmp(&one.1));
        Comparison {
            rank: found.rank,
            distance: found.ratio,
            differs_in,
        }
    }

    /// The numbers of every run in a row, and those of the records in groups.
    fn all_numbers(&self, records: &[Vec<f64>]) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let runs = self.curves.par_iter().enumerate();
        let rows = runs.map(|(run, curves)| self.numbers(curves, Some(run)).concat());
        (rows.collect(), self.numbers(records, None))
    }

    /// The numbers of some curves, in groups: for every record, the numbers of its curve and the distance
    /// from the nearest runs except run `but_for`.
    fn numbers(&self, curves: &[Vec<f64>], but_for: Option<usize>) -> Vec<Vec<f64>> {
        let mut groups = Vec::new();
        for (record, curve) in curves.iter().enumerate() {
            groups.extend(checked(curve));
            let others = self
                .curves
                .iter()
                .enumerate()
                .filter(|(run, _)| Some(*run) != but_for);
            let mut distances: Vec<f64> = others
                .map(|(_, other)| rms_difference(curve, &other[record]))
                .collect();
            distances.sort_by(f64::total_cmp);
            let nearest = distances.iter().take(NEAREST).sum::<f64>() / NEAREST as f64;
            let size = level(curve).abs().max(f64::MIN_POSITIVE);
            groups.push(vec![libm::log((nearest / size).max(1e-9))]);
        }
        groups
    }
}

/// Name of the group that compares the curves themselves.
const CURVE: &str = "curve as a whole";

/// Root mean square of the difference of two curves.
pub(crate) fn rms_difference(one: &[f64], other: &[f64]) -> f64 {
    let squares: f64 = one.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum();
    (squares / one.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_holds_nine_tenths() {
        let curves: Vec<Vec<f64>> = (0..=100).map(|k| vec![f64::from(k), 7.0]).collect();
        let band = FrictionBand::from_curves(&curves.iter().collect::<Vec<_>>());
        assert_eq!((band.low[0], band.median[0], band.high[0]), (5.0, 50.0, 95.0));
        assert_eq!(band.holds_percent(&[4.0, 7.0]), 50.0);
    }
}
