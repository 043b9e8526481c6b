//! Round numbers along an axis, as many as fit.

use crate::axis::DrawnAxis;
use crate::style::SIZE_TEXT;
use crate::text::{MINUS, Text, number};

/// A tick: its pixel along the side, and its number.
pub(crate) type Tick = (f64, Text);

/// Direction of an axis: numbers need their width along x, their height along y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Direction {
    X,
    Y,
}

/// Largest number of steps of a linear axis where there is room.
pub(crate) const MAX_STEPS: usize = 6;
/// Least distance of a number from the next one along the axis.
const APART_X: f64 = 20.0;
const APART_Y: f64 = 14.0;
/// Number of decades above which short ticks would be too dense.
const SHORT_TICK_DECADES: f64 = 4.0;

impl DrawnAxis {
    /// Numbered ticks, as many as have room: round numbers in at most `most` steps, or 1, 2, 5 times powers
    /// of ten.
    pub(crate) fn ticks(&self, direction: Direction, most: usize) -> Vec<Tick> {
        let mut choices = Vec::new();
        if self.is_log {
            let decades = ((self.hi - self.lo) / 2.0).ceil().clamp(1.0, 100.0) as i32;
            choices.push(self.logarithmic_ticks(&[1.0, 2.0, 5.0], 1));
            choices.extend((1..=decades).map(|every| self.logarithmic_ticks(&[1.0], every)));
            choices.retain(|ticks| ticks.len() >= 2);
        }
        // A logarithmic axis of less than about half a decade is numbered like a linear one.
        if choices.first().is_none_or(|ticks| ticks.len() < 3) {
            choices = (2..=most).rev().map(|most| self.linear_ticks(most)).collect();
            // An axis can lie between two round numbers that are half its length apart, but it contains at
            // least one of those that are a third apart.
            choices.retain(|ticks| !ticks.is_empty());
            if choices.is_empty() {
                choices.push(self.linear_ticks(3));
            }
        }
        if let Some(chosen) = choices.iter().find(|ticks| apart(ticks, direction)) {
            return chosen.clone();
        }
        // Keeps the two outermost numbers, or only one if they touch.
        let mut sparsest = choices.pop().unwrap_or_default();
        sparsest.drain(1.min(sparsest.len())..sparsest.len().saturating_sub(1));
        if !apart(&sparsest, direction) {
            sparsest.truncate(1);
        }
        sparsest
    }

    /// The pixels of ticks without a number, which mark an axis as logarithmic.
    pub(crate) fn short_ticks(&self) -> Vec<f64> {
        if !self.is_log || self.hi - self.lo > SHORT_TICK_DECADES {
            return Vec::new();
        }
        let digits = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];
        let ticks = self.round_logarithms(&digits, 1);
        ticks.into_iter().map(|(_, _, at)| at).collect()
    }

    /// Round values in at most `most` steps (but at least two).
    fn linear_ticks(&self, most: usize) -> Vec<Tick> {
        let value = |end: f64| if self.is_log { libm::exp10(end) } else { end };
        let (lo, hi) = (value(self.lo), value(self.hi));
        let (step, values) = round_values(lo, hi, most);
        let power = power_of(lo.abs().max(hi.abs()));
        let text = |value| Text::number(&written(value, step, power), SIZE_TEXT);
        let ticks = values.into_iter().map(|value| (self.at(value), text(value)));
        ticks.filter(|(at, _)| at.is_finite()).collect()
    }

    fn logarithmic_ticks(&self, digits: &[f64], every: i32) -> Vec<Tick> {
        let ticks = self.round_logarithms(digits, every);
        let plain = ticks.iter().all(|(_, power, _)| (-4..5).contains(power));
        let tick = |&(digit, power, at): &(f64, i32, f64)| {
            let written = if plain {
                number(digit * libm::exp10(f64::from(power)), (-power).max(0) as usize)
            } else {
                format!("{digit}e{power}").replace('-', MINUS)
            };
            (at, Text::number(&written, SIZE_TEXT))
        };
        ticks.iter().map(tick).collect()
    }

    /// Values on the axis that are a digit times a power of ten, with their pixels; exponents are multiples
    /// of `every`.
    fn round_logarithms(&self, digits: &[f64], every: i32) -> Vec<(f64, i32, f64)> {
        let tolerance = 1e-9 * (self.hi - self.lo);
        let (from, to) = (self.lo - tolerance, self.hi + tolerance);
        let powers = (from.floor() as i32..=to.floor() as i32).filter(|power| power.rem_euclid(every) == 0);
        powers
            .flat_map(|power| digits.iter().map(move |&digit| (digit, power)))
            .map(|(digit, power)| (digit, power, libm::log10(digit) + f64::from(power)))
            .filter(|(_, _, logarithm)| (from..=to).contains(logarithm))
            .map(|(digit, power, logarithm)| (digit, power, self.at_measured(logarithm)))
            .collect()
    }
}

/// True when no number touches the next one.
pub(crate) fn apart(ticks: &[Tick], direction: Direction) -> bool {
    ticks.windows(2).all(|pair| {
        let (a, b) = (&pair[0], &pair[1]);
        let (extent, gap) = match direction {
            Direction::X => (0.5 * (a.1.width() + b.1.width()), APART_X),
            Direction::Y => (0.5 * (a.1.height() + b.1.height()), APART_Y),
        };
        (a.0 - b.0).abs() >= extent + gap
    })
}

/// The step between round values from `lo` to `hi`, and the values; none if `lo` and `hi` lie between two of
/// them.
pub(crate) fn round_values(lo: f64, hi: f64, most: usize) -> (f64, Vec<f64>) {
    let step = round_step((hi - lo) / most.max(2) as f64);
    let first = (lo / step - 1e-9).ceil();
    let count = ((hi / step + 1e-9).floor() - first + 1.0).clamp(0.0, 101.0) as usize;
    let values = (0..count).map(|index| (first + index as f64) * step);
    (step, values.collect())
}

