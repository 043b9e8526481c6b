//! Whether the model can have made a record.

use rayon::prelude::*;
use serde::Serialize;
use slipfront_regression::{Regression, squared_distances};

use super::intervals::Distribution;
use super::normals::{Stream, draws, noisy, normals};
use super::scaling::{Scaling, summaries_of};
use super::training::Training;

/// Largest drift in training: friction that rises or falls by this share of itself over the record.
const MAX_DRIFT: f64 = 0.12;

/// Share of good records that each of the two checks refuses.
const REFUSED_BY_DRIFT: f64 = 0.025;
const REFUSED_AS_FOREIGN: f64 = 0.01;

/// Number of the nearest runs over which the distance of a record is averaged.
const NEAREST: usize = 5;

/// Test that distinguishes records of the model from others.
#[derive(Clone, Debug)]
pub(super) struct Check {
    drift: Regression,
    /// The drift of every training run, from 0 for the largest fall to 1 for the largest rise.
    drifts: Vec<f64>,
    /// Scaled summaries of the training runs.
    table: Vec<f64>,
    /// Distance of a run to the others that few exceed.
    far: f64,
}

/// Tests of whether the model can have made a record.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Misfit {
    /// Drift of friction over the record, as a share of friction: an interval that holds it for all records but 25 in 1000.
    pub drift: [f64; 2],
    /// Whether the interval leaves out 0.
    pub has_drift: bool,
    /// Distance of the summaries from those of the nearest training runs, over the distance that 10 training runs in 1000
    /// exceed.
    pub distance: f64,
    /// How far the summary that lies farthest outside of those of all training runs does so, over the width of their range; 0 if
    /// none does.
    pub outside: f64,
}

/// Part of the width of its range by which a summary may lie outside of it: one more run may well exceed all others, but hardly by a quarter
/// of what these differ.
const MAX_OUTSIDE: f64 = 0.25;

impl Misfit {
    /// Whether the records are refused as none of the model; 3.5 % of the model's own are.
    pub fn is_refused(&self) -> bool {
        self.has_drift || self.distance > 1.0 || self.is_outside()
    }

    /// Whether the records have a summary that no training run comes near.
    pub fn is_outside(&self) -> bool {
        self.outside > MAX_OUTSIDE
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
    /// Learns drift from the training runs, each with a drift of its own; `noise` is the noise of every record, as a share
    /// of friction.
    pub(super) fn learn(training: &Training, noise: &[f64], scaling: &Scaling, table: &[f64]) -> Self {
        let runs = training.curves.len();
        let drifts: Vec<f64> = (0..runs)
            .map(|run| draws(Stream::Drift, run, 0).uniform())
            .collect();
        let rows: Vec<Vec<f64>> = training
            .curves
            .par_iter()
            .enumerate()
            .map(|(run, curves)| {
                let records = curves.iter().zip(noise).enumerate();
                let drifting = records.map(|(record, (curve, &noise))| {
                    let generated = normals(Stream::DriftNoise, run, record);
                    noisy(&drifting(curve, drift_at(drifts[run])), noise, generated)
                });
                scaling.scaled(&summaries_of(&drifting.collect::<Vec<_>>()))
            })
            .collect();
        let drift = Regression::learn(&rows.concat(), &drifts);
        let d = table.len() / runs;
        let distances = squared_distances(table, table, d);
        let mut nearest: Vec<f64> = distances
            .chunks_exact(runs)
            .map(|row| distance(row, NEAREST + 1))
            .collect();
        nearest.sort_by(f64::total_cmp);
        let place = ((1.0 - REFUSED_AS_FOREIGN) * (runs + 1) as f64) as usize;
        Self {
            drift,
            drifts,
            table: table.to_vec(),
            far: nearest[place.min(runs - 1)],
        }
    }

    /// Tests of a record with these scaled summaries, which lie so far [outside](Scaling::outside) of the training.
    pub(super) fn misfit(&self, summaries: &[f64], outside: f64) -> Misfit {
        let drift = Distribution::of(&self.drift, &self.drifts, self.drift.predict(summaries));
        let drift = drift.interval(1.0 - REFUSED_BY_DRIFT).map(drift_at);
        let row = squared_distances(summaries, &self.table, summaries.len());
        Misfit {
            has_drift: drift[0] > 0.0 || drift[1] < 0.0,
            drift,
            distance: distance(&row, NEAREST) / self.far,
            outside,
        }
    }
}

/// Root of the mean of the least squared distances; for a run among all, the first is the distance to itself.
fn distance(row: &[f64], nearest: usize) -> f64 {
    let mut row = row.to_vec();
    let nearest = nearest.min(row.len());
    row.select_nth_unstable_by(nearest - 1, f64::total_cmp);
    (row[..nearest].iter().sum::<f64>() / NEAREST as f64).sqrt()
}
