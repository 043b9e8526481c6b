//! The kinetic friction coefficient: a mean over a window after the transition, with its uncertainty.

use serde::{Deserialize, Serialize};

use super::observer::Observer;
use crate::error::RunError;
use crate::measure::{CurvePoint, Peak};
use crate::model::ONSET_PATH;
use crate::snapshot::Snapshot;

/// Where the kinetic window begins. It ends with the run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum KineticStart {
    /// At t_s* + 2.5/V*; at 5/V* (twice the usual t_s*, Eq. 12) in a run without a transition.
    Auto,
    /// At a given t*.
    At(f64),
}

impl KineticStart {
    /// Where the window begins, t*, with the peak of mu* as far as it is known, at a
    /// [loading speed](crate::Model::loading_speed) of `v_star`.
    pub fn time_star(&self, peak: &Peak, v_star: f64) -> f64 {
        match *self {
            KineticStart::At(time_star) => time_star,
            KineticStart::Auto if peak.ended => peak.time_star + ONSET_PATH / v_star,
            KineticStart::Auto => 2.0 * ONSET_PATH / v_star,
        }
    }
}

/// Friction in the kinetic window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kinetic {
    /// First and last t* of the mean.
    pub window_star: [f64; 2],
    /// mu_k*, the mean of mu*.
    pub mu_star: f64,
    /// Standard error of mu_k* by the blocking method, or why it cannot be estimated.
    pub uncertainty: Result<f64, NoUncertainty>,
    /// Mean of mu_lateral_star.
    pub mu_lateral_star: f64,
    /// Mean of N*.
    pub sliding_percent: f64,
}

/// Why the uncertainty of a mean cannot be estimated from the scatter inside its window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoUncertainty {
    /// One half of the window holds fewer than ten independent blocks.
    TooFewBlocks {
        /// How many it holds.
        found: usize,
        /// t* to which the run should go.
        needed_time_star: f64,
    },
    /// The means of the two halves differ by more than three standard errors: mu* still drifts.
    Drift {
        /// Means of the two halves.
        halves: [f64; 2],
        /// t* to which the run should go.
        needed_time_star: f64,
    },
}

/// Keeps mu*, what is across the drive and N* of the whole run as at most [`KineticHistory::BINS`] means over equal numbers of steps, so that memory
/// does not grow with the run. It must be called at every step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct KineticHistory {
    steps_per_bin: u64,
    in_bin: u64,
    bins: Vec<Bin>,
    sliding_percent_max: f64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Bin {
    mu_star: f64,
    mu_lateral_star: f64,
    sliding_percent: f64,
}

impl KineticHistory {
    /// Largest number of means. A shorter run keeps every step.
    pub const BINS: u64 = 16_384;

    /// An empty history of a run of `last_step` steps; [`u64::MAX`] for a run without an end. A run that goes on for longer
    /// averages twice as many steps into each mean as often as it must.
    pub fn new(last_step: u64) -> Self {
        let steps_per_bin = if last_step == u64::MAX {
            1
        } else {
            last_step / Self::BINS + 1
        };
        Self {
            steps_per_bin,
            in_bin: 0,
            bins: Vec::with_capacity((last_step / steps_per_bin).min(Self::BINS - 1) as usize + 1),
            sliding_percent_max: 0.0,
        }
    }

    /// Whether this can be the history that began as `new` and was called at every step up to `step`.
    pub fn is_consistent_with(&self, new: &Self, step: u64) -> bool {
        let observed = step.saturating_add(1);
        let mut steps_per_bin = new.steps_per_bin;
        while observed.div_ceil(steps_per_bin) > Self::BINS {
            steps_per_bin *= 2;
        }
        self.steps_per_bin == steps_per_bin
            && self.in_bin == observed % steps_per_bin
            && self.bins.len() as u64 == observed.div_ceil(steps_per_bin)
    }

    /// Adds the next step.
    fn add(&mut self, point: &CurvePoint) {
        if self.in_bin == 0 {
            if self.bins.len() as u64 == Self::BINS {
                self.merge_pairs();
            }
            self.bins.push(Bin::default());
        }
        self.sliding_percent_max = self.sliding_percent_max.max(point.sliding_percent);
        let weight = 1.0 / self.steps_per_bin as f64;
        if let Some(bin) = self.bins.last_mut() {
            bin.mu_star += weight * point.mu_star;
            bin.mu_lateral_star += weight * point.mu_lateral_star;
            bin.sliding_percent += weight * point.sliding_percent;
        }
        self.in_bin = (self.in_bin + 1) % self.steps_per_bin;
    }

