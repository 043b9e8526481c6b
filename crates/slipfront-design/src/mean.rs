//! Means over surfaces.

use serde::Serialize;
use slipfront_study::{CONFIDENCE, Sample};

/// A mean over surfaces with its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Mean {
    /// The mean.
    pub mean: f64,
    /// Half the width of the 95 % confidence interval of the mean; none if surfaces do not differ.
    pub half_width: Option<f64>,
    /// Standard deviation over surfaces; none if surfaces do not differ.
    pub deviation: Option<f64>,
}

impl Mean {
    /// The mean of values, with its interval if there are several.
    pub(crate) fn from_values(values: &[f64]) -> Self {
        let sample = Sample::from_values(values, CONFIDENCE);
        let mean = sample.map_or(f64::NAN, |sample| sample.mean);
        // Differences that are due to rounding alone do not count as scatter.
        let scatters = |width: &f64| *width > 1e-12 * mean.abs();
        Self {
            mean,
            half_width: sample.and_then(|sample| sample.half_width).filter(scatters),
            deviation: sample.and_then(|sample| sample.deviation).filter(scatters),
        }
    }

    /// Lower end of the interval.
    pub(crate) fn low(&self) -> f64 {
        self.mean - self.half_width.unwrap_or(0.0)
    }
}
