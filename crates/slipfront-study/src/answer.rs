//! The answer of a study in a form for programs.

use serde_json::{Map, Value, json};

use crate::meshed_coverage::MeshedCoverage;
use crate::plan::Plan;
use crate::study_results::StudyResults;
use crate::tables::quantities;
use crate::warning_texts::warning_texts;

/// The answer of a study as JSON: for each point, the levels of the axes and, for each quantity that a run
/// has, the columns of `points.csv` (number of values, mean, standard deviation, ends of the interval,
/// smallest and largest); the failed runs, with the reasons; and the warnings about the cases.
pub fn answer(plan: &Plan, results: &StudyResults) -> Value {
    let points: Vec<Value> = (0..plan.points.len())
        .map(|position| point(plan, results, position))
        .collect();
    let failures: Vec<Value> = results
        .failures()
        .map(|(run, reason)| {
            json!({ "point": plan.points[run.point].index, "replicate": run.replicate, "reason": reason })
        })
        .collect();
    json!({
        "study": plan.name,
        "main_quantity": plan.main_quantity(),
        "confidence": plan.settings.confidence(),
        "points": points,
        "failures": failures,
        "warnings": warning_texts(plan),
    })
}

fn point(plan: &Plan, results: &StudyResults, position: usize) -> Value {
    let point = &plan.points[position];
    let levels: Map<String, Value> = plan
        .columns(point)
        .into_iter()
        .map(|(column, level)| (column.to_owned(), level.into()))
        .collect();
    let mut value = Map::from_iter([
        ("point".to_owned(), point.index.into()),
        ("levels".to_owned(), levels.into()),
        (
            "replicates".to_owned(),
            results.points[position].replicates.into(),
        ),
    ]);
    if MeshedCoverage::from_plan(plan).is_some() {
        value.insert(
            "texture_percent".to_owned(),
            plan.texture_percent(position).into(),
        );
    }
    for (name, _) in quantities(plan, results) {
        let Some(sample) = results.sample(plan, position, name) else {
            continue;
        };
        let [low, high] = sample.ends();
        let statistics = json!({
            "n": sample.n,
            "mean": sample.mean,
            "deviation": sample.deviation,
            "low": low,
            "high": high,
            "min": sample.min,
            "max": sample.max,
            "runs_without_transition": results.runs_without_transition(position, name),
        });
        value.insert(name.to_owned(), statistics);
    }
    value.into()
}