    /// Averages the means in pairs: half as many, over twice as many steps each.
    fn merge_pairs(&mut self) {
        for k in 0..self.bins.len() / 2 {
            let [one, other] = [self.bins[2 * k], self.bins[2 * k + 1]];
            self.bins[k] = Bin {
                mu_star: 0.5 * (one.mu_star + other.mu_star),
                mu_lateral_star: 0.5 * (one.mu_lateral_star + other.mu_lateral_star),
                sliding_percent: 0.5 * (one.sliding_percent + other.sliding_percent),
            };
        }
        self.bins.truncate(self.bins.len() / 2);
        self.steps_per_bin *= 2;
    }

    /// Largest N* of all steps.
    pub fn sliding_percent_max(&self) -> f64 {
        self.sliding_percent_max
    }

    /// Means over the window from `from_star` to the end; none if it is empty.
    pub fn kinetic(&self, from_star: f64, dt_star: f64) -> Option<Kinetic> {
        let bin_time = self.steps_per_bin as f64 * dt_star;
        // The last bin does not count until all of its steps are done.
        let complete = self.bins.len() - usize::from(self.in_bin > 0);
        let first = (from_star / bin_time).ceil().max(0.0) as usize;
        let window = self
            .bins
            .get(first..complete)
            .filter(|window| !window.is_empty())?;
        let mu_star: Vec<f64> = window.iter().map(|bin| bin.mu_star).collect();
        let window_star = [
            first as f64 * bin_time,
            (complete as f64 * self.steps_per_bin as f64 - 1.0) * dt_star,
        ];
        Some(Kinetic {
            window_star,
            mu_star: mean(&mu_star),
            uncertainty: uncertainty(&mu_star, window_star),
            mu_lateral_star: window.iter().map(|bin| bin.mu_lateral_star).sum::<f64>() / window.len() as f64,
            sliding_percent: window.iter().map(|bin| bin.sliding_percent).sum::<f64>() / window.len() as f64,
        })
    }
}

impl Observer for KineticHistory {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        self.add(&now.point);
        Ok(())
    }
}

fn mean(x: &[f64]) -> f64 {
    x.iter().sum::<f64>() / x.len() as f64
}

/// A difference between the halves below this is no drift: it is less than the error of any time step.
const NEGLIGIBLE_DRIFT: f64 = 1e-6;

/// Fewest independent blocks in each half of a window.
const MIN_BLOCKS: usize = 10;

/// Standard error of the mean of a correlated series, if its two halves support one.
fn uncertainty(x: &[f64], window_star: [f64; 2]) -> Result<f64, NoUncertainty> {
    let halves = x.split_at(x.len() / 2);
    let (one, other) = (blocking(halves.0), blocking(halves.1));
    let found = one.blocks.min(other.blocks);
    let length = window_star[1] - window_star[0];
    let longer = |factor: f64| window_star[0] + factor * length;
    if found < MIN_BLOCKS {
        let factor = (MIN_BLOCKS as f64 / found.max(1) as f64).max(2.0);
        return Err(NoUncertainty::TooFewBlocks {
            found,
            needed_time_star: longer(factor),
        });
    }
    let means = [mean(halves.0), mean(halves.1)];
    let difference = (means[0] - means[1]).abs();
    if difference > NEGLIGIBLE_DRIFT && difference > 3.0 * one.standard_error.hypot(other.standard_error) {
        return Err(NoUncertainty::Drift {
            halves: means,
            needed_time_star: longer(2.0),
        });
    }
    Ok(blocking(x).standard_error)
}

struct Blocking {
    standard_error: f64,
    /// Number of independent blocks; 0 if the series is too short to tell.
    blocks: usize,
}

