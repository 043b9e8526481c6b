//! The numbers of a summary by their names, for tables and statistics.

use serde_json::Value;

use crate::summary::Summary;

/// Reduction of mu_s* against the reference of the same seed, % (Eq. 16).
pub const REDUCTION: &str = "static_reduction_percent";

/// What a summary holds beside numbers, and the seed, of which no mean is asked.
const NO_NUMBERS: [&str; 5] = ["kinetic_window_star", "instants", "warnings", "version", "seed"];

/// Names of all numbers, in the order of the summary; the reduction comes last.
pub fn known() -> Vec<String> {
    let mut names: Vec<String> = numbers(&Summary::default())
        .into_iter()
        .map(|(name, _)| name)
        .collect();
    names.push(REDUCTION.to_owned());
    names
}

/// The numbers of a summary; none where it has none. Yes and no are 1 and 0.
pub(super) fn numbers(summary: &Summary) -> Vec<(String, Option<f64>)> {
    let Ok(Value::Object(fields)) = serde_json::to_value(summary) else {
        return Vec::new();
    };
    let number = |value: Value| match value {
        Value::Bool(yes) => Some(f64::from(u8::from(yes))),
        value => value.as_f64(),
    };
    let kept = fields
        .into_iter()
        .filter(|(name, _)| !NO_NUMBERS.contains(&name.as_str()));
    kept.map(|(name, value)| (name, number(value))).collect()
}

/// One number of a summary by its name.
pub(super) fn number(summary: &Summary, name: &str) -> Option<f64> {
    numbers(summary).into_iter().find(|(other, _)| other == name)?.1
}

/// Reduction of mu_s* in % (Eq. 16), both runs on the same random surface:
///
/// ```text
/// 100 (mu_s*(reference) - mu_s*)/mu_s*(reference)
/// ```
pub(super) fn reduction_percent(point: &Summary, reference: &Summary) -> f64 {
    100.0 * (reference.static_friction_star - point.static_friction_star) / reference.static_friction_star
}
