//! Whether the model can have made a record.

use rayon::prelude::*;
use serde::Serialize;
use slipfront_regression::{Regression, squared_distances};

use crate::distribution::Distribution;
use crate::features::level;
use crate::sample_points::SamplePoints;
use crate::scaling::{Scaling, features_of};
use crate::synthetic_noise::{Stream, draws, normals};
use crate::training::Training;

/// Largest drift in training: friction rises or falls by this share of itself over the record.
const MAX_DRIFT: f64 = 0.12;

/// Share of good records that each of the two checks refuses.
const REFUSED_BY_DRIFT: f64 = 0.01;
const REFUSED_AS_FOREIGN: f64 = 0.005;

/// Number of the nearest runs over which the distance of a record is averaged.
const NEAREST: usize = 5;

/// Test that distinguishes records of the model from others.
#[derive(Clone, Debug)]
pub(crate) struct Check {
    drift: Regression,
    /// The drift of every training run, from 0 for the largest fall to 1 for the largest rise.
    drifts: Vec<f64>,
    /// Scaled features of the training runs.
    table: Vec<f64>,
    /// Distance of a run to the other runs that only few runs exceed.
    far: f64,
    /// The least and the largest mean of the second half in the training, for each record, with noise: if the
    /// mean depends on no unknown, noise alone makes records differ.
    levels: Vec<[f64; 2]>,
}

/// Tests of whether the model can have made a record.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Misfit {
    /// Drift of friction over the record, as a share of friction: the interval contains the true drift in all
    /// but 10 of 1000 records.
    pub drift: [f64; 2],
    /// Whether the interval excludes 0.
    pub has_drift: bool,
    /// Distance of the features from those of the nearest training runs, over the distance that 5 training
    /// runs in 1000 exceed.
    pub distance: f64,
    /// Mean of the second half of the record that is farthest outside of the means of the training runs, and
    /// the least and the largest of these means. Scaled features do not show it, since they limit large
    /// distances.
    pub level: [f64; 3],
}

/// Largest accepted distance of a mean from the range of the means of the training runs, over the width of
/// the range: one more run may well exceed all others, but hardly by a quarter of their range.
const MAX_OUTSIDE: f64 = 0.25;

/// Distance of a mean from a range, over the width of the range; 0 within it.
fn outside([level, low, high]: [f64; 3]) -> f64 {
    let beyond = (low - level).max(level - high);
    if beyond > 0.0 { beyond / (high - low) } else { 0.0 }
}

impl Misfit {
    /// Whether the records are refused because the model cannot have made them; some 4 % of the model's own
    /// records are refused, too.
    pub fn is_refused(&self) -> bool {
        self.has_drift || self.distance > 1.0 || self.is_outside()
    }

    /// Whether the friction of a record is far from that of all training runs.
    pub fn is_outside(&self) -> bool {
        outside(self.level) > MAX_OUTSIDE
    }
}

/// A record with a drift: y (1 + drift i/(n - 1)).
fn drifting(curve: &[f64], drift: f64) -> Vec<f64> {
    let last = (curve.len() - 1) as f64;
    let values = curve.iter().enumerate();
    values.map(|(i, y)| y * (1.0 + drift * i as f64 / last)).collect()
}

/// The drift at a share of the range of drifts.
fn drift_at(share: f64) -> f64 {
    MAX_DRIFT * (2.0 * share - 1.0)
}

impl Check {
    /// Learns to recognise drift from the training runs, each with its own drift. `grids` and `units` are the
    /// sample points of every record, and the unit of friction in its features.
    pub(crate) fn learn(
        training: &Training,
        grids: &[SamplePoints],
        noise: f64,
        units: &[f64],
        scaling: &Scaling,
        table: &[f64],
    ) -> Self {
        let runs = training.curves.len();
        let drifts: Vec<f64> = (0..runs)
            .map(|run| draws(Stream::Drift, run, 0).uniform())
            .collect();
        let (rows, levels): (Vec<Vec<f64>>, Vec<Vec<f64>>) = training
            .curves
            .par_iter()
            .enumerate()
            .map(|(run, curves)| {
                let records = curves.iter().zip(grids).enumerate();
                let records = records.map(|(record, (curve, grid))| {
                    let generated: Vec<f64> = normals(Stream::DriftNoise, run, record)
                        .take(curve.len())
                        .collect();
                    let record_of = |curve: &[f64]| grid.noisy(curve, noise, generated.iter().copied());
                    let drifting = record_of(&drifting(curve, drift_at(drifts[run])));
                    (drifting, level(&record_of(curve)))
                });
                let (drifting, levels): (Vec<_>, Vec<_>) = records.unzip();
                (scaling.scaled(&features_of(&drifting, units)), levels)
            })
            .unzip();
        let drift = Regression::learn(&rows.concat(), &drifts);
        Self {
            drift,
            drifts,
            table: table.to_vec(),
            far: far(table, runs),
            levels: (0..grids.len())
                .map(|record| {
                    let levels = levels.iter().map(|levels| levels[record]);
                    levels.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], level| {
                        [low.min(level), high.max(level)]
                    })
                })
                .collect(),
        }
    }

    /// Tests of records with these scaled features.
    pub(crate) fn misfit(&self, records: &[Vec<f64>], features: &[f64]) -> Misfit {
        let drift = Distribution::new(&self.drift, &self.drifts, self.drift.predict(features));
        let drift = drift.interval(1.0 - REFUSED_BY_DRIFT).map(drift_at);
        let row = squared_distances(features, &self.table, features.len());
        let levels = records.iter().zip(&self.levels);
        let levels = levels.map(|(record, &[low, high])| [level(record), low, high]);
        Misfit {
            has_drift: drift[0] > 0.0 || drift[1] < 0.0,
            drift,
            distance: distance(&row, NEAREST) / self.far,
            level: levels
                .max_by(|one, other| outside(*one).total_cmp(&outside(*other)))
                .unwrap_or_default(),
        }
    }
}

/// Distance of a training run to the other runs that only few runs exceed.
fn far(table: &[f64], runs: usize) -> f64 {
    let distances = squared_distances(table, table, table.len() / runs);
    // The nearest run of all is the run itself.
    let of_run = |row| distance(row, NEAREST + 1);
    let mut nearest: Vec<f64> = distances.chunks_exact(runs).map(of_run).collect();
    nearest.sort_by(f64::total_cmp);
    let place = ((1.0 - REFUSED_AS_FOREIGN) * (runs + 1) as f64) as usize;
    nearest[place.min(runs - 1)]
}

/// Root mean square of the smallest distances; for a training run, the first is the distance to itself.
fn distance(row: &[f64], nearest: usize) -> f64 {
    let mut row = row.to_vec();
    let nearest = nearest.min(row.len());
    row.select_nth_unstable_by(nearest - 1, f64::total_cmp);
    (row[..nearest].iter().sum::<f64>() / NEAREST as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The outer of six runs at 0, 1, ..., 5 is sqrt((1 + 4 + 9 + 16 + 25)/5) from the other five, and so is
    /// a record at -1 from the nearest five of the six. Squares of small integers and their sums are exact.
    #[test]
    fn a_run_is_not_its_own_neighbour() {
        let runs = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
        assert_eq!(far(&runs, runs.len()), f64::sqrt(11.0));
        let of_record = squared_distances(&[-1.0], &runs, 1);
        assert_eq!(distance(&of_record, NEAREST), f64::sqrt(11.0));
    }
}
