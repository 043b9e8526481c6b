//! Statistics of a sample: mean, spread, and Student's confidence interval of the mean.

use statrs::distribution::{ContinuousCDF, StudentsT};

/// Statistics of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Number of values.
    pub n: usize,
    /// Mean.
    pub mean: f64,
    /// Standard deviation, with n - 1 in the denominator; none for a single value.
    pub deviation: Option<f64>,
    /// Half width of the confidence interval of the mean.
    pub half_width: Option<f64>,
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
}

impl Sample {
    /// Statistics of `values`, with an interval of the given confidence; none if there are no values.
    ///
    /// ```text
    /// half width = t(n - 1, (1 + confidence)/2) s/sqrt(n)
    /// ```
    pub fn from_values(values: &[f64], confidence: f64) -> Option<Self> {
        let n = values.len();
        if n == 0 {
            return None;
        }
        let mean = mean(values);
        let deviation = (n > 1).then(|| {
            let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
            (squares / (n - 1) as f64).sqrt()
        });
        let half_width =
            deviation.map(|deviation| student(n - 1, confidence) * deviation / (n as f64).sqrt());
        let min = values.iter().copied().fold(f64::INFINITY, f64::min);
        let max = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Some(Self {
            n,
            mean,
            deviation,
            half_width,
            min,
            max,
        })
    }

    /// Ends of the confidence interval of the mean; none for a single value.
    pub(crate) fn ends(&self) -> [Option<f64>; 2] {
        self.interval().map_or([None; 2], |ends| ends.map(Some))
    }

    /// Confidence interval of the mean.
    pub fn interval(&self) -> Option<[f64; 2]> {
        self.half_width.map(|half| [self.mean - half, self.mean + half])
    }
}

/// The mean of values, limited to their range despite rounding. The mean of equal values is exactly their
/// value, so their standard deviation is 0.
pub fn mean(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // NaN stays NaN.
    if mean < lowest {
        lowest
    } else if mean > highest {
        highest
    } else {
        mean
    }
}

/// Two-sided quantile of Student's t.
fn student(degrees: usize, confidence: f64) -> f64 {
    // Both parameters are valid by construction; a degree of freedom is at least 1.
    StudentsT::new(0.0, 1.0, degrees as f64).map_or(f64::NAN, |t| t.inverse_cdf(0.5 * (1.0 + confidence)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use slipfront::surface::{Coefficients, Distribution};

    #[test]
    fn quantiles_are_those_of_the_tables() {
        // Printed tables give four digits.
        for (degrees, confidence, expected) in [
            (1, 0.95, 12.7062),
            (4, 0.95, 2.7764),
            (9, 0.99, 3.2498),
            (30, 0.90, 1.6973),
        ] {
            assert!(
                (student(degrees, confidence) - expected).abs() < 5e-5,
                "{degrees} {confidence}"
            );
        }
    }

    /// The sum of seven times 0.1 over 7 is not 0.1.
    #[test]
    fn equal_values_do_not_scatter() {
        for value in [0.1, 0.8907, 1e-9, -3.3] {
            for n in 2..20 {
                let sample = Sample::from_values(&vec![value; n], 0.95).unwrap();
                assert_eq!(
                    (sample.mean, sample.deviation, sample.half_width),
                    (value, Some(0.0), Some(0.0))
                );
            }
        }
        assert!(mean(&[1.0, f64::NAN, 2.0]).is_nan());
    }

    #[test]
    fn a_known_sample() {
        let sample = Sample::from_values(&[1.0, 2.0, 3.0, 4.0, 5.0], 0.95).unwrap();
        assert_eq!(
            (sample.n, sample.mean, sample.min, sample.max),
            (5, 3.0, 1.0, 5.0)
        );
        assert!((sample.deviation.unwrap() - 2.5_f64.sqrt()).abs() < 1e-15);
        assert!((sample.half_width.unwrap() - 2.7764451 * (0.5_f64).sqrt()).abs() < 1e-6);
        assert_eq!(Sample::from_values(&[2.0], 0.95).unwrap().half_width, None);
        assert_eq!(Sample::from_values(&[], 0.95), None);
    }

    #[test]
    fn intervals_cover_the_true_mean_as_often_as_they_claim() {
        let trials = 2000;
        let unit = Distribution {
            mean: 100.0,
            deviation: 1.0,
        };
        let covered = (0..trials)
            .filter(|&trial| {
                let values = Coefficients::draw(6, unit, unit, trial).mu_static;
                let [low, high] = Sample::from_values(&values, 0.9).unwrap().interval().unwrap();
                (low..=high).contains(&100.0)
            })
            .count();
        // 90 % of 2000 trials are 1800 +- 13.4; the bound is five standard errors.
        assert!(covered.abs_diff(1800) < 67, "{covered}");
    }
}
