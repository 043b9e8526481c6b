//! Estimates of the unknowns from records, by regression on training runs.

use rayon::prelude::*;
use slipfront_regression::{Prediction, Regression};

use crate::distribution::Distribution;
use crate::features::quantiles;
use crate::misfit::{Check, Misfit};
use crate::sample_points::SamplePoints;
use crate::scaling::{Scaling, features_of, units_of_friction};
use crate::set_up::Curves;
use crate::synthetic_noise::{Stream, normals};
use crate::training::Training;

/// Width of an interval of 90 %, as a share of the range, above which the record does not determine the
/// unknown.
pub(crate) const UNDETERMINED: f64 = 0.8;

/// Least correlation of the errors of two unknowns that form a pair, and least width of both of their
/// intervals.
const OF_A_PAIR: f64 = 0.8;
const WIDTH_OF_A_PAIR: f64 = 0.2;

/// Regressions of the unknowns on the features of a training, at one level of noise.
#[derive(Clone, Debug)]
pub struct Calibration {
    /// Units of the friction of the records in their features.
    units: Vec<f64>,
    scaling: Scaling,
    /// Values of the unknowns in the training runs, as shares of the ranges: for every unknown those of all
    /// runs.
    truths: Vec<Vec<f64>>,
    regressions: Vec<Regression>,
    check: Check,
}

/// Two unknowns that a record determines only together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Numbers of the two unknowns.
    pub unknowns: [usize; 2],
    /// Correlation of their errors: above 0 if both unknowns may be larger than estimated, below 0 if one may
    /// be larger and the other smaller.
    pub correlation: f64,
}

/// Estimate from records.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Distribution of every unknown over its range.
    pub distributions: Vec<Distribution>,
    /// Numbers of the unknowns that are not determined.
    pub undetermined: Vec<usize>,
    /// Unknowns that are determined only together.
    pub pairs: Vec<Pair>,
    /// Whether the model can have made the records.
    pub misfit: Misfit,
    /// Weight of every training run, by the similarity of its predictions of the unknowns to those from the
    /// records; the sum is 1.
    likeness: Vec<f64>,
    predictions: Vec<Prediction>,
}

/// Least effective number of training runs that records are compared with.
const LIKE_AT_LEAST: f64 = 50.0;

impl Calibration {
    /// Learns the relation between records and unknowns from a training. The records have white noise; its
    /// standard deviation is the share `noise` of their mean friction. `grids` are the sample points of the
    /// set-up.
    pub fn new(training: &Training, grids: &[SamplePoints], noise: f64) -> Self {
        let units = units_of_friction(training, grids);
        let rows: Vec<Vec<f64>> = training
            .curves
            .par_iter()
            .enumerate()
            .map(|(run, curves)| {
                let records = curves.iter().zip(grids).enumerate();
                let noisy = records.map(|(record, (curve, grid))| {
                    grid.noisy(curve, noise, normals(Stream::Noise, run, record))
                });
                features_of(&noisy.collect::<Vec<_>>(), &units)
            })
            .collect();
        let scaling = Scaling::from_rows(&rows);
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
        let check = || Check::learn(training, grids, noise, &units, &scaling, &table);
        let (regressions, check) = rayon::join(learn, check);
        Self {
            units,
            scaling,
            truths,
            regressions,
            check,
        }
    }

    /// Estimates the unknowns from records, each returned by [`SamplePoints::record`].
    pub fn estimate(&self, records: &[Vec<f64>]) -> Estimate {
        let features = self.scaling.scaled(&features_of(records, &self.units));
        let predictions: Vec<_> = self
            .regressions
            .iter()
            .map(|regression| regression.predict(&features))
            .collect();
        let all = self.regressions.iter().zip(&self.truths).zip(&predictions);
        let distributions: Vec<Distribution> = all
            .map(|((regression, truth), &prediction)| Distribution::new(regression, truth, prediction))
            .collect();
        let widths: Vec<f64> = distributions
            .iter()
            .map(|one| {
                let [low, high] = one.interval(0.9);
                high - low
            })
            .collect();
        let undetermined = (0..widths.len()).filter(|&j| widths[j] > UNDETERMINED).collect();
        Estimate {
            pairs: self.pairs(&features, &widths),
            distributions,
            undetermined,
            misfit: self.check.misfit(records, &features),
            likeness: self.likeness(&predictions),
            predictions,
        }
    }

    /// Shift of the median of every unknown between two sets of records with the same unknowns: the median
    /// over all pairs, as a share of the range.
    pub(crate) fn moved(&self, from: &[Curves], to: &[Curves]) -> Vec<f64> {
        let medians = |records: &Curves| -> Vec<f64> {
            let found = self.estimate(records).distributions;
            found.iter().map(|one| one.quantile(0.5)).collect()
        };
        let pairs: Vec<Vec<f64>> = from
            .par_iter()
            .zip(to)
            .map(|(from, to)| {
                medians(to)
                    .iter()
                    .zip(medians(from))
                    .map(|(to, from)| to - from)
                    .collect()
            })
            .collect();
        let of_unknown = |j: usize| {
            let all: Vec<f64> = pairs.iter().map(|moved| moved[j]).collect();
            quantiles(&all, [0.5])[0]
        };
        (0..self.truths.len()).map(of_unknown).collect()
    }

