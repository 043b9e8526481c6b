//! Statistics of a quantity over the replicates of a point.

use super::plan::Plan;
use super::statistics::Sample;
use super::study_results::StudyResults;
use super::summary_values::{Quantity, REDUCTION};

/// Statistics of a quantity at the point at `position` of the plan; none if no run has a value.
pub fn sample(plan: &Plan, results: &StudyResults, position: usize, name: &str) -> Option<Sample> {
    let quantity = Quantity::named(name)?;
    let replicates = results.points.get(position)?.replicates;
    let values: Vec<f64> = (0..replicates)
        .filter_map(|replicate| results.value(position, replicate, quantity))
        .collect();
    Sample::of(&values, plan.settings.confidence())
}

/// The main quantity of a study: the one that decides on its replicates; else the reduction if it has a reference; else mu_s*.
pub fn main_quantity(plan: &Plan) -> &str {
    if let Some(until) = &plan.settings.until {
        &until.key
    } else if plan.has_reference() {
        REDUCTION
    } else {
        "static_friction_star"
    }
}
