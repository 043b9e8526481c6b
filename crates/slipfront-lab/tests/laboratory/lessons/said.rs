//! A number as it appears in a text.

/// The digits of a number, and the value of one unit in the last place.
#[derive(Debug, PartialEq)]
pub(crate) struct Said {
    pub(crate) value: f64,
    last_place: f64,
}

impl Said {
    /// Parses a number followed by a unit, or by nothing; none if the text is something else.
    pub(crate) fn parse(says: &str, unit: &str) -> Option<Self> {
        let digits = match unit {
            "" => says,
            "°" => says.strip_suffix(unit)?,
            _ => says.strip_suffix(unit)?.strip_suffix(' ')?,
        };
        let unsigned = digits.strip_prefix('−').unwrap_or(digits);
        let is_number = unsigned.starts_with(|c: char| c.is_ascii_digit())
            && unsigned.ends_with(|c: char| c.is_ascii_digit())
            && unsigned.chars().all(|c| c.is_ascii_digit() || c == '.');
        let value: f64 = is_number.then(|| unsigned.parse().ok())??;
        let decimals = unsigned.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        Some(Self {
            value: if unsigned == digits { value } else { -value },
            last_place: 0.1_f64.powi(decimals as i32),
        })
    }

    /// Whether the number in the text is `value` rounded to as many digits as the text has.
    pub(crate) fn is(&self, value: f64) -> bool {
        // Rounding changes a value by at most half a unit in the last place; the error of a decimal fraction
        // as a double is far below a billionth of that unit.
        (value - self.value).abs() <= self.last_place * (0.5 + 1e-9)
    }
}

#[test]
fn a_number_is_held_to_the_digits_that_are_said() {
    let said = |says, unit| Said::parse(says, unit).unwrap();
    for (value, is) in [(30.49, false), (30.5, true), (31.49, true), (31.51, false)] {
        assert_eq!(said("31 %", "%").is(value), is, "{value}");
    }
    assert!(said("0.50", "").is(0.504) && !said("0.50", "").is(0.506));
    assert!(said("−0.1", "").is(-0.14) && !said("−0.1", "").is(0.1));
    assert!(said("45°", "°").is(45.0));
    for (says, unit) in [
        ("31", "%"),
        ("31 %", ""),
        ("31%", "%"),
        ("3.", ""),
        ("about 3", ""),
        ("", ""),
    ] {
        assert_eq!(Said::parse(says, unit), None, "{says}");
    }
}
