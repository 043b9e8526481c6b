//! Numbers of options, within bounds.

/// A number with a unit within bounds.
pub(crate) fn within(text: &str, least: f64, most: f64, unit: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (least..=most).contains(number));
    number.ok_or_else(|| format!("a number of {unit} from {least} to {most}"))
}
