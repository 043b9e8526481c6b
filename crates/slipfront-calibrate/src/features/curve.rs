//! A curve of friction, with quantities and functions that several of its features need.

use std::ops::Range;

use slipfront_study::statistics::mean;

/// Lower bound of ratios, and of friction in its unit, before their logarithm is taken.
pub(super) const LEAST: f64 = 1e-4;

/// A curve, with quantities that several features need.
pub(super) struct Curve<'a> {
    /// The values.
    pub(super) y: &'a [f64],
    /// Running mean over 3 of 400.
    pub(super) s3: Vec<f64>,
    /// Running mean over 5 of 400.
    pub(super) s5: Vec<f64>,
    /// Mean of the second half.
    pub(super) level: f64,
    /// Position of the first peak.
    pub(super) peak: usize,
}

impl<'a> Curve<'a> {
    pub(super) fn new(y: &'a [f64]) -> Self {
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
    pub(super) fn height(&self) -> f64 {
        self.s5[self.peak]
    }

    /// Number of values in a share of the record, given as `count` of 400.
    pub(super) fn of_400(&self, count: usize) -> usize {
        window(self.y, count)
    }
}

/// Mean of the second half of a curve.
pub(crate) fn level(y: &[f64]) -> f64 {
    mean(&y[y.len() / 2..])
}

/// Number of values in a share of `y`, given as `count` of 400; at least one.
fn window(y: &[f64], count: usize) -> usize {
    ((count * y.len() + 200) / 400).max(1)
}

/// Position of the first peak: of the largest value up to the first fall by `fall` below the largest so far,
/// or of all values.
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

/// Running mean over the values from `w/2` before to `w/2` after each value, both rounded down, truncated at
/// the ends.
pub(super) fn running_mean(y: &[f64], w: usize) -> Vec<f64> {
    let half = w / 2;
    (0..y.len())
        .map(|i| mean(&y[i.saturating_sub(half)..(i + half + 1).min(y.len())]))
        .collect()
}

/// Standard deviation about the mean, with n in the denominator.
pub(crate) fn deviation(values: &[f64]) -> f64 {
    let middle = mean(values);
    let squares: f64 = values
        .iter()
        .map(|value| (value - middle) * (value - middle))
        .sum();
    (squares / values.len() as f64).sqrt()
}

/// Logarithm of the mean power of a curve of `n` values in bands of frequencies, in periods over the curve:
/// of `|E_k|^2/(n m^2)`, where `E_k` are Fourier coefficients, with a Hann window, of the differences `e`
/// from the mean `m`.
pub(super) fn log_power(e: &[f64], m: f64, bands: impl Iterator<Item = Range<usize>>) -> Vec<f64> {
    let n = e.len();
    let turn = std::f64::consts::TAU / n as f64;
    let (cosines, sines): (Vec<f64>, Vec<f64>) = (0..n)
        .map(|i| turn * i as f64)
        .map(|x| (libm::cos(x), libm::sin(x)))
        .unzip();
    let windowed: Vec<f64> = e
        .iter()
        .zip(&cosines)
        .map(|(e, c)| e * (0.5 - 0.5 * c) / m)
        .collect();
    let power = |k: usize| {
        let (mut re, mut im) = (0.0, 0.0);
        let mut place = 0;
        for e in &windowed {
            re += e * cosines[place];
            im += e * sines[place];
            place = (place + k) % n;
        }
        (re * re + im * im) / n as f64
    };
    let mean = |band: Range<usize>| band.clone().map(power).sum::<f64>() / band.len() as f64;
    bands.map(|band| libm::log(mean(band) + LEAST * LEAST)).collect()
}

/// The logarithm of a ratio, which is bounded from below by [`LEAST`].
pub(super) fn log(ratio: f64) -> f64 {
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
pub(super) mod tests {
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
        // The mean over five values is largest one value before the peak, since the fall is faster than the
        // rise.
        assert_eq!((curve.peak, curve.level), (99, 0.5));
    }

    #[test]
    fn means_and_quantiles() {
        assert_eq!(running_mean(&[1.0, 2.0, 6.0], 3), [1.5, 3.0, 4.0]);
        assert_eq!(running_mean(&[1.0, 2.0, 6.0], 1), [1.0, 2.0, 6.0]);
        assert_eq!(quantiles(&[4.0, 0.0, 2.0], [0.0, 0.25, 1.0]), [0.0, 1.0, 4.0]);
        assert_eq!(deviation(&[1.0, 3.0]), 1.0);
    }
}
