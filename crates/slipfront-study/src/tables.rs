//! `runs.csv`, with a row for each run, `points.csv`, with the statistics of each quantity at each point, and
//! `anisotropy.csv`, with the statistics of friction over the directions of the drive.

use std::io::Write;

use crate::anisotropy::Anisotropy;
use crate::meshed_coverage::MeshedCoverage;
use crate::plan::{Plan, Role};
use crate::statistics::Sample;
use crate::study_results::StudyResults;
use crate::summary_values::{
    AFTER_AXES, BEFORE_AXES, RunQuantity, STATISTICS, is_optional, known, needs_transition,
};

/// Writes `runs.csv`: for each run, references included, the levels of its point, the seed, whether it failed
/// and why, and every number of its summary.
pub(crate) fn runs(plan: &Plan, results: &StudyResults, to: impl Write) -> csv::Result<()> {
    let mut table = csv::Writer::from_writer(to);
    let quantities = quantities(plan, results);
    let names = quantities.iter().map(|(name, _)| *name);
    let before = BEFORE_AXES.into_iter().chain(axis_columns(plan));
    table.write_record(before.chain(AFTER_AXES).chain(names))?;
    // Sorted by point, replicate and role.
    for (&run, result) in &results.runs {
        let point = &plan.points[run.point];
        let role = match run.role {
            Role::Point => "point",
            Role::Reference => "reference",
        };
        let [index, replicate] = [point.index, run.replicate].map(|number| number.to_string());
        let mut row = vec![index, replicate, role.to_owned()];
        row.extend(plan.columns(point).into_iter().map(|(_, value)| value.to_owned()));
        row.extend([plan.seed(run).to_string(), plan.folder_name(run)]);
        let status = result
            .as_ref()
            .map_or_else(|reason| ["failed", reason.as_str()], |_| ["done", ""]);
        row.extend(status.map(str::to_owned));
        for &(_, quantity) in &quantities {
            let value = match (quantity, run.role) {
                (RunQuantity::Number(position), _) => {
                    result.as_ref().ok().and_then(|values| values.get(position))
                }
                (RunQuantity::Reduction, Role::Point) => results.value(run.point, run.replicate, quantity),
                (RunQuantity::Reduction, Role::Reference) => None,
            };
            row.push(cell(value));
        }
        table.write_record(row)?;
    }
    Ok(table.flush()?)
}

/// The quantities that the tables of a study have: a reduction only against a reference, and an optional
/// quantity only if one run has it, or if it decides on replication.
pub(crate) fn quantities(plan: &Plan, results: &StudyResults) -> Vec<(&'static str, RunQuantity)> {
    let until = plan.settings.until.as_ref();
    let is_there = |name: &str, quantity: RunQuantity| match quantity {
        RunQuantity::Reduction => plan.has_reference(),
        RunQuantity::Number(position) if is_optional(name) => {
            let mut runs = results.runs.values().flatten();
            until.is_some_and(|until| until.key == name) || runs.any(|values| values.get(position).is_some())
        }
        RunQuantity::Number(_) => true,
    };
    known()
        .iter()
        .filter_map(|name| Some((name.as_str(), RunQuantity::named(name)?)))
        .filter(|(name, quantity)| is_there(name, *quantity))
        .collect()
}

