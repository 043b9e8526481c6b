//! Unknowns of a calibration and of a design: numeric keys, each with a range of values.

use serde::Deserialize;
use slipfront_base::number_format::four_digits;
use slipfront_case::case_file::Override;
use toml::Value;

/// A key with a range of values.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    key: String,
    from: f64,
    to: f64,
    unit: Option<String>,
    is_logarithmic: bool,
}

/// The range of an unknown.
#[derive(Deserialize)]
#[serde(untagged)]
enum RangeKeys {
    Ends([Number; 2]),
    Scaled(ScaledKeys),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScaledKeys {
    from: Number,
    to: Number,
    scale: Scale,
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Scale {
    Linear,
    Log,
}

/// A number, with or without a unit.
#[derive(Deserialize)]
#[serde(untagged)]
enum Number {
    Plain(f64),
    WithUnit(String),
}

/// Reason why a range is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum UnknownError {
    #[error("the range of `{key}` is {from} to {to}: give two finite numbers, the smaller one first")]
    Order { key: String, from: f64, to: f64 },
    #[error(
        "the range of `{key}` is {from:e} to {to:e}: the difference of its ends, or their ratio on a logarithmic scale, exceeds \
         the largest number, 1.8e308; reduce it"
    )]
    Width { key: String, from: f64, to: f64 },
    #[error("the range of `{key}` begins at {from}: a range on a logarithmic scale must begin above 0")]
    Logarithm { key: String, from: f64 },
    #[error("`friction.seed` selects the random surfaces of the training: it cannot be an unknown")]
    Seed,
}

impl Unknown {
    /// An unknown with values of `key` between `from` and `to`, equally likely, or equally likely in their
    /// logarithm.
    ///
    /// # Errors
    /// When the range is empty, not finite, or so wide that its width overflows; when it begins at or below 0
    /// on a logarithmic scale; or when the key is a seed.
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

    /// The unknown for a key and its range, as written in a file: `[0.3, 0.9]`, `["1 um", "5 um"]`, or
    /// `{ from = 0.03, to = 0.5, scale = "log" }`.
    ///
    /// # Errors
    /// A sentence, when the range has another form, its ends have different units, or [`new`](Self::new)
    /// refuses it.
    pub fn read(key: &str, range: &Value) -> Result<Self, String> {
        let Ok(keys) = range.clone().try_into::<RangeKeys>() else {
            return Err(format!(
                "the range of `{key}` is written [0.3, 0.9], [\"1 um\", \"5 um\"] or {{ from = 0.03, to = 0.5, scale = \"log\" }}"
            ));
        };
        let (ends, is_logarithmic) = match keys {
            RangeKeys::Ends(ends) => (ends, false),
            RangeKeys::Scaled(ScaledKeys { from, to, scale }) => ([from, to], matches!(scale, Scale::Log)),
        };
        let [(from, unit), (to, other)] = ends.map(Number::parted);
        let (Some(from), Some(to)) = (from, to) else {
            return Err(format!("the range of `{key}` has ends that are not numbers"));
        };
        if unit != other {
            return Err(format!("the ends of the range of `{key}` differ in their units"));
        }
        let unknown = Self::new(key, from, to, is_logarithmic).map_err(|error| error.to_string())?;
        Ok(Self { unit, ..unknown })
    }

    /// Returns the unknown with a unit for its values, such as `um`.
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
    /// use slipfront_study::Unknown;
    /// let damping = Unknown::new("slider.omega_star", 0.01, 1.0, true)?;
    /// assert!((damping.at(0.5) - 0.1).abs() < 1e-15 && (damping.share_of(0.1) - 0.5).abs() < 1e-15);
    /// assert_eq!(Unknown::new("friction.mu_static", 0.3, 0.9, false)?.at(1.0), 0.9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn at(&self, share: f64) -> f64 {
        // The exact end of the range: 0.3 + (0.9 - 0.3) differs from 0.9 by rounding.
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

    /// The value at a share of the range, as written in a file.
    pub fn written(&self, share: f64) -> Value {
        self.with_unit(self.at(share))
    }

    /// Ends of the range with their unit, for a sentence.
    pub fn range_in_words(&self) -> [String; 2] {
        [self.from, self.to].map(|end| with_unit(four_digits(end), self.unit()))
    }

    /// Name of a column with values of the unknown, such as `texture.0.lambda (um)`.
    pub fn column(&self) -> String {
        match &self.unit {
            Some(unit) => format!("{} ({unit})", self.key),
            None => self.key.clone(),
        }
    }

    /// A value of the key, as written in a file.
    pub fn with_unit(&self, value: f64) -> Value {
        match &self.unit {
            Some(unit) => Value::from(format!("{value} {unit}")),
            None => Value::from(value),
        }
    }
}

/// A number as text with its unit, if it has one.
pub fn with_unit(number: String, unit: Option<&str>) -> String {
    match unit {
        Some(unit) => format!("{number} {unit}"),
        None => number,
    }
}

impl Number {
    /// The number, and the unit.
    fn parted(self) -> (Option<f64>, Option<String>) {
        match self {
            Self::Plain(number) => (Some(number), None),
            Self::WithUnit(text) => match text.trim().split_once(' ') {
                Some((number, unit)) => (number.parse().ok(), Some(unit.trim().to_owned())),
                None => (text.trim().parse().ok(), None),
            },
        }
    }
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
        assert!(refused(0.9, 0.3, false).contains("is 0.9 to 0.3"));
        assert!(refused(f64::NAN, 0.3, false).contains("NaN"));
        assert!(refused(0.0, 0.3, true).contains("begins at 0"));
        assert!(refused(-1e308, 1e308, false).contains("exceeds the largest number"));
        assert!(refused(1e-300, 1e300, true).contains("is 1e-300 to 1e300"));
        assert!(Unknown::new("friction.seed", 1.0, 2.0, false).is_err());
    }

    #[test]
    fn a_share_sets_the_key() {
        let unknown = Unknown::new("friction.r_star", 0.25, 0.75, false).unwrap();
        assert_eq!(unknown.set_to(0.5).to_string(), "friction.r_star=0.5");
        let length = Unknown::new("friction.correlation_length", 1.0, 3.0, false).unwrap();
        assert_eq!(length.in_unit("um").set_to(0.5).value(), Value::from("2 um"));
    }
}
