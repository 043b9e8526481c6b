//! The kinetic friction coefficient: a mean over a window after the transition, with its uncertainty.

use serde::{Deserialize, Serialize};

use super::observer::Observer;
use crate::error::RunError;
use crate::measure::{CurvePoint, Peak};
use crate::model::ONSET_PATH;
use crate::snapshot::Snapshot;

/// Beginning of the kinetic window, which ends with the run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum KineticStart {
    /// At t_s* + 2.5/V*; at 5/V* (twice the usual t_s*, Eq. 12) in a run without a transition.
    Auto,
    /// At a given t*.
    At(f64),
}

impl KineticStart {
    /// Beginning of the window, t* of the drive, from the peak of mu* found so far, at a [loading
    /// speed](crate::Model::loading_speed) of `v_star`.
    pub fn time_star(&self, peak: &Peak, v_star: f64) -> f64 {
        match *self {
            KineticStart::At(time_star) => time_star,
            KineticStart::Auto if peak.ended => peak.drive_time_star + ONSET_PATH / v_star,
            KineticStart::Auto => 2.0 * ONSET_PATH / v_star,
        }
    }
}

/// Friction in the kinetic window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kinetic {
    /// First and last t* over which the mean is taken.
    pub window_star: [f64; 2],
    /// mu_k*, the mean of mu*.
    pub mu_star: f64,
    /// Standard error of mu_k* as an estimate of the mean over an infinite run, or the reason why it cannot
    /// be estimated.
    pub uncertainty: Result<f64, NoUncertainty>,
    /// Mean of mu_lateral_star.
    pub mu_lateral_star: f64,
    /// Mean of N*.
    pub sliding_percent: f64,
}

/// Reason why the uncertainty of a mean cannot be estimated from the scatter inside its window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoUncertainty {
    /// The window is shorter than 40/V*, or has fewer than 40 steps.
    TooShort {
        /// t* up to which the run should go.
        needed_time_star: f64,
    },
    /// A program changes the speed of the drive: the run is not part of an infinite one.
    SpeedChanges,
    /// The mean of the first half or of the first quarter differs by more than two standard errors from the
    /// mean of the rest: mu* still drifts.
    Drift {
        /// t* up to which the run should go.
        needed_time_star: f64,
    },
}

/// Keeps mu*, the friction across the drive and N* of the whole run as at most [`KineticHistory::BINS`] means
/// over equal numbers of steps in which the drive moves, so that memory does not grow with the run. Its times
/// are times of the drive. The observer must be called at every step.
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

    /// An empty history of a run of `last_step` steps of the drive; [`u64::MAX`] for a run without an end. In
    /// a longer run each mean takes twice as many steps, as often as necessary.
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

    /// Whether the history can have begun as `new` and been called at every step until the drive had moved in
    /// `drive_steps`.
    pub fn is_consistent_with(&self, new: &Self, drive_steps: u64) -> bool {
        let observed = drive_steps.saturating_add(1);
        let mut steps_per_bin = new.steps_per_bin;
        while observed.div_ceil(steps_per_bin) > Self::BINS {
            steps_per_bin *= 2;
        }
        self.steps_per_bin == steps_per_bin
            && self.in_bin == observed % steps_per_bin
            && self.bins.len() as u64 == observed.div_ceil(steps_per_bin)
    }

    /// Adds the next step of the drive.
    fn add(&mut self, point: &CurvePoint) {
        if self.in_bin == 0 {
            if self.bins.len() as u64 == Self::BINS {
                self.merge_pairs();
            }
            self.bins.push(Bin::default());
        }
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

    /// Means over the window from `from_star` to the end, at a [loading speed](crate::Model::loading_speed)
    /// of `v_star`; none if the window is empty.
    pub fn kinetic(&self, from_star: f64, dt_star: f64, v_star: f64) -> Option<Kinetic> {
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
            uncertainty: uncertainty(&mu_star, window_star, v_star),
            mu_lateral_star: window.iter().map(|bin| bin.mu_lateral_star).sum::<f64>() / window.len() as f64,
            sliding_percent: window.iter().map(|bin| bin.sliding_percent).sum::<f64>() / window.len() as f64,
        })
    }
}

impl Observer for KineticHistory {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        self.sliding_percent_max = self.sliding_percent_max.max(now.point.sliding_percent);
        // A mean over the path of the drive, which is the mean over time if the drive always moves.
        if now.clock.drive_moved() {
            self.add(&now.point);
        }
        Ok(())
    }
}

