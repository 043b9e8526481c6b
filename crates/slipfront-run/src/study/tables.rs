//! `runs.csv`, with a row for each run, and `points.csv`, with the statistics of each quantity at each point.

use super::columns::{AFTER_AXES, BEFORE_AXES, STATISTICS};
use super::error::StudyError;
use super::plan::{Plan, Role};
use super::point_statistics::sample;
use super::record::RunResult;
use super::statistics::Sample;
use super::study_results::StudyResults;
use super::summary_values::{Quantity, REDUCTION, known};

/// Columns of all axes.
fn axis_columns(plan: &Plan) -> impl Iterator<Item = &str> {
    plan.axes
        .iter()
        .flat_map(|axis| &axis.columns)
        .map(String::as_str)
}

/// `runs.csv`: for each run, references included, the levels of its point, the seed, whether it failed and why, and every
/// number of its summary.
///
/// # Errors
/// When it cannot be written as CSV.
pub(super) fn runs(plan: &Plan, results: &StudyResults) -> Result<Vec<u8>, StudyError> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let quantities = quantities(plan);
    table.write_record(
        BEFORE_AXES
            .into_iter()
            .chain(axis_columns(plan))
            .chain(AFTER_AXES)
            .chain(quantities.iter().map(|(name, _)| *name)),
    )?;
    // Sorted by point, replicate and role.
    for (&run, result) in &results.runs {
        let point = &plan.points[run.point];
        let mut row = vec![
            point.index.to_string(),
            run.replicate.to_string(),
            role_name(run.role).to_owned(),
        ];
        row.extend(plan.columns(point).into_iter().map(|(_, value)| value.to_owned()));
        row.extend([plan.seed(run).to_string(), plan.folder_name(run)]);
        let values = match result.as_ref() {
            RunResult::Done(values) => {
                row.extend(["done".to_owned(), String::new()]);
                Some(values)
            }
            RunResult::Failed(reason) => {
                row.extend(["failed".to_owned(), reason.clone()]);
                None
            }
        };
        for &(_, quantity) in &quantities {
            let value = match (quantity, run.role) {
                (Quantity::Number(position), _) => values.and_then(|values| values.get(position)),
                (Quantity::Reduction, Role::Point) => results.value(run.point, run.replicate, quantity),
                (Quantity::Reduction, Role::Reference) => None,
            };
            row.push(cell(value));
        }
        table.write_record(row)?;
    }
    finish(table)
}

/// The quantities that the tables of a study have: a reduction only against a reference.
fn quantities(plan: &Plan) -> Vec<(&'static str, Quantity)> {
    known()
        .iter()
        .filter(|name| plan.has_reference() || *name != REDUCTION)
        .filter_map(|name| Some((name.as_str(), Quantity::named(name)?)))
        .collect()
}

/// `points.csv`: for each point and quantity the number of values, their mean, standard deviation, confidence
/// interval of the mean, smallest and largest; reductions are paired by seed.
///
/// # Errors
/// When it cannot be written as CSV.
pub(super) fn points(plan: &Plan, results: &StudyResults) -> Result<Vec<u8>, StudyError> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(["point"].into_iter().chain(axis_columns(plan)).chain(STATISTICS))?;
    let quantities = quantities(plan);
    for (position, point) in plan.points.iter().enumerate() {
        for &(name, _) in &quantities {
            let sample = sample(plan, results, position, name);
            let until = plan.settings.until.as_ref();
            let decides = until.is_some_and(|until| until.key == name);
            // A decisive quantity that no run has gets a row without numbers.
            if sample.is_none() && !decides {
                continue;
            }
            let mut row = vec![point.index.to_string()];
            row.extend(plan.columns(point).into_iter().map(|(_, value)| value.to_owned()));
            row.extend([name.to_owned(), sample.map_or(0, |sample| sample.n).to_string()]);
            let number = |of: fn(Sample) -> Option<f64>| cell(sample.and_then(of));
            row.push(number(|sample| Some(sample.mean)));
            row.push(number(|sample| sample.deviation));
            row.push(number(|sample| sample.interval().map(|[low, _]| low)));
            row.push(number(|sample| sample.interval().map(|[_, high]| high)));
            row.push(number(|sample| Some(sample.min)));
            row.push(number(|sample| Some(sample.max)));
            let narrow = results.points[position].narrow.filter(|_| decides);
            row.push(narrow.map_or(String::new(), |narrow| narrow.to_string()));
            table.write_record(row)?;
        }
    }
    finish(table)
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

/// As few digits as are needed to read back the same bits.
fn number_cell(value: f64) -> String {
    format!("{value:?}")
}

fn finish(table: csv::Writer<Vec<u8>>) -> Result<Vec<u8>, StudyError> {
    table
        .into_inner()
        .map_err(|error| csv::Error::from(error.into_error()).into())
}
