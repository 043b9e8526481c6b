//! `runs.csv`, one row a run, and `points.csv`, the statistics, one row for each point and quantity.

use super::error::StudyError;
use super::execute::Findings;
use super::plan::{Plan, Role, RunKey};
use super::quantities::{REDUCTION, known, numbers};
use super::record::Outcome;
use super::statistics::Sample;

/// `runs.csv`: what varied, the seed, every number of the summary, and whether the run failed. A reference that
/// is not a point of the study itself has rows of its own.
///
/// # Errors
/// When it cannot be put into words, or a case no longer be read.
pub(super) fn runs(plan: &Plan, findings: &Findings) -> Result<Vec<u8>, StudyError> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let columns: Vec<&str> = plan
        .axes
        .iter()
        .flat_map(|axis| axis.columns.iter().map(String::as_str))
        .collect();
    let mut quantities = known();
    if !plan.has_reference() {
        quantities.retain(|name| name != REDUCTION);
    }
    table.write_record(
        ["point", "replicate", "role"]
            .into_iter()
            .chain(columns)
            .chain(["seed", "status", "reason"])
            .chain(quantities.iter().map(String::as_str)),
    )?;
    for (point, found) in plan.points.iter().zip(&findings.points) {
        for replicate in 0..found.replicates {
            for role in plan.roles() {
                let run = RunKey {
                    point: point.index,
                    replicate,
                    role,
                };
                let mut row = vec![
                    point.index.to_string(),
                    replicate.to_string(),
                    role_name(role).to_owned(),
                ];
                row.extend(plan.columns(point).into_iter().map(|(_, value)| value.to_owned()));
                row.push(plan.case_file(run)?.friction.seed.to_string());
                let values = match findings.outcomes.get(&run).map(AsRef::as_ref) {
                    Some(Outcome::Done(summary)) => {
                        row.extend(["done".to_owned(), String::new()]);
                        numbers(summary).into_iter().map(|(_, value)| value).collect()
                    }
                    Some(Outcome::Failed(reason)) => {
                        row.extend(["failed".to_owned(), reason.clone()]);
                        Vec::new()
                    }
                    None => {
                        row.extend(["missing".to_owned(), String::new()]);
                        Vec::new()
                    }
                };
                let reduction = match role {
                    Role::Point => findings.value(point.index, replicate, REDUCTION),
                    Role::Reference => None,
                };
                let count = quantities.len() - usize::from(plan.has_reference());
                row.extend((0..count).map(|k| cell(values.get(k).copied().flatten())));
                if plan.has_reference() {
                    row.push(cell(reduction));
                }
                table.write_record(row)?;
            }
        }
    }
    finish(table)
}

/// `points.csv`: for each point and quantity the number of values, their mean, standard deviation, confidence
/// interval of the mean, smallest and largest; reductions are paired by seed.
///
/// # Errors
/// When it cannot be put into words.
pub(super) fn points(plan: &Plan, findings: &Findings) -> Result<Vec<u8>, StudyError> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let columns: Vec<&str> = plan
        .axes
        .iter()
        .flat_map(|axis| axis.columns.iter().map(String::as_str))
        .collect();
    let statistics = [
        "quantity",
        "n",
        "mean",
        "deviation",
        "low",
        "high",
        "min",
        "max",
        "narrow_enough",
    ];
    table.write_record(["point"].into_iter().chain(columns).chain(statistics))?;
    for (position, point) in plan.points.iter().enumerate() {
        for name in known() {
            let Some(sample) = sample(plan, findings, position, &name) else {
                continue;
            };
            let mut row = vec![point.index.to_string()];
            row.extend(plan.columns(point).into_iter().map(|(_, value)| value.to_owned()));
            let [low, high] = sample.interval().map_or([None; 2], |interval| interval.map(Some));
            row.extend([name.clone(), sample.n.to_string(), number_cell(sample.mean)]);
            row.extend([cell(sample.deviation), cell(low), cell(high)]);
            row.extend([number_cell(sample.min), number_cell(sample.max)]);
            let decides = plan
                .settings
                .until
                .as_ref()
                .is_some_and(|until| until.key == name);
            let narrow = findings.points[position].narrow.filter(|_| decides);
            row.push(narrow.map_or(String::new(), |narrow| narrow.to_string()));
            table.write_record(row)?;
        }
    }
    finish(table)
}

/// Statistics of a quantity at the point at `position` of the plan; none without values.
pub fn sample(plan: &Plan, findings: &Findings, position: usize, name: &str) -> Option<Sample> {
    let point = plan.points[position].index;
    let replicates = findings.points.get(position)?.replicates;
    let values: Vec<f64> = (0..replicates)
        .filter_map(|replicate| findings.value(point, replicate, name))
        .collect();
    Sample::of(&values, plan.settings.confidence())
}

fn role_name(role: Role) -> &'static str {
    match role {
        Role::Point => "point",
        Role::Reference => "reference",
    }
}

fn cell(value: Option<f64>) -> String {
    value.map_or(String::new(), number_cell)
}

/// The shortest number that reads back as the same bits.
fn number_cell(value: f64) -> String {
    format!("{value:?}")
}

fn finish(table: csv::Writer<Vec<u8>>) -> Result<Vec<u8>, StudyError> {
    table
        .into_inner()
        .map_err(|error| csv::Error::from(error.into_error()).into())
}
