//! The unknowns of a calibration: numeric keys of the case or of the instrument, each with a range.

use slipfront_case::case_file::Override;
use sobol_burley::{NUM_DIMENSIONS, sample};

/// A key of the case with a range of values, which are all equally likely before there is a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    key: String,
    from: f64,
    to: f64,
    unit: Option<String>,
    is_logarithmic: bool,
}

/// Reason for which a range is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum UnknownError {
    #[error("the range of `{key}` goes from {from} to {to}: give two finite numbers, the smaller one first")]
    Order { key: String, from: f64, to: f64 },
    #[error(
        "the range of `{key}` goes from {from:e} to {to:e}: the difference of its ends, on a logarithmic scale their ratio, is \
         above the largest number, 1.8e308; narrow it"
    )]
    Width { key: String, from: f64, to: f64 },
    #[error("the range of `{key}` begins at {from}: a range on a logarithmic scale begins above 0")]
    Logarithm { key: String, from: f64 },
    #[error("`friction.seed` numbers the surfaces that training draws: it is no unknown")]
    Seed,
}

impl Unknown {
    /// An unknown with values of `key` between `from` and `to`, equally likely, or equally likely in their
    /// logarithm.
    ///
    /// # Errors
    /// When the range is empty, not finite or too wide for its width to be a number, begins at or below 0 on
    /// a logarithmic scale, or is one of seeds.
    pub fn new(key: &str, from: f64, to: f64, is_logarithmic: bool) -> Result<Self, UnknownError> {
        let key = key.to_owned();
        if key == "friction.seed" {
            return Err(UnknownError::Seed);
        }
        if !(from < to && from.is_finite() && to.is_finite()) {
            return Err(UnknownError::Order { key, from, to });
        }
        if is_logarithmic && from <= 0.0 {
            return Err(UnknownError::Logarithm { key, from });
        }
        let width = if is_logarithmic { to / from } else { to - from };
        if !width.is_finite() {
            return Err(UnknownError::Width { key, from, to });
        }
        Ok(Self {
            key,
            from,
            to,
            unit: None,
            is_logarithmic,
        })
    }

    /// Returns the unknown with values that are written with a unit, such as `um`.
    #[must_use]
    pub fn in_unit(self, unit: &str) -> Self {
        Self {
            unit: Some(unit.to_owned()),
            ..self
        }
    }

    /// The key.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Unit of the values, if they have one.
    pub fn unit(&self) -> Option<&str> {
        self.unit.as_deref()
    }

    /// The value at a share of the range: `from + share (to - from)`, or `from (to/from)^share` on a
    /// logarithmic scale.
    ///
    /// ```
    /// use slipfront_calibrate::Unknown;
    /// let damping = Unknown::new("slider.omega_star", 0.01, 1.0, true)?;
    /// assert!((damping.at(0.5) - 0.1).abs() < 1e-15 && (damping.share_of(0.1) - 0.5).abs() < 1e-15);
    /// assert_eq!(Unknown::new("friction.mu_static", 0.3, 0.9, false)?.at(1.0), 0.9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn at(&self, share: f64) -> f64 {
        // The end of the range as it is written: 0.3 + (0.9 - 0.3) is another number than 0.9.
        if share == 1.0 {
            self.to
        } else if self.is_logarithmic {
            self.from * libm::exp(share * libm::log(self.to / self.from))
        } else {
            self.from + share * (self.to - self.from)
        }
    }

    /// Position of a value in the range, from 0 to 1.
    pub fn share_of(&self, value: f64) -> f64 {
        if self.is_logarithmic {
            libm::log(value / self.from) / libm::log(self.to / self.from)
        } else {
            (value - self.from) / (self.to - self.from)
        }
    }

    /// Setting of the key to the value at a share of the range.
    pub fn set_to(&self, share: f64) -> Override {
        Override::new(&self.key, &self.written(share))
    }

    /// The value at a share of the range as a file has it.
    fn written(&self, share: f64) -> toml::Value {
        let value = self.at(share);
        match &self.unit {
            Some(unit) => toml::Value::from(format!("{value} {unit}")),
            None => toml::Value::from(value),
        }
    }

    /// The key of the table `[instrument]` that is unknown, and its value at a share of the range; none for a
    /// key of the case.
    pub(crate) fn of_instrument(&self, share: f64) -> Option<(&str, toml::Value)> {
        Some((self.key.strip_prefix("instrument.")?, self.written(share)))
    }
}

