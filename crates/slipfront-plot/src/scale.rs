//! A linear or logarithmic axis, whose numbers keep apart.

use crate::axis::{Axis, drawable, range, widened};
use crate::frame::Tick;
use crate::style::SIZE_TICK;
use crate::text::{MINUS, Text, number};

/// A number keeps so far from the next one along its side.
const APART_X: f64 = 20.0;
const APART_Y: f64 = 14.0;
/// Over more decades than this, short ticks would be too dense.
const SHORT_TICK_DECADES: f64 = 4.0;

/// An axis of values, or of their logarithms.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    axis: Axis,
    log: bool,
}

/// Which way an axis runs: numbers need their width along x, their height along y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Direction {
    X,
    Y,
}

impl Scale {
    /// A scale around `values` with a margin of `pad` times its length at both ends, yet to be placed.
    ///
    /// It is logarithmic if `log` says so and every value that can be drawn is positive.
    pub(crate) fn around(values: &[f64], log: bool, pad: f64) -> Self {
        let log = log && values.iter().filter(|v| drawable(**v)).all(|&value| value > 0.0);
        let (lo, hi) = widened(range(values.iter().map(|&value| measured(value, log))));
        let pad = pad * (hi - lo);
        Self::between(lo - pad, hi + pad, log)
    }

    /// A scale from `lo` to `hi`, given as it measures them.
    pub(crate) fn between(lo: f64, hi: f64, log: bool) -> Self {
        let (start, end) = (0.0, 1.0);
        Self {
            axis: Axis { lo, hi, start, end },
            log,
        }
    }

    /// The same scale from one pixel to another.
    pub(crate) fn placed(mut self, start: f64, end: f64) -> Self {
        (self.axis.start, self.axis.end) = (start, end);
        self
    }

    /// The axis of what the scale measures.
    pub(crate) fn axis(&self) -> &Axis {
        &self.axis
    }

    /// Whether it measures logarithms.
    pub(crate) fn is_log(&self) -> bool {
        self.log
    }

    /// A value, or its logarithm.
    pub(crate) fn measure(&self, value: f64) -> f64 {
        measured(value, self.log)
    }

    /// The pixel of a value.
    pub(crate) fn at(&self, value: f64) -> f64 {
        self.axis.at(self.measure(value))
    }

    /// Numbered ticks, as many as have room: round numbers, or 1, 2, 5 times powers of ten.
    pub(crate) fn ticks(&self, direction: Direction) -> Vec<Tick> {
        let mut choices = Vec::new();
        if self.log {
            let decades = ((self.axis.hi - self.axis.lo) / 2.0).ceil().clamp(1.0, 100.0) as i32;
            choices.push(self.logarithmic(&[1.0, 2.0, 5.0], 1));
            choices.extend((1..=decades).map(|every| self.logarithmic(&[1.0], every)));
            choices.retain(|ticks| ticks.len() >= 2);
            // Less than about half a decade.
            if choices.first().is_none_or(|ticks| ticks.len() < 3) {
                choices = (2..=6).rev().map(|most| self.linear(most)).collect();
            }
        } else {
            choices.extend((2..=6).rev().map(|most| self.linear(most)));
        }
        let fits = |ticks: &&Vec<Tick>| apart(ticks, direction);
        if let Some(chosen) = choices.iter().find(fits) {
            return chosen.clone();
        }
        // One number touches no other.
        let sparsest = choices.pop().unwrap_or_default();
        sparsest.into_iter().take(1).collect()
    }

