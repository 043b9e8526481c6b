//! Options with a number between bounds.

/// Parses a number between two bounds; `unit` names its unit in the error.
pub(crate) fn within(text: &str, least: f64, most: f64, unit: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (least..=most).contains(number));
    number.ok_or_else(|| format!("a number of {unit} from {least} to {most}"))
}