/// Standard error of the mean by blocking (Flyvbjerg and Petersen 1989): neighbours are averaged in pairs until
/// the blocks are independent. The block length B is the first for which, with n values,
///
/// ```text
/// B^3 > 2 n (se_B/se_1)^4
/// ```
///
/// (Wolff 2004; Lee et al. 2011), which balances the bias of short blocks against the noise of few.
fn blocking(x: &[f64]) -> Blocking {
    let n = x.len() as f64;
    let mut blocks = x.to_vec();
    let mut length = 1.0_f64;
    let mut first = None;
    while blocks.len() >= 2 {
        let count = blocks.len() as f64;
        let center = mean(&blocks);
        let square = blocks.iter().map(|b| (b - center).powi(2)).sum::<f64>() / (count * (count - 1.0));
        let first = *first.get_or_insert(square);
        let inflation = if first > 0.0 { square / first } else { 1.0 };
        if length.powi(3) > 2.0 * n * inflation * inflation || first == 0.0 {
            return Blocking {
                standard_error: square.sqrt(),
                blocks: blocks.len(),
            };
        }
        blocks = blocks
            .chunks_exact(2)
            .map(|pair| 0.5 * (pair[0] + pair[1]))
            .collect();
        length *= 2.0;
    }
    Blocking {
        standard_error: f64::NAN,
        blocks: 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reproducible uniform noise of variance 1/12, from a linear congruential generator.
    fn noise(n: usize) -> Vec<f64> {
        let mut state = 1u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..n).map(|_| next()).collect()
    }

    #[test]
    fn white_noise_has_the_plain_standard_error() {
        let x = noise(4096);
        let expected = (1.0 / 12.0 / 4096.0_f64).sqrt();
        let found = uncertainty(&x, [0.0, 1.0]).unwrap();
        // With blocks of 2 n^(1/3) = 32 values, 128 of them give the error within 2/sqrt(2 128) = 25 %.
        assert!((found / expected - 1.0).abs() < 0.25, "{found} {expected}");
    }

    #[test]
    fn correlated_noise_has_a_larger_one() {
        // x_k = a x_k-1 + noise has the standard error of white noise times 1/(1 - a).
        let a = 0.9;
        let mut x = noise(40_000);
        for k in 1..x.len() {
            x[k] += a * x[k - 1];
        }
        let expected = (1.0 / 12.0 / 40_000.0_f64).sqrt() / (1.0 - a);
        let found = uncertainty(&x[1000..], [0.0, 1.0]).unwrap();
        assert!((found / expected - 1.0).abs() < 0.3, "{found} {expected}");
    }

    /// The history of a run in which mu* is this noise.
    fn history_of(mut history: KineticHistory, noise: &[f64]) -> KineticHistory {
        for &mu_star in noise {
            history.add(&CurvePoint {
                mu_star,
                mu_lateral_star: 0.1 - mu_star,
                sliding_percent: 100.0 * mu_star,
                ..CurvePoint::default()
            });
        }
        history
    }

    #[test]
    fn a_run_without_an_end_keeps_every_step_as_long_as_a_run_with_one_does() {
        let short = noise(KineticHistory::BINS as usize);
        let without_end = history_of(KineticHistory::new(u64::MAX), &short);
        let with_end = history_of(KineticHistory::new(KineticHistory::BINS - 1), &short);
        assert_eq!(without_end, with_end);
        assert_eq!(without_end.kinetic(100.0, 0.1), with_end.kinetic(100.0, 0.1));
    }

    #[test]
    fn a_run_without_an_end_averages_more_steps_as_it_goes_on() {
        let new = KineticHistory::new(u64::MAX);
        // Four steps per mean, as in a run of known length.
        let long = noise(4 * KineticHistory::BINS as usize);
        let without_end = history_of(new.clone(), &long);
        let with_end = history_of(KineticHistory::new(long.len() as u64 - 1), &long);
        assert_eq!(
            (without_end.steps_per_bin, without_end.bins.len()),
            (4, KineticHistory::BINS as usize)
        );
        assert!(without_end.is_consistent_with(&new, long.len() as u64 - 1));
        assert!(!without_end.is_consistent_with(&new, long.len() as u64));
        let [one, other] = [&without_end, &with_end].map(|history| history.kinetic(1000.0, 0.1).unwrap());
        assert_eq!(one.window_star, other.window_star);
        // Means of four are added in another order.
        assert!((one.mu_star - other.mu_star).abs() < 1e-15);
        assert!((one.uncertainty.unwrap() - other.uncertainty.unwrap()).abs() < 1e-15);
        assert!((one.sliding_percent - other.sliding_percent).abs() < 1e-12);
    }

    #[test]
    fn the_history_of_the_longest_run_is_made_at_once() {
        assert_eq!(KineticHistory::new(u64::MAX - 1).steps_per_bin, 1 << 50);
    }

    #[test]
    fn drift_and_short_windows_have_none() {
        let drifting: Vec<f64> = noise(4096)
            .iter()
            .enumerate()
            .map(|(k, x)| x + k as f64 * 1e-3)
            .collect();
        assert!(matches!(
            uncertainty(&drifting, [0.0, 1.0]),
            Err(NoUncertainty::Drift { .. } | NoUncertainty::TooFewBlocks { .. })
        ));
        assert!(
            matches!(uncertainty(&noise(30), [10.0, 20.0]), Err(NoUncertainty::TooFewBlocks { needed_time_star, .. }) if needed_time_star >= 30.0)
        );
        assert_eq!(uncertainty(&[0.5; 1000], [0.0, 1.0]), Ok(0.0));
    }
}
