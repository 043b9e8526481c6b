//! Warnings about the cases of a study, in words.

use crate::plan::Plan;
use crate::plan_warnings::Warning;

/// Largest number of warnings that are listed.
const MAX_WARNINGS: usize = 8;

/// Warnings about the cases of a study in words, each with the points that it applies to: the first eight,
/// and the number of the others.
pub fn warning_texts(plan: &Plan) -> Vec<String> {
    let all = plan.warnings();
    let mut texts: Vec<String> = all
        .iter()
        .take(MAX_WARNINGS)
        .map(|warning| format!("{} ({})", warning.sentence, place(warning, plan)))
        .collect();
    if all.len() > MAX_WARNINGS {
        let more = all.len() - MAX_WARNINGS;
        texts.push(format!(
            "and {more} similar notes, which `slipfront check` prints for a case"
        ));
    }
    texts
}

/// The points that a warning applies to.
fn place(warning: &Warning, plan: &Plan) -> String {
    let first = plan.describe(&plan.points[warning.first]);
    match (warning.points, plan.points.len()) {
        (some, all) if some == all => "at every point".to_owned(),
        (1, _) => format!("at the point {first}"),
        (some, _) => format!("at {some} points, the first {first}"),
    }
}
