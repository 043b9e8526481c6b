//! Options with a number between bounds.

/// Parses a number between two bounds; `unit` names its unit in the error.
pub(crate) fn within(text: &str, least: f64, most: f64, unit: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (least..=most).contains(number));
    number.ok_or_else(|| format!("a number of {unit} from {least} to {most}"))
}

/// Parses a factor of a record: not 0, and far within what a number can be.
pub(crate) fn factor(text: &str) -> Result<f64, String> {
    let number = text.parse().ok();
    let number = number.filter(|number: &f64| (1e-30..=1e30).contains(&number.abs()));
    number.ok_or_else(|| "a number other than 0, from 1e-30 to 1e30 without its sign".to_owned())
}

/// Parses a number that is added to a record.
pub(crate) fn summand(text: &str) -> Result<f64, String> {
    let number = text.parse().ok();
    let number = number.filter(|number: &f64| number.abs() <= 1e30);
    number.ok_or_else(|| "a number from -1e30 to 1e30".to_owned())
}