fn mean(x: &[f64]) -> f64 {
    x.iter().sum::<f64>() / x.len() as f64
}

/// A difference between parts of a window below this is no drift: it is smaller than the error of any time
/// step.
const NEGLIGIBLE_DRIFT: f64 = 1e-6;

/// V* times the shortest window that gives a standard error. Shorter windows hide slow changes: across a
/// groove, friction still rises by 0.3 % after the transition, which is not visible over 20/V*.
const LEAST_PATH: f64 = 40.0;

/// Largest difference between parts of a window that does not count as drift, in standard errors.
const MOST_DRIFT: f64 = 2.0;

/// Least number of steps, or means over steps, from the first to the last of a window that gives a standard
/// error.
const MIN_STEPS: usize = 40;

/// Standard error of the mean of a correlated series, if its window supports one.
fn uncertainty(x: &[f64], window_star: [f64; 2], v_star: f64) -> Result<f64, NoUncertainty> {
    let [from, until] = window_star;
    let bin_time = (until - from) / (x.len() as f64 - 1.0).max(1.0);
    let least = (LEAST_PATH / v_star).max(MIN_STEPS as f64 * bin_time);
    if until - from < least {
        return Err(NoUncertainty::TooShort {
            // Bins cut by the ends of the window do not count.
            needed_time_star: from + 1.01 * least,
        });
    }
    // The scatter of the parts is measured about the trend line of the whole, so that drift does not count as
    // scatter.
    let level = without_line(x);
    // Slow settling shows in the first half, and settling that has not ended when the window begins in the
    // first quarter.
    for first in [x.len() / 2, x.len() / 4] {
        let difference = (mean(&x[..first]) - mean(&x[first..])).abs();
        let [one, other] = [&level[..first], &level[first..]].map(standard_error);
        if difference > NEGLIGIBLE_DRIFT && difference > MOST_DRIFT * libm::hypot(one, other) {
            return Err(NoUncertainty::Drift {
                needed_time_star: until + (until - from),
            });
        }
    }
    Ok(standard_error(x))
}

/// A series minus its least-squares line.
fn without_line(x: &[f64]) -> Vec<f64> {
    let (center, middle) = (mean(x), 0.5 * (x.len() as f64 - 1.0));
    let places = || (0..x.len()).map(|k| k as f64 - middle);
    let slope = places().zip(x).map(|(place, value)| place * value).sum::<f64>()
        / places().map(|place| place * place).sum::<f64>();
    let residual = |(place, value): (f64, &f64)| value - center - slope * place;
    places().zip(x).map(residual).collect()
}

/// Largest number of values for an autoregressive model: longer series are first averaged over neighbours.
const MAX_VALUES: usize = 512;

/// Number of terms of the autoregressive model over the square root of the number of values.
const TERMS: f64 = 1.5;

/// Standard error of the mean of a correlated series of n values, from an autoregressive model of the series:
///
/// ```text
/// x_t = sum_i a_i x_t-i + noise,    i = 1 .. (3/2) sqrt(n)
/// ```
///
/// Burg's recursion (Burg 1975) finds its terms, and its autocovariances gamma(k) give the variance of the
/// mean over exactly this window:
///
/// ```text
/// se^2 = (1/n^2) sum_{|k| < n} (n - |k|) gamma(k)
/// ```
///
/// A slider that sticks and slips is anticorrelated: a rise in one cycle is a fall in the next, and the error
/// falls as 1/n, not as 1/sqrt(n). Estimates from independent blocks miss this, and criteria that reduce the
/// number of terms of the model (Akaike, Schwarz) underestimate it.
fn standard_error(x: &[f64]) -> f64 {
    let values: Vec<f64> = x.chunks_exact(x.len().div_ceil(MAX_VALUES)).map(mean).collect();
    let n = values.len() as f64;
    let covariances = autocovariances(&values);
    let weighted = covariances
        .iter()
        .zip(0..)
        .map(|(gamma, k)| (n - f64::from(k)) * gamma);
    // Every k but 0 counts twice. Rounding can make the sum of a periodic series slightly negative.
    let sum = 2.0 * weighted.sum::<f64>() - n * covariances[0];
    sum.max(0.0).sqrt() / n
}