    /// The pixels of ticks without a number, which tell that a scale is logarithmic.
    pub(crate) fn short_ticks(&self) -> Vec<f64> {
        if !self.log || self.axis.hi - self.axis.lo > SHORT_TICK_DECADES {
            return Vec::new();
        }
        let digits = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];
        let ticks = self.round_logarithms(&digits, 1);
        ticks.into_iter().map(|(_, _, at)| at).collect()
    }

    fn linear(&self, most: usize) -> Vec<Tick> {
        let values = if self.log {
            let [lo, hi] = [self.axis.lo, self.axis.hi].map(libm::exp10);
            Axis { lo, hi, ..self.axis }
        } else {
            self.axis
        };
        let ticks = values.scaled_ticks(most).into_iter();
        ticks
            .map(|(value, text)| (self.at(value), Text::number(&text, SIZE_TICK)))
            .filter(|(at, _)| at.is_finite())
            .collect()
    }

    fn logarithmic(&self, digits: &[f64], every: i32) -> Vec<Tick> {
        let ticks = self.round_logarithms(digits, every);
        let plain = ticks.iter().all(|(_, power, _)| (-4..5).contains(power));
        let written = |digit: f64, power: i32| {
            if plain {
                number(digit * libm::exp10(f64::from(power)), (-power).max(0) as usize)
            } else {
                format!("{digit}e{power}").replace('-', MINUS)
            }
        };
        ticks
            .iter()
            .map(|&(digit, power, at)| (at, Text::number(&written(digit, power), SIZE_TICK)))
            .collect()
    }

    /// Digits times powers of ten within the scale, of which only multiples of `every`, and their pixels.
    fn round_logarithms(&self, digits: &[f64], every: i32) -> Vec<(f64, i32, f64)> {
        let tolerance = 1e-9 * (self.axis.hi - self.axis.lo);
        let (from, to) = (self.axis.lo - tolerance, self.axis.hi + tolerance);
        let powers = (from.floor() as i32..=to.floor() as i32).filter(|power| power.rem_euclid(every) == 0);
        powers
            .flat_map(|power| digits.iter().map(move |&digit| (digit, power)))
            .map(|(digit, power)| (digit, power, libm::log10(digit) + f64::from(power)))
            .filter(|(_, _, logarithm)| (from..=to).contains(logarithm))
            .map(|(digit, power, logarithm)| (digit, power, self.axis.at(logarithm)))
            .collect()
    }
}

fn measured(value: f64, log: bool) -> f64 {
    if log { libm::log10(value) } else { value }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn written(values: &[f64], log: bool, length: f64) -> Vec<String> {
        let scale = Scale::around(values, log, 0.0).placed(0.0, length);
        let ticks = scale.ticks(Direction::X);
        assert!(apart(&ticks, Direction::X), "{values:?}");
        let text = |(_, text): Tick| text.runs.into_iter().map(|run| run.text).collect();
        ticks.into_iter().map(text).collect()
    }

    #[test]
    fn a_logarithmic_axis_is_numbered_as_densely_as_fits() {
        assert_eq!(
            written(&[0.01, 0.2], true, 800.0),
            ["0.01", "0.02", "0.05", "0.1", "0.2"]
        );
        assert_eq!(written(&[1e-3, 1.0], true, 600.0), ["0.001", "0.01", "0.1", "1"]);
        assert_eq!(
            written(&[1e-9, 1.0], true, 500.0),
            ["10\u{2212}8", "10\u{2212}6", "10\u{2212}4", "10\u{2212}2", "100"]
        );
        // Too short for 1, 2, 5.
        assert_eq!(written(&[0.3, 0.4], true, 500.0)[1], "0.32");
    }

    #[test]
    fn an_axis_through_zero_is_never_logarithmic() {
        assert!(!Scale::around(&[0.0, 1.0], true, 0.0).is_log());
        assert!(Scale::around(&[f64::NAN, 1.0], true, 0.0).is_log());
    }

    #[test]
    fn small_and_large_numbers_share_a_power_of_ten() {
        assert_eq!(
            written(&[0.0, 1e-9], false, 800.0)[..2],
            ["0", "0.2\u{d7}10\u{2212}9"]
        );
        assert_eq!(written(&[12345.0, 12349.0], false, 800.0)[0], "12345");
        assert_eq!(written(&[0.003, 0.0035], false, 800.0)[0], "0.0030");
    }
}