/// The smallest of 1, 2, 5, 10, ... that is at least `step`.
fn round_step(step: f64) -> f64 {
    let power = libm::exp10(power_of(step));
    let mut digits = [1.0, 2.0, 5.0].into_iter();
    let digit = digits.find(|digit| digit * power >= step * (1.0 - 1e-9));
    digit.unwrap_or(10.0) * power
}

/// The power of ten of the first digit.
fn power_of(value: f64) -> f64 {
    libm::log10(value).floor()
}

/// A round value among values that are `step` apart, as text; very large and very small ones as multiples of
/// one power of ten: `0.5e-9`, `1.0e-9`.
fn written(value: f64, step: f64, power: f64) -> String {
    let smallest = power_of(step);
    if (-4.0..6.0).contains(&power) {
        return number(value, (-smallest).clamp(0.0, 12.0) as usize);
    }
    if value == 0.0 {
        return "0".to_string();
    }
    // Divided in two steps: the power of the smallest values has no finite inverse.
    let half = libm::pow(10.0, 0.5 * power);
    let decimals = (power - smallest).clamp(0.0, 9.0) as usize;
    format!("{}e{}", number(value / half / half, decimals), number(power, 0))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn texts(ticks: Vec<Tick>) -> Vec<String> {
        let text = |(_, text): Tick| text.runs.into_iter().map(|run| run.text).collect();
        ticks.into_iter().map(text).collect()
    }

    fn linear(lo: f64, hi: f64) -> Vec<String> {
        let axis = DrawnAxis::linear(lo, hi).placed(0.0, 3000.0);
        texts(axis.ticks(Direction::X, MAX_STEPS))
    }

    fn around(values: &[f64], log: bool, length: f64) -> Vec<String> {
        let axis = DrawnAxis::around(values, log, 0.0).placed(0.0, length);
        let ticks = axis.ticks(Direction::X, MAX_STEPS);
        assert!(apart(&ticks, Direction::X), "{values:?}");
        texts(ticks)
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(linear(0.0, 267.0), ["0", "50", "100", "150", "200", "250"]);
        assert_eq!(linear(-0.1, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(linear(-1.0, 1.0)[0], "\u{2212}1.0");
        assert_eq!(linear(0.0, 2e-7)[2], "1.0\u{d7}10\u{2212}7");
    }

    #[test]
    fn a_short_axis_is_numbered_at_its_ends() {
        let numbers = |length: f64| {
            let axis = DrawnAxis::linear(0.0, 1.0).placed(length, 0.0);
            texts(axis.ticks(Direction::Y, 2))
        };
        assert_eq!(numbers(80.0), ["0.0", "0.5", "1.0"]);
        assert_eq!(numbers(43.0), ["0.0", "1.0"]);
        assert_eq!(numbers(20.0), ["0.0"]);
    }

    #[test]
    fn odd_ranges_have_some_ticks() {
        for (lo, hi) in [
            (1e16, 1.2e16),
            (-3e-9, 4e-9),
            (0.999_999, 1.000_001),
            (-1e99, 1e99),
        ] {
            let ticks = linear(lo, hi);
            assert!((2..=8).contains(&ticks.len()), "{lo} {hi}: {ticks:?}");
        }
    }

    #[test]
    fn a_logarithmic_axis_is_numbered_as_densely_as_fits() {
        assert_eq!(
            around(&[0.01, 0.2], true, 800.0),
            ["0.01", "0.02", "0.05", "0.1", "0.2"]
        );
        assert_eq!(around(&[1e-3, 1.0], true, 600.0), ["0.001", "0.01", "0.1", "1"]);
        assert_eq!(
            around(&[1e-9, 1.0], true, 500.0),
            ["10\u{2212}8", "10\u{2212}6", "10\u{2212}4", "10\u{2212}2", "100"]
        );
        // Too short for 1, 2, 5.
        assert_eq!(around(&[0.3, 0.4], true, 560.0)[1], "0.32");
    }

    #[test]
    fn small_and_large_numbers_share_a_power_of_ten() {
        assert_eq!(
            around(&[0.0, 1e-9], false, 1000.0)[..2],
            ["0", "0.2\u{d7}10\u{2212}9"]
        );
        assert_eq!(around(&[12345.0, 12349.0], false, 800.0)[0], "12345");
        assert_eq!(around(&[0.003, 0.0035], false, 800.0)[0], "0.0030");
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// For any range and length, an axis has numbers that lie on it, do not touch and are all different.
        #[test]
        fn numbers_of_any_axis_differ_and_are_apart(
            middle in -1.0..1.0, power in -12..12, spread in -6.0..0.0, length in 1.0..3000.0, most in 2..=MAX_STEPS,
        ) {
            let scale = libm::exp10(f64::from(power));
            let half = scale * libm::exp10(spread);
            let axis = DrawnAxis::linear(scale * middle - half, scale * middle + half).placed(0.0, length);
            let ticks = axis.ticks(Direction::X, most);
            prop_assert!((1..=most + 1).contains(&ticks.len()));
            prop_assert!(apart(&ticks, Direction::X));
            // Tolerance for rounding: the middle can be a million times as large as the range.
            let is_on_axis = |(at, _): &Tick| (-1e-9 * length..=(1.0 + 1e-9) * length).contains(at);
            prop_assert!(ticks.iter().all(is_on_axis));
            let mut numbers = texts(ticks);
            let n = numbers.len();
            numbers.dedup();
            prop_assert_eq!(numbers.len(), n);
        }
    }
}
