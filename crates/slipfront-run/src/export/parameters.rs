//! The keys of a case as values with units of SI.

use serde_json::{Value, json};
use slipfront_case::case_file::{CaseFile, title_of};
use slipfront_case::quantity::WrittenQuantity;

/// Units in which quantities are given, each with its code in UN/CEFACT's Recommendation 20, which has none
/// for a stiffness per area.
const UNITS: [(&str, Option<&str>); 9] = [
    ("m", Some("MTR")),
    ("Pa", Some("PAL")),
    ("kg/m^3", Some("KMQ")),
    ("m/s", Some("MTS")),
    ("s", Some("SEC")),
    ("N/m", Some("4P")),
    ("N/m^3", None),
    ("N", Some("NEW")),
    ("1/s", Some("C97")),
];

/// Units of numbers, as written in the titles of their keys: none, degrees, percent.
const NUMBERS: [(&str, &str, &str); 3] = [("", "1", "C62"), ("\u{b0}", "\u{b0}", "DD"), ("%", "%", "P1")];

/// A key of a case with its value.
#[derive(Debug)]
pub struct Parameter {
    /// Key with its table, such as `drive.v_star`.
    pub(super) key: String,
    /// A number, in SI units where it has a unit, or the value as written in the case.
    pub(super) value: Value,
    /// Name and code of the unit.
    pub(super) unit: Option<(&'static str, Option<&'static str>)>,
}

/// Every key of a case, defaults filled in.
pub(super) fn parameters(case: &CaseFile) -> Vec<Parameter> {
    let values = case.values().into_iter();
    values
        .map(|(key, text)| Parameter::from_toml(key.trim_matches('`'), &text))
        .collect()
}

impl Parameter {
    /// A key with its value as TOML, or with a value that is written without quotation marks.
    pub fn from_toml(key: &str, text: &str) -> Self {
        let key = key.to_owned();
        // Numbers, switches and strings without escapes are JSON as well.
        let value = serde_json::from_str(text).unwrap_or_else(|_| json!(text));
        if let Some((in_si, unit)) = value.as_str().and_then(in_si) {
            let (value, unit) = (json!(in_si), Some(unit));
            return Self { key, value, unit };
        }
        let title = title_of(&key).filter(|_| value.is_number());
        let unit = title.and_then(|(title, _)| NUMBERS.iter().find(|(unit, ..)| *unit == title.unit));
        let unit = unit.map(|(_, name, code)| (*name, Some(*code)));
        Self { key, value, unit }
    }
}

/// A quantity with its unit in SI; none for a text that is not a quantity.
fn in_si(text: &str) -> Option<(f64, (&'static str, Option<&'static str>))> {
    let written = WrittenQuantity::read(text)?;
    UNITS.iter().find_map(|unit| {
        let one = format!("1 {}", unit.0);
        Some((written.in_unit_of(&WrittenQuantity::read(&one)?)?, *unit))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_are_in_si_and_others_as_written() {
        let text = "slider.block_size = '25 um'\nslider.density = '2 g/cm^3'\ndrive.stiffness_per_area = '10 N/um/mm^2'\n\
                    drive.direction = 90\n[[texture]]\nshape = 'cavity'\ncoverage = 5";
        let parameters = parameters(&CaseFile::parse(text, "case", &[]).unwrap());
        let found = |key: &str| {
            let parameter = parameters.iter().find(|parameter| parameter.key == key).unwrap();
            (parameter.value.clone(), parameter.unit)
        };
        assert_eq!(
            found("slider.block_size"),
            (json!(25e-6), Some(("m", Some("MTR"))))
        );
        assert_eq!(
            found("slider.density"),
            (json!(2000.0), Some(("kg/m^3", Some("KMQ"))))
        );
        assert_eq!(
            found("drive.stiffness_per_area"),
            (json!(1e13), Some(("N/m^3", None)))
        );
        assert_eq!(found("drive.v_star"), (json!(0.03), Some(("1", Some("C62")))));
        assert_eq!(
            found("drive.direction"),
            (json!(90.0), Some(("\u{b0}", Some("DD"))))
        );
        assert_eq!(found("texture.0.coverage"), (json!(5.0), Some(("%", Some("P1")))));
        assert_eq!(found("texture.0.shape"), (json!("cavity"), None));
        assert_eq!(found("friction.seed"), (json!(1), Some(("1", Some("C62")))));
        assert_eq!(found("time.step"), (json!("auto"), None));
        assert_eq!(found("load.redistribute"), (json!(true), None));
        assert_eq!(found("slider.blocks"), (json!([25, 25]), None));
    }
}