    /// Weight of every training run for a record with these predictions: a product of Gaussians, wide enough
    /// that at least [`LIKE_AT_LEAST`] runs effectively count.
    fn likeness(&self, predictions: &[Prediction]) -> Vec<f64> {
        let runs = self.truths.first().map_or(0, Vec::len);
        let distance = |run: usize| -> f64 {
            let all = self.regressions.iter().zip(predictions);
            all.map(|(regression, prediction)| regression.distance(run, prediction))
                .sum()
        };
        let distances: Vec<f64> = (0..runs).map(distance).collect();
        let nearest = distances.iter().copied().fold(f64::INFINITY, f64::min);
        let mut width = 1.0;
        loop {
            let weights: Vec<f64> = distances
                .iter()
                .map(|distance| libm::exp(-0.5 * (distance - nearest) / width))
                .collect();
            let sum: f64 = weights.iter().sum();
            let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
            if sum * sum / squares >= LIKE_AT_LEAST.min(0.5 * runs as f64) {
                return weights.iter().map(|weight| weight / sum).collect();
            }
            width *= 2.0;
        }
    }

    /// Draws `count` points of the ranges from the joint distribution of all unknowns: residuals of whole
    /// training runs around the predictions from the records.
    pub fn sample(&self, estimate: &Estimate, count: usize) -> Vec<Vec<f64>> {
        let mut sum = 0.0;
        let sums: Vec<f64> = estimate
            .likeness
            .iter()
            .map(|weight| {
                sum += weight;
                sum
            })
            .collect();
        let point = |k: usize| {
            let place = (k as f64 + 0.5) / count as f64;
            let run = sums.partition_point(|&sum| sum < place).min(sums.len() - 1);
            let all = self
                .regressions
                .iter()
                .zip(&self.truths)
                .zip(&estimate.predictions);
            all.map(|((regression, truth), prediction)| regression.moved(run, truth[run], prediction))
                .collect()
        };
        (0..count).map(point).collect()
    }

    /// Widths of the intervals of 90 % of every unknown for records like these, as shares of its range: the
    /// means over the most similar training runs, each of them left out.
    pub(crate) fn widths(&self, estimate: &Estimate) -> Vec<f64> {
        let mut alike: Vec<usize> = (0..estimate.likeness.len()).collect();
        alike.sort_by(|&a, &b| estimate.likeness[b].total_cmp(&estimate.likeness[a]));
        alike.truncate(LIKE_AT_LEAST as usize);
        self.widths_of(&alike)
    }

    /// Widths of the intervals of 90 % as [`widths`](Self::widths) returns, but averaged over all training
    /// runs.
    pub(crate) fn mean_widths(&self) -> Vec<f64> {
        let runs = self.truths.first().map_or(0, Vec::len);
        self.widths_of(&Vec::from_iter(0..runs))
    }

    /// Mean widths of the intervals of 90 % for these training runs, each of them left out.
    fn widths_of(&self, runs: &[usize]) -> Vec<f64> {
        let all: Vec<_> = self.regressions.iter().zip(&self.truths).collect();
        all.par_iter()
            .map(|(regression, truth)| {
                let widths = runs.iter().map(|&run| {
                    let [low, high] =
                        Distribution::new(regression, truth, regression.left_out(run)).interval(0.9);
                    high - low
                });
                widths.sum::<f64>() / runs.len() as f64
            })
            .collect()
    }

