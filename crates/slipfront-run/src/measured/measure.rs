//! Quantities of columns, and their units as instruments write them.

use serde::Serialize;
use slipfront_case::quantity::{Duration, Force, Length};

/// Quantity of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// Time, s.
    Time,
    /// Displacement, m.
    Displacement,
    /// Force, N.
    Force,
    /// Friction coefficient, 1.
    Coefficient,
}

/// Units as instruments write them in words, and their sizes in SI units.
const UNIT_WORDS: [(Measure, &str, f64); 36] = [
    (Measure::Time, "sec", 1.0),
    (Measure::Time, "secs", 1.0),
    (Measure::Time, "second", 1.0),
    (Measure::Time, "seconds", 1.0),
    (Measure::Time, "Sec", 1.0),
    (Measure::Time, "msec", 1e-3),
    (Measure::Time, "usec", 1e-6),
    (Measure::Time, "min", 60.0),
    (Measure::Time, "minutes", 60.0),
    (Measure::Time, "h", 3600.0),
    (Measure::Time, "hr", 3600.0),
    (Measure::Time, "hrs", 3600.0),
    (Measure::Time, "hour", 3600.0),
    (Measure::Time, "hours", 3600.0),
    (Measure::Time, "d", 86_400.0),
    (Measure::Time, "days", 86_400.0),
    (Measure::Time, "Sekunden", 1.0),
    (Measure::Displacement, "micron", 1e-6),
    (Measure::Displacement, "microns", 1e-6),
    (Measure::Displacement, "inch", 0.0254),
    // Standard gravity, 9.80665 m/s^2.
    (Measure::Force, "gf", 9.80665e-3),
    (Measure::Force, "kgf", 9.80665),
    (Measure::Force, "kp", 9.80665),
    (Measure::Force, "lbf", 4.448_221_615_260_5),
    (Measure::Force, "lb", 4.448_221_615_260_5),
    (Measure::Force, "lbs", 4.448_221_615_260_5),
    (Measure::Force, "ozf", 0.278_013_850_953_781_2),
    (Measure::Force, "Newton", 1.0),
    (Measure::Force, "daN", 10.0),
    (Measure::Force, "dyn", 1e-5),
    (Measure::Coefficient, "1", 1.0),
    (Measure::Coefficient, "-", 1.0),
    (Measure::Coefficient, "\u{2013}", 1.0),
    (Measure::Coefficient, "\u{2212}", 1.0),
    (Measure::Coefficient, "", 1.0),
    (Measure::Coefficient, "%", 0.01),
];

impl Measure {
    /// Name of the quantity.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Displacement => "displacement",
            Self::Force => "force",
            Self::Coefficient => "coefficient",
        }
    }

    /// SI unit of the quantity.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Time => "s",
            Self::Displacement => "m",
            Self::Force => "N",
            Self::Coefficient => "1",
        }
    }

    /// The value of a quantity with its unit, such as `1.5 s`, in SI units.
    ///
    /// # Errors
    /// A sentence on why the text is not such a value.
    pub fn parse(self, text: &str) -> Result<f64, String> {
        let text = text.trim();
        let is_of_number = |character: char| character.is_ascii_digit() || character == '.';
        let end = text.rfind(is_of_number).map_or(0, |at| at + 1);
        let (number, unit) = text.split_once(' ').unwrap_or_else(|| text.split_at(end));
        let (number, unit) = (number.parse::<f64>().ok(), unit.trim());
        let Some(number) = number.filter(|number| number.is_finite()) else {
            return Err(format!(
                "{text:?} is not a number with a unit, such as 2 {}",
                self.unit()
            ));
        };
        self.factor(unit).map(|factor| number * factor).map_err(|why| {
            if unit.is_empty() {
                format!("{text:?} has no unit: write it as \"2 {}\"", self.unit())
            } else {
                why
            }
        })
    }

    /// Whether a unit is one of this quantity.
    pub(super) fn has_unit(self, unit: &str) -> bool {
        self.factor(unit).is_ok()
    }

    /// The size of a unit in SI units, as instruments write it.
    ///
    /// # Errors
    /// A sentence about a unit that does not belong to this quantity.
    pub(super) fn factor(self, unit: &str) -> Result<f64, String> {
        let one = format!("1 {unit}");
        let read = match self {
            Self::Time => one.parse::<Duration>().map(|time| time.si()),
            Self::Displacement => one.parse::<Length>().map(|length| length.si()),
            Self::Force => one.parse::<Force>().map(|force| force.si()),
            Self::Coefficient => {
                let no_unit = || format!("a coefficient has the unit 1 or %, and not {unit:?}");
                return self.size_of_word(unit).ok_or_else(no_unit);
            }
        };
        read.or_else(|why| self.size_of_word(unit).ok_or_else(|| why.to_string()))
    }

    /// The size in SI units of a unit in words.
    fn size_of_word(self, unit: &str) -> Option<f64> {
        let mut words = UNIT_WORDS.iter();
        let found = words.find(|(measure, word, _)| *measure == self && *word == unit);
        found.map(|(_, _, size)| *size)
    }
}