/// Writes `points.csv`: for each point and quantity the number of values, their mean, standard deviation,
/// confidence interval of the mean, smallest and largest; reductions are paired by seed. If there is an axis
/// of coverages, another column has A* as meshed.
pub(crate) fn points(plan: &Plan, results: &StudyResults, to: impl Write) -> csv::Result<()> {
    let mut table = csv::Writer::from_writer(to);
    let meshed = MeshedCoverage::from_plan(plan).map(|_| TEXTURE_PERCENT);
    let names = ["point"].into_iter().chain(axis_columns(plan)).chain(meshed);
    table.write_record(names.chain(STATISTICS))?;
    let quantities = quantities(plan, results);
    for (position, point) in plan.points.iter().enumerate() {
        for &(name, _) in &quantities {
            let sample = results.sample(plan, position, name);
            let until = plan.settings.until.as_ref();
            let decides = until.is_some_and(|until| until.key == name);
            let without = results.runs_without_transition(position, name);
            // A row without numbers is written for a decisive quantity that no run has, and for one that is
            // missing because runs have no transition.
            if sample.is_none() && !decides && !(without > 0 && needs_transition(name)) {
                continue;
            }
            let mut row = vec![point.index.to_string()];
            row.extend(plan.columns(point).into_iter().map(|(_, value)| value.to_owned()));
            row.extend(meshed.map(|_| cell(Some(plan.texture_percent(position)))));
            row.extend([name.to_owned(), sample.map_or(0, |sample| sample.n).to_string()]);
            let numbers = sample.map(|sample| {
                let [low, high] = sample.ends();
                let [mean, min, max] = [sample.mean, sample.min, sample.max].map(Some);
                [mean, sample.deviation, low, high, min, max]
            });
            row.extend(numbers.unwrap_or_default().map(cell));
            let narrow = results.points[position].narrow.filter(|_| decides);
            row.push(narrow.map_or(String::new(), |narrow| narrow.to_string()));
            row.push(without.to_string());
            table.write_record(row)?;
        }
    }
    Ok(table.flush()?)
}

/// Writes `anisotropy.csv`: the dependence of static and kinetic friction on the directions, for the levels
/// of all other axes. `rows` has at least one row.
pub(crate) fn anisotropy(rows: &[Anisotropy], to: impl Write) -> csv::Result<()> {
    let mut table = csv::Writer::from_writer(to);
    let levels = rows.first().into_iter().flat_map(|row| &row.levels);
    let axes = levels.map(|(column, _)| column.as_str());
    table.write_record(axes.chain(OF_ANISOTROPY))?;
    for row in rows {
        let mut cells: Vec<String> = row.levels.iter().map(|(_, cell)| cell.clone()).collect();
        cells.extend([
            row.quantity.to_owned(),
            row.directions.to_string(),
            row.replicates.to_string(),
        ]);
        let with_ends = |sample: Option<Sample>| {
            let [low, high] = sample.map_or([None; 2], |sample| sample.ends());
            [sample.map(|sample| sample.mean), low, high]
        };
        let found = row.found.as_ref().ok();
        let principal = found.and_then(|found| found.principal);
        let values = principal.map(|principal| principal.values);
        let (at, lateral) = found.and_then(|found| found.lateral).unzip();
        let numbers = [
            &with_ends(found.map(|found| found.mean))[..],
            &[
                found.map(|found| found.largest_direction),
                found.map(|found| found.smallest_direction),
            ],
            &with_ends(found.map(|found| found.anisotropy)),
            &[
                found.and_then(|found| found.p_value),
                principal.map(|principal| principal.direction),
                principal.and_then(|principal| principal.half_width),
            ],
            &with_ends(values.map(|[larger, _]| larger)),
            &with_ends(values.map(|[_, smaller]| smaller)),
            &[principal.map(|principal| principal.misfit)],
            &with_ends(lateral),
            &[at],
        ];
        cells.extend(numbers.concat().into_iter().map(cell));
        table.write_record(cells)?;
    }
    Ok(table.flush()?)
}

/// Columns of `anisotropy.csv` after those of the axes.
const OF_ANISOTROPY: [&str; 25] = [
    "quantity",
    "directions",
    "n",
    "mean",
    "mean_low",
    "mean_high",
    "largest_direction",
    "smallest_direction",
    "anisotropy",
    "anisotropy_low",
    "anisotropy_high",
    "p_value",
    "principal_direction",
    "principal_direction_half_width",
    "principal_1",
    "principal_1_low",
    "principal_1_high",
    "principal_2",
    "principal_2_low",
    "principal_2_high",
    "misfit",
    "lateral",
    "lateral_low",
    "lateral_high",
    "lateral_direction",
];

/// Name of the column of A* as meshed, equal to that of the quantity.
const TEXTURE_PERCENT: &str = "texture_percent";

/// Columns of all axes.
fn axis_columns(plan: &Plan) -> impl Iterator<Item = &str> {
    let columns = plan.axes.iter().flat_map(|axis| &axis.columns);
    columns.map(String::as_str)
}

/// A number with the fewest digits that read back to the same bits.
fn cell(value: Option<f64>) -> String {
    value.map_or(String::new(), |value| format!("{value:?}"))
}