/// Autocovariances gamma(0) to gamma(n - 1) of the autoregressive model of a series of n values.
fn autocovariances(x: &[f64]) -> Vec<f64> {
    let (n, center) = (x.len() as f64, mean(x));
    // Errors of predicting each value from those before it, and of predicting the value before these from
    // them.
    let mut forward: Vec<f64> = x.iter().map(|value| value - center).collect();
    let mut backward = forward.clone();
    let mut error = forward.iter().map(|value| value * value).sum::<f64>() / n;
    let (mut terms, mut covariances) = (Vec::new(), vec![error]);
    for order in 1..=(TERMS * n.sqrt()) as usize {
        let pairs = || forward[order..].iter().zip(&backward[order - 1..x.len() - 1]);
        let squares: f64 = pairs().map(|(f, b)| f * f + b * b).sum();
        if squares <= 0.0 {
            break;
        }
        let reflection = 2.0 * pairs().map(|(f, b)| f * b).sum::<f64>() / squares;
        covariances.push(reflection * error + predicted(&terms, &covariances));
        let reversed: Vec<f64> = terms.iter().rev().copied().collect();
        for (term, mirrored) in terms.iter_mut().zip(reversed) {
            *term -= reflection * mirrored;
        }
        terms.push(reflection);
        for t in (order..x.len()).rev() {
            let (f, b) = (forward[t], backward[t - 1]);
            (forward[t], backward[t]) = (f - reflection * b, b - reflection * f);
        }
        error *= 1.0 - reflection * reflection;
    }
    while covariances.len() < x.len() {
        covariances.push(predicted(&terms, &covariances));
    }
    covariances
}

/// The next of some autocovariances, `sum_i a_i gamma(k - i)`.
fn predicted(terms: &[f64], covariances: &[f64]) -> f64 {
    let latest = covariances.iter().rev();
    terms.iter().zip(latest).map(|(term, gamma)| term * gamma).sum()
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
        let found = uncertainty(&x, [0.0, 1.0], 40.0).unwrap();
        // The spectrum at frequency 0 of 48 terms over n/8 = 512 values has a relative error of sqrt(4
        // 48/512), and its square root half of that.
        assert!((found / expected - 1.0).abs() < 2.0 * 0.31, "{found} {expected}");
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
        let found = uncertainty(&x[1000..], [0.0, 1.0], 40.0).unwrap();
        assert!((found / expected - 1.0).abs() < 0.3, "{found} {expected}");
    }

    /// The history of a run with this noise as mu*.
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
        assert_eq!(
            without_end.kinetic(100.0, 0.1, 1.0),
            with_end.kinetic(100.0, 0.1, 1.0)
        );
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
        let [one, other] =
            [&without_end, &with_end].map(|history| history.kinetic(1000.0, 0.1, 1.0).unwrap());
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

    /// x_k = noise_k - noise_k-1: the sum is the difference of two numbers, with variance 1/6 for any length
    /// of the series.
    #[test]
    fn what_rises_and_falls_back_has_an_error_that_falls_with_the_length() {
        let noise = noise(513);
        let x: Vec<f64> = noise.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let expected = (1.0_f64 / 6.0).sqrt() / 512.0;
        let found = uncertainty(&x, [0.0, 1.0], 40.0).unwrap();
        let plain = (1.0_f64 / 6.0 / 512.0).sqrt();
        println!("{found} {expected} {plain}");
        assert!(
            found < 3.0 * expected && found > 0.5 * expected,
            "{found} {expected} {plain}"
        );
    }

    #[test]
    fn drift_and_short_windows_have_none() {
        let drifting: Vec<f64> = noise(4096)
            .iter()
            .enumerate()
            .map(|(k, x)| x + k as f64 * 1e-3)
            .collect();
        let drift = uncertainty(&drifting, [0.0, 1.0], 40.0);
        assert!(
            matches!(drift, Err(NoUncertainty::Drift { needed_time_star, .. }) if needed_time_star == 2.0),
            "{drift:?}"
        );
        // Ten units of time at V* = 0.1, where 400 are needed; and 30 steps of one unit each at V* = 10.
        let short = |needed_time_star| Err(NoUncertainty::TooShort { needed_time_star });
        assert_eq!(
            uncertainty(&noise(101), [10.0, 20.0], 0.1),
            short(10.0 + 1.01 * 400.0)
        );
        assert_eq!(
            uncertainty(&noise(31), [10.0, 40.0], 10.0),
            short(10.0 + 1.01 * 40.0)
        );
        assert_eq!(uncertainty(&[0.5; 1000], [0.0, 1.0], 40.0), Ok(0.0));
    }
}
