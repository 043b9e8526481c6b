//! What a training tells of the unknowns of a record.

use rayon::prelude::*;

use super::grid::Grid;
use super::intervals::Distribution;
use super::misfit::{Check, Misfit};
use super::normals::{Stream, normals};
use super::regression::Regression;
use super::summaries::summaries;
use super::training::Training;

/// An interval of 90 % that is wider, as a share of the range, says that the record does not tell the unknown.
const UNDETERMINED: f64 = 0.8;

/// Correlation from which errors of two unknowns make a pair, and the width that both intervals then have at the least.
const OF_A_PAIR: f64 = 0.8;
const WIDTH_OF_A_PAIR: f64 = 0.2;

/// A training whose summaries have been learnt from at one level of noise.
#[derive(Clone, Debug)]
pub struct Calibration {
    scaling: Scaling,
    /// Shares of the ranges of the training runs: for every unknown those of all runs.
    truths: Vec<Vec<f64>>,
    regressions: Vec<Regression>,
    check: Check,
}

/// Two unknowns that a record tells only together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Their numbers.
    pub unknowns: [usize; 2],
    /// Correlation of their errors: above 0 where both may be larger than found together, below 0 where one may be larger and the other smaller.
    pub correlation: f64,
}

/// What records tell.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// Where every unknown lies in its range.
    pub distributions: Vec<Distribution>,
    /// Numbers of the unknowns that are not told.
    pub undetermined: Vec<usize>,
    /// Unknowns that are told only together.
    pub pairs: Vec<Pair>,
    /// Whether the model can have made the records.
    pub misfit: Misfit,
}

/// Means and standard deviations that bring summaries to one scale.
#[derive(Clone, Debug)]
pub(super) struct Scaling {
    means: Vec<f64>,
    deviations: Vec<f64>,
}

/// Summaries count no farther from their mean, in standard deviations: a record outside of the training is not extrapolated to.
const MAX_AWAY: f64 = 4.0;

impl Scaling {
    fn of(rows: &[Vec<f64>]) -> Self {
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

    /// Summaries in standard deviations from their mean; 0 of those that never differ.
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

/// Friction with noise of this share of its mean.
pub(super) fn noisy(curve: &[f64], noise: f64, normals: impl Iterator<Item = f64>) -> Vec<f64> {
    let deviation = noise * curve.iter().sum::<f64>().abs() / curve.len() as f64;
    curve
        .iter()
        .zip(normals)
        .map(|(y, z)| y + deviation * z)
        .collect()
}

/// Summaries of several records in a row.
pub(super) fn summaries_of(curves: &[Vec<f64>]) -> Vec<f64> {
    curves.iter().flat_map(|curve| summaries(curve)).collect()
}

impl Calibration {
    /// Learns from a training what records with white noise tell, whose standard deviation is this share of the mean friction of the record.
    /// `grids` are those of the set-up.
    pub fn new(training: &Training, grids: &[&Grid], noise: f64) -> Self {
        let shares: Vec<f64> = grids.iter().map(|grid| noise * grid.noise_share()).collect();
        let rows: Vec<Vec<f64>> = training
            .curves
            .par_iter()
            .enumerate()
            .map(|(run, curves)| {
                let records = curves.iter().zip(&shares).enumerate();
                let noisy = records.map(|(record, (curve, &noise))| {
                    noisy(curve, noise, normals(Stream::Noise, run, record))
                });
                summaries_of(&noisy.collect::<Vec<_>>())
            })
            .collect();
        let scaling = Scaling::of(&rows);
        let table: Vec<f64> = rows.iter().flat_map(|row| scaling.scaled(row)).collect();
        let unknowns = training.points.first().map_or(0, Vec::len);
        let truths: Vec<Vec<f64>> = (0..unknowns)
            .map(|j| training.points.iter().map(|point| point[j]).collect())
            .collect();
        let learn = || {
            truths
                .par_iter()
                .with_max_len(1)
                .map(|truth| Regression::learn(&table, truth))
                .collect()
        };
        let check = || Check::learn(training, &shares, &scaling, &table);
        let (regressions, check) = rayon::join(learn, check);
        Self {
            scaling,
            truths,
            regressions,
            check,
        }
    }

    /// What records tell, each as its [`Grid::record`].
    pub fn fit(&self, records: &[Vec<f64>]) -> Fit {
        let summaries = self.scaling.scaled(&summaries_of(records));
        let predictions: Vec<_> = self
            .regressions
            .iter()
            .map(|regression| regression.predict(&summaries))
            .collect();
        let all = self.regressions.iter().zip(&self.truths).zip(&predictions);
        let distributions: Vec<Distribution> = all
            .map(|((regression, truth), &prediction)| Distribution::of(regression, truth, prediction))
            .collect();
        let widths: Vec<f64> = distributions
            .iter()
            .map(|one| {
                let [low, high] = one.interval(0.9);
                high - low
            })
            .collect();
        let undetermined = (0..widths.len()).filter(|&j| widths[j] > UNDETERMINED).collect();
        Fit {
            pairs: self.pairs(&summaries, &widths),
            distributions,
            undetermined,
            misfit: self.check.misfit(&summaries),
        }
    }

    /// Pairs of unknowns whose errors go together in training runs like the record.
    fn pairs(&self, summaries: &[f64], widths: &[f64]) -> Vec<Pair> {
        let wide: Vec<usize> = (0..widths.len())
            .filter(|&j| widths[j] > WIDTH_OF_A_PAIR)
            .collect();
        let mut pairs = Vec::new();
        for (k, &one) in wide.iter().enumerate() {
            for &other in &wide[k + 1..] {
                let weights = self.regressions[one].likeness(summaries, &self.regressions[other]);
                let errors = |j: usize| {
                    let (truths, found) = (&self.truths[j], &self.regressions[j].predictions);
                    truths.iter().zip(found).map(|(truth, found)| truth - found)
                };
                let products = |a: usize, b: usize| -> f64 {
                    weights
                        .iter()
                        .zip(errors(a))
                        .zip(errors(b))
                        .map(|((w, a), b)| w * a * b)
                        .sum()
                };
                let correlation = products(one, other) / (products(one, one) * products(other, other)).sqrt();
                if correlation.abs() >= OF_A_PAIR {
                    pairs.push(Pair {
                        unknowns: [one, other],
                        correlation,
                    });
                }
            }
        }
        pairs
    }
}