/// Shares of the ranges of `count` unknowns in training run `run`, of at most 65536: points that fill the
/// ranges evenly, for any number of runs.
///
/// They are Sobol's sequence with the directions of Joe and Kuo (SIAM Journal on Scientific Computing 30
/// (2008) 2635), its digits scrambled as Owen proposed: every unknown alone, and every two together, take
/// values as even as those of a grid. Multiples of powers of one number do not, since such a power may lie
/// near a fraction of small numbers.
pub fn design_point(run: usize, count: usize) -> Vec<f64> {
    // Beyond the last dimension the sequence begins again, with other digits.
    let share = |j: u32| sample(run as u32, j % NUM_DIMENSIONS, j / NUM_DIMENSIONS);
    (0..count as u32).map(|j| f64::from(share(j))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_that_are_none_are_refused() {
        let refused = |from, to, log| {
            Unknown::new("friction.r_star", from, to, log)
                .unwrap_err()
                .to_string()
        };
        assert!(refused(0.9, 0.3, false).contains("from 0.9 to 0.3"));
        assert!(refused(f64::NAN, 0.3, false).contains("NaN"));
        assert!(refused(0.0, 0.3, true).contains("begins at 0"));
        assert!(refused(-1e308, 1e308, false).contains("above the largest number"));
        assert!(refused(1e-300, 1e300, true).contains("from 1e-300 to 1e300"));
        assert!(Unknown::new("friction.seed", 1.0, 2.0, false).is_err());
    }

    #[test]
    fn a_share_sets_the_key() {
        let unknown = Unknown::new("friction.r_star", 0.25, 0.75, false).unwrap();
        assert_eq!(unknown.set_to(0.5).to_string(), "friction.r_star=0.5");
        let length = Unknown::new("friction.correlation_length", 1.0, 3.0, false).unwrap();
        assert_eq!(
            length.in_unit("um").set_to(0.5).value(),
            toml::Value::from("2 um")
        );
    }

    /// The largest distance of the share of values below a number from that number.
    fn unevenness(mut values: Vec<f64>) -> f64 {
        values.sort_by(f64::total_cmp);
        let n = values.len() as f64;
        let distances = values.iter().enumerate();
        distances.fold(0.0, |largest: f64, (i, value)| {
            largest
                .max((value - i as f64 / n).abs())
                .max((value - (i as f64 + 1.0) / n).abs())
        })
    }

    /// The share of n values below any number differs from it by less than log2(n)/n, for n that are no
    /// powers of two as well.
    #[test]
    fn design_points_fill_the_range_of_every_unknown() {
        for (runs, count) in [(100, 3), (300, 8), (400, 4), (2500, 6), (2500, 12), (100, 300)] {
            let points: Vec<Vec<f64>> = (0..runs).map(|run| design_point(run, count)).collect();
            for j in 0..count {
                let found = unevenness(points.iter().map(|point| point[j]).collect());
                let n = runs as f64;
                assert!(found < n.log2() / n, "{runs} {count} {j}: {found}");
            }
        }
    }

    /// Every square of a grid of 16 x 16 holds at least one of 1024 values of two unknowns: random ones would
    /// leave some five squares empty.
    #[test]
    fn design_points_fill_the_ranges_of_two_unknowns() {
        let points: Vec<Vec<f64>> = (0..1024).map(|run| design_point(run, 8)).collect();
        for first in 0..8 {
            for second in 0..first {
                let mut counts = [0; 256];
                for point in &points {
                    let [row, column] = [first, second].map(|j| (16.0 * point[j]) as usize);
                    counts[16 * row + column] += 1;
                }
                assert!(counts.iter().all(|&count| count > 0), "{first} {second}");
            }
        }
    }
}
