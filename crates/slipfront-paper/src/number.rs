//! A measured number and its confidence interval.

use serde::{Deserialize, Serialize};
use slipfront_base::number_format::with_interval;
use slipfront_study::Sample;

/// Confidence of all intervals.
const CONFIDENCE: f64 = 0.95;

/// A measured number.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasuredNumber {
    /// The value, or the mean over random surfaces.
    pub value: f64,
    /// The 95 % confidence interval of the mean; none for a single value.
    pub interval: Option<[f64; 2]>,
}

impl MeasuredNumber {
    /// A single value.
    pub fn exact(value: f64) -> Self {
        Self {
            value,
            interval: None,
        }
    }

    /// The mean over random surfaces; NaN if there are no values.
    pub fn from_values(values: &[f64]) -> Self {
        match Sample::from_values(values, CONFIDENCE) {
            Some(sample) => Self {
                value: sample.mean,
                interval: sample.interval(),
            },
            None => Self::exact(f64::NAN),
        }
    }

    /// The mean and the ends of its interval as pictures need them: NaN if there is no interval.
    pub(super) fn ends(&self) -> [f64; 3] {
        let [low, high] = self.interval.unwrap_or([f64::NAN; 2]);
        [self.value, low, high]
    }

    /// The number with `digits` decimal places, and the half width of its interval.
    pub(super) fn shown(&self, digits: usize) -> String {
        with_interval(self.value, self.interval, digits)
    }
}

/// Values of several numbers, without their intervals.
pub(super) fn values(numbers: &[MeasuredNumber]) -> Vec<f64> {
    numbers.iter().map(|number| number.value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_show_what_is_known_of_them() {
        let number = |value: f64, interval| MeasuredNumber { value, interval }.shown(2);
        assert_eq!(number(0.126, Some([0.1, 0.152])), "0.13 \u{b1} 0.03");
        assert_eq!(number(-0.126, None), "-0.13");
        assert_eq!(number(0.0, None), "0");
        assert_eq!(number(0.00021, None), "2.1e-4");
    }
}
