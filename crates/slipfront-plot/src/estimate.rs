//! A mean with its confidence interval, as curves, bars and maps of studies show it.

use serde::{Deserialize, Serialize};

use crate::axis::drawable;

/// A mean with its confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The mean; NaN where there is none.
    pub mean: f64,
    /// The lower end of the confidence interval; NaN where there is none.
    pub low: f64,
    /// The upper end of the confidence interval; NaN where there is none.
    pub high: f64,
    /// Whether a cross marks the mean, or its place if there is none.
    pub crossed: bool,
}

impl Estimate {
    /// Neither a mean nor an interval.
    pub const NONE: Self = Self {
        mean: f64::NAN,
        low: f64::NAN,
        high: f64::NAN,
        crossed: false,
    };

    /// A mean without an interval.
    pub fn exact(mean: f64) -> Self {
        Self { mean, ..Self::NONE }
    }

    /// A mean with an interval.
    pub fn between(low: f64, mean: f64, high: f64) -> Self {
        Self {
            mean,
            low,
            high,
            ..Self::NONE
        }
    }

    /// The ends of the interval in rising order, if these and the mean are numbers.
    pub(crate) fn interval(&self) -> Option<[f64; 2]> {
        let is_known = [self.mean, self.low, self.high].into_iter().all(drawable);
        is_known.then(|| [self.low.min(self.high), self.low.max(self.high)])
    }

    /// The mean if it can be drawn, or NaN.
    pub(crate) fn drawn_mean(&self) -> f64 {
        if drawable(self.mean) { self.mean } else { f64::NAN }
    }
}
