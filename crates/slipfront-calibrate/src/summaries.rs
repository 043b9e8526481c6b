//! Summaries of a curve of friction: numbers from which a calibration learns.
//!
//! `y_i`, i from 0 to n - 1, is friction at n instants or places in equal steps. Widths of windows are shares of the record:
//! "w of 400" is w n/400 values. `s3` and `s5` are running means over 3 and 5 of 400, `m` is the mean of the second half, in
//! which a slider is taken to slide steadily. Each file of this folder has the formulas of its numbers; they are ratios and
//! logarithms, so that a regression on them can be nearly linear.

mod levels;
mod loading;
mod release;
mod steady;

/// Smallest number of values of a curve that has summaries.
pub(crate) const MIN_VALUES: usize = 40;

/// Lower bound of ratios, and of friction in its unit, before their logarithm is taken.
const LEAST: f64 = 1e-4;

/// A curve, with quantities that several summaries need.
pub(crate) struct Curve<'a> {
    /// The values.
    y: &'a [f64],
    /// Running mean over 3 of 400.
    s3: Vec<f64>,
    /// Running mean over 5 of 400.
    s5: Vec<f64>,
    /// Mean of the second half.
    level: f64,
    /// Position of the first peak.
    peak: usize,
}

impl<'a> Curve<'a> {
    fn new(y: &'a [f64]) -> Self {
        let (s3, s5) = (running_mean(y, window(y, 3)), running_mean(y, window(y, 5)));
        let level = level(y);
        let peak = first_peak(&s5, 0.06 * level.abs());
        Self {
            y,
            s3,
            s5,
            level,
            peak,
        }
    }

    /// Height of the first peak: the running mean over 5 of 400 at its position.
    fn height(&self) -> f64 {
        self.s5[self.peak]
    }

    /// A number of values that is a share of the record, given as `count` of 400.
    fn of_400(&self, count: usize) -> usize {
        window(self.y, count)
    }
}

/// Mean of the second half of a curve.
pub(crate) fn level(y: &[f64]) -> f64 {
    mean(&y[y.len() / 2..])
}

/// Number of values that is a share of `y`, given as `count` of 400; one at least.
fn window(y: &[f64], count: usize) -> usize {
    ((count * y.len() + 200) / 400).max(1)
}

/// The summaries of a curve of at least [`MIN_VALUES`] values, in a fixed order.
///
/// # Panics
/// If there are fewer values.
pub(crate) fn summaries(y: &[f64]) -> Vec<f64> {
    assert!(y.len() >= MIN_VALUES);
    let curve = Curve::new(y);
    let mut found = loading::summaries(&curve);
    found.extend(release::summaries(&curve));
    found.extend(levels::summaries(&curve));
    found.extend(steady::summaries(&curve));
    // A curve without friction, or without noise, has ratios that are none.
    for value in &mut found {
        if !value.is_finite() {
            *value = 0.0;
        }
    }
    found
}

/// Number of the summaries of a curve.
pub(crate) fn n_summaries() -> usize {
    summaries(&[0.0; MIN_VALUES]).len()
}

/// Position of the first peak: of the largest value up to the first fall by `fall` below the largest so far, or of all
/// values.
fn first_peak(s: &[f64], fall: f64) -> usize {
    let mut peak = 0;
    for (i, &value) in s.iter().enumerate() {
        if value > s[peak] {
            peak = i;
        }
        if s[peak] - value > fall {
            break;
        }
    }
    peak
}

/// Running mean over the values from `w/2` before to `w/2` behind, both rounded down, without those beyond the ends.
fn running_mean(y: &[f64], w: usize) -> Vec<f64> {
    let half = w / 2;
    (0..y.len())
        .map(|i| mean(&y[i.saturating_sub(half)..(i + half + 1).min(y.len())]))
        .collect()
}

/// The mean.
fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Standard deviation about the mean, with n in the denominator.
fn deviation(values: &[f64]) -> f64 {
    let middle = mean(values);
    let squares: f64 = values
        .iter()
        .map(|value| (value - middle) * (value - middle))
        .sum();
    (squares / values.len() as f64).sqrt()
}

/// The logarithm of a ratio, which is bounded from below by [`LEAST`].
fn log(ratio: f64) -> f64 {
    libm::log(ratio.max(LEAST))
}

/// Quantiles of values, interpolated between them.
pub(crate) fn quantiles<const N: usize>(values: &[f64], shares: [f64; N]) -> [f64; N] {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    shares.map(|share| {
        let place = share * (sorted.len() - 1) as f64;
        let below = place as usize;
        let above = (below + 1).min(sorted.len() - 1);
        sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ramp to 1 at value 100 of 400, a fall to 1/2 within 20, and rest.
    pub(crate) fn ramp_and_fall() -> Vec<f64> {
        (0..400)
            .map(f64::from)
            .map(|i| (i / 100.0).min((1.0 - (i - 100.0) / 40.0).max(0.5)))
            .collect()
    }

    #[test]
    fn the_peak_is_the_first_from_which_friction_falls() {
        assert_eq!(first_peak(&[0.0, 1.0, 0.99, 2.0, 1.5, 9.0], 0.1), 3);
        assert_eq!(first_peak(&[0.0, 1.0, 2.0], 0.1), 2);
        let y = ramp_and_fall();
        let curve = Curve::new(&y);
        // The mean over five is largest one before the peak, since the fall is faster than the rise.
        assert_eq!((curve.peak, curve.level), (99, 0.5));
    }

    #[test]
    fn means_and_quantiles() {
        assert_eq!(running_mean(&[1.0, 2.0, 6.0], 3), [1.5, 3.0, 4.0]);
        assert_eq!(running_mean(&[1.0, 2.0, 6.0], 1), [1.0, 2.0, 6.0]);
        assert_eq!(quantiles(&[4.0, 0.0, 2.0], [0.0, 0.25, 1.0]), [0.0, 1.0, 4.0]);
        assert_eq!(deviation(&[1.0, 3.0]), 1.0);
    }

    #[test]
    fn every_curve_has_finite_summaries() {
        for y in [vec![0.0; 40], vec![0.3; 1000], ramp_and_fall()] {
            let found = summaries(&y);
            assert!(found.iter().all(|value| value.is_finite()), "{found:?}");
        }
        assert_eq!(summaries(&[0.0; 40]).len(), summaries(&ramp_and_fall()).len());
    }
}