    /// Pairs of unknowns with correlated errors in training runs like the record.
    fn pairs(&self, features: &[f64], widths: &[f64]) -> Vec<Pair> {
        let wide: Vec<usize> = (0..widths.len())
            .filter(|&j| widths[j] > WIDTH_OF_A_PAIR)
            .collect();
        let mut pairs = Vec::new();
        for (k, &one) in wide.iter().enumerate() {
            for &other in &wide[k + 1..] {
                let weights = self.regressions[one].likeness(features, &self.regressions[other]);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design_point::design_point;
    use slipfront_run::measured::{Measure, MeasuredRecord};

    /// A curve with a slope and a level that the slope leads to, both known, and a number that no curve
    /// shows.
    fn curve(point: &[f64]) -> Vec<f64> {
        let (slope, level) = (0.02 + 0.03 * point[0], 0.5 + 0.5 * point[1]);
        (0..100).map(|i| (slope * f64::from(i)).min(level)).collect()
    }

    fn training(runs: usize) -> Training {
        let points: Vec<Vec<f64>> = (0..runs).map(|run| design_point(run, 3)).collect();
        let curves = points.iter().map(|point| vec![curve(point)]).collect();
        Training { points, curves }
    }

    fn grid() -> SamplePoints {
        grid_of(Measure::Coefficient)
    }

    fn grid_of(quantity: Measure) -> SamplePoints {
        let x: Vec<f64> = (0..100).map(f64::from).collect();
        let record = MeasuredRecord::new(x.clone(), x, Measure::Time, quantity);
        SamplePoints::from_record(&record).unwrap()
    }

    fn calibration() -> Calibration {
        Calibration::new(&training(300), &[grid()], 0.01)
    }

    #[test]
    fn what_a_curve_shows_is_found_and_what_it_does_not_is_told() {
        let calibration = calibration();
        let point = [0.3, 0.6, 0.5];
        let record = |number| grid().noisy(&curve(&point), 0.01, normals(Stream::Noise, 1000, number));
        let fit = calibration.estimate(&[record(0)]);
        assert_eq!(fit.undetermined, [2]);
        for (distribution, truth) in fit.distributions.iter().zip(point).take(2) {
            // The interval of 99 % of both: with 1 % of noise over 100 values, a hundredth of the range would
            // be missed.
            let [low, high] = distribution.interval(0.99);
            assert!(
                low <= truth && truth <= high && high - low < 0.1,
                "{low} {truth} {high}"
            );
        }
        assert!(fit.pairs.is_empty());
        // Of good records some 4 % are refused: more than four of twenty would be one time in a thousand.
        let refused = (0..20).filter(|&number| calibration.estimate(&[record(number)]).misfit.is_refused());
        assert!(refused.count() <= 4);
    }

    #[test]
    fn records_that_drift_or_are_of_another_kind_are_refused() {
        let calibration = calibration();
        let plain = curve(&[0.3, 0.6, 0.5]);
        let noise = || normals(Stream::Noise, 1000, 0);
        let drifting: Vec<f64> = plain
            .iter()
            .zip(0..)
            .map(|(y, i)| y * (1.0 + 0.1 * f64::from(i) / 99.0))
            .collect();
        let drift = calibration
            .estimate(&[grid().noisy(&drifting, 0.01, noise())])
            .misfit;
        assert!(drift.has_drift && drift.drift[0] > 0.0, "{drift:?}");
        let swings: Vec<f64> = plain
            .iter()
            .zip(0..)
            .map(|(y, i)| y * (1.0 + 0.3 * f64::from(i % 7 - 3) / 3.0))
            .collect();
        let foreign = calibration
            .estimate(&[grid().noisy(&swings, 0.01, noise())])
            .misfit;
        assert!(foreign.distance > 1.0, "{foreign:?}");
    }

    /// The mean friction of a record in other units or of another slider is outside of that of the training
    /// runs.
    #[test]
    fn records_of_another_friction_are_refused() {
        let calibration = calibration();
        for factor in [0.1, 5.0] {
            let plain = curve(&[0.3, 0.6, 0.5]);
            let other: Vec<f64> = plain.iter().map(|y| factor * y).collect();
            let found = calibration.estimate(&[grid().noisy(&other, 0.01, normals(Stream::Noise, 1000, 0))]);
            assert!(found.misfit.is_outside(), "{factor}: {:?}", found.misfit);
        }
        let own = calibration.estimate(&[grid().noisy(
            &curve(&[0.0, 1.0, 0.0]),
            0.01,
            normals(Stream::Noise, 1000, 0),
        )]);
        assert!(!own.misfit.is_outside(), "{:?}", own.misfit);
    }

    /// Noise alone changes a mean that depends on no unknown; 20 records with 1 % of noise lie within 5
    /// standard errors of the mean.
    #[test]
    fn a_mean_that_is_the_same_in_all_runs_refuses_no_good_record() {
        let mut training = training(300);
        training.curves = vec![vec![curve(&[0.3, 0.6, 0.5])]; 300];
        let calibration = Calibration::new(&training, &[grid()], 0.01);
        for number in 0..20 {
            let noise = normals(Stream::Noise, 1000, number);
            let found = calibration.estimate(&[grid().noisy(&curve(&[0.3, 0.6, 0.5]), 0.01, noise)]);
            assert!(!found.misfit.is_outside(), "{:?}", found.misfit);
        }
    }

    /// Forces of a quintillionth of a newton give the same estimates as forces of a newton: scaling by powers
    /// of two keeps every digit.
    #[test]
    fn the_size_of_forces_does_not_matter() {
        let found = |newtons: f64| {
            let scale = |curve: &mut Vec<f64>| curve.iter_mut().for_each(|y| *y *= newtons);
            let mut training = training(300);
            training.curves.iter_mut().flatten().for_each(scale);
            let mut record = grid().noisy(&curve(&[0.3, 0.6, 0.5]), 0.01, normals(Stream::Noise, 1000, 0));
            scale(&mut record);
            Calibration::new(&training, &[grid_of(Measure::Force)], 0.01).estimate(&[record])
        };
        let of_newtons = found(1.0);
        assert_eq!(of_newtons.undetermined, [2]);
        for power in [-60, 60] {
            assert_eq!(found(2.0_f64.powi(power)).distributions, of_newtons.distributions);
        }
    }

    #[test]
    fn threads_do_not_change_a_bit() {
        let fit = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| {
                Calibration::new(&training(120), &[grid()], 0.05).estimate(&[curve(&[0.2, 0.7, 0.1])])
            })
        };
        assert_eq!(fit(1), fit(3));
    }
}
