//! An axis: data to pixels, and round numbers along it.

use crate::text::{MINUS, number};

/// Larger values are taken as blank: their differences might not be finite.
const LARGEST: f64 = 1e100;

/// Smaller differences are taken as none: their parts might be zero.
const SMALLEST: f64 = 1e-290;

/// True when a value can be placed on an axis.
pub(crate) fn drawable(value: f64) -> bool {
    value.abs() < LARGEST
}

/// A linear axis from `lo` (drawn at pixel `start`) to `hi` (drawn at `end`).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    pub(crate) lo: f64,
    pub(crate) hi: f64,
    pub(crate) start: f64,
    pub(crate) end: f64,
}

impl Axis {
    /// The pixel of `value`.
    pub(crate) fn at(&self, value: f64) -> f64 {
        self.start + (value - self.lo) / (self.hi - self.lo) * (self.end - self.start)
    }

    /// True when `value` lies on the axis.
    pub(crate) fn holds(&self, value: f64) -> bool {
        (self.lo..=self.hi).contains(&value)
    }

    /// The pixel of `value`, or of the end it lies beyond.
    pub(crate) fn clamped(&self, value: f64) -> f64 {
        self.at(value.clamp(self.lo, self.hi))
    }

    /// At most `most` (but at least two) round values and how they are written.
    pub(crate) fn ticks(&self, most: usize) -> Vec<(f64, String)> {
        let (step, values) = self.round_values(most);
        let (largest, smallest) = (self.power(), step.log10().floor());
        let digits = (largest - smallest).clamp(0.0, 9.0) as usize;
        let decimals = (-smallest).clamp(0.0, 12.0) as usize;
        let written = |&value: &f64| {
            if (-4.0..6.0).contains(&largest) {
                number(value, decimals)
            } else {
                format!("{value:.digits$e}").replace('-', MINUS)
            }
        };
        values.iter().map(|value| (*value, written(value))).collect()
    }

    /// The same, very large and very small values as multiples of one power of ten: `0.5e-9`, `1.0e-9`.
    pub(crate) fn scaled_ticks(&self, most: usize) -> Vec<(f64, String)> {
        let power = self.power();
        if (-4.0..6.0).contains(&power) {
            return self.ticks(most);
        }
        let (step, values) = self.round_values(most);
        let decimals = (power - step.log10().floor()).clamp(0.0, 9.0) as usize;
        let exponent = number(power, 0);
        // Divided in two steps: the power of the smallest values has no finite inverse.
        let half = 10f64.powf(0.5 * power);
        let written = |value: f64| match value {
            0.0 => "0".to_string(),
            _ => format!("{}e{exponent}", number(value / half / half, decimals)),
        };
        values.into_iter().map(|value| (value, written(value))).collect()
    }

    /// The distance of the ticks and where they are.
    fn round_values(&self, most: usize) -> (f64, Vec<f64>) {
        let step = round_step((self.hi - self.lo) / most.max(2) as f64);
        let first = (self.lo / step - 1e-9).ceil();
        let count = ((self.hi / step + 1e-9).floor() - first).clamp(0.0, 100.0) as usize;
        (
            step,
            (0..=count).map(|index| (first + index as f64) * step).collect(),
        )
    }

    /// The power of ten of the largest value.
    fn power(&self) -> f64 {
        self.lo.abs().max(self.hi.abs()).log10().floor()
    }
}

/// The smallest of 1, 2, 5, 10, ... that is at least `step`.
fn round_step(step: f64) -> f64 {
    let power = 10f64.powf(step.log10().floor());
    let digit = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|digit| digit * power >= step * (1.0 - 1e-9));
    digit.unwrap_or(10.0) * power
}

/// The smallest and largest drawable value; 0 and 1 when there is none.
pub(crate) fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (lo, hi) = values
        .filter(|&value| drawable(value))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), value| {
            (lo.min(value), hi.max(value))
        });
    if lo <= hi { (lo, hi) } else { (0.0, 1.0) }
}

/// The same range, or one around it when it is too narrow to be an axis.
pub(crate) fn widened((lo, hi): (f64, f64)) -> (f64, f64) {
    let size = lo.abs().max(hi.abs());
    if hi - lo > 1e-9 * size && hi - lo > SMALLEST {
        return (lo, hi);
    }
    let margin = if size > SMALLEST { 0.1 * size } else { 0.5 };
    (lo - margin, hi + margin)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(lo: f64, hi: f64) -> Vec<String> {
        let axis = Axis {
            lo,
            hi,
            start: 0.0,
            end: 100.0,
        };
        axis.ticks(6).into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(written(0.0, 267.0), ["0", "50", "100", "150", "200", "250"]);
        assert_eq!(written(-0.1, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(written(-1.0, 1.0)[0], "\u{2212}1.0");
        assert_eq!(written(0.0, 2e-7)[2], "1.0e\u{2212}7");
    }

    #[test]
    fn odd_ranges_still_make_an_axis() {
        assert_eq!(range([f64::NAN, f64::INFINITY].into_iter()), (0.0, 1.0));
        assert_eq!(widened((0.0, 0.0)), (-0.5, 0.5));
        let (lo, hi) = widened((1e16, 1e16));
        assert!(lo < 1e16 && hi > 1e16);
        for (lo, hi) in [
            (1e16, 1.2e16),
            (-3e-9, 4e-9),
            (0.999_999, 1.000_001),
            (-1e99, 1e99),
        ] {
            let ticks = written(lo, hi);
            assert!((2..=8).contains(&ticks.len()), "{lo} {hi}: {ticks:?}");
        }
    }
}
