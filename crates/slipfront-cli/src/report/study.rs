//! The plan of a study, and its results.

use std::collections::HashSet;
use std::path::Path;

use slipfront_base::number_format::{are, byte_size, count, four_digits, with_half_width};
use slipfront_study::text_table::table;
use slipfront_study::{
    MeshedCoverage, Plan, REDUCTION, StudyResults, idle_axes, quantities_without_pictures, warning_texts,
    why_no_pictures,
};

use super::anisotropy::anisotropy;
use super::cost::held_drive_remark;
use super::times::duration;
use crate::wrap::{note, notes};

/// Largest number of printed levels of an axis.
const MAX_LEVELS: usize = 10;

/// Largest number of printed points.
const MAX_POINTS: usize = 40;

/// The plan of a study and its cost.
pub(crate) fn study_plan(plan: &Plan, time: [f64; 2], threads: usize) -> String {
    let settings = &plan.settings;
    let (min, max) = (settings.min_replicates(), settings.max_replicates());
    let replicates = match &settings.until {
        None => count(min, "replicate"),
        Some(until) => format!(
            "{min} to {max} replicates, until the half width of {} is at most {}",
            until.key, until.half_width
        ),
    };
    let reference = if plan.has_reference() {
        ", each with its untextured reference"
    } else {
        ""
    };
    let runs = |replicates| plan.runs(replicates).count();
    let runs = if runs(min) == runs(max) {
        count(runs(min), "run")
    } else {
        format!("{} to {} runs", runs(min), runs(max))
    };
    format!(
        "{}\n{}  {}, {replicates}{reference}: at most {runs}\n  \
         at most {:.2e} block-steps{}, {} on {} of this machine\n  \
         {} of memory for {} at once, {} on the disk\n{}{}",
        plan.name,
        axes(plan),
        count(plan.points.len(), "point"),
        plan.block_steps(),
        held_drive_remark(plan.has_held_drive()),
        duration(time),
        count(threads, "thread"),
        byte_size(plan.memory(threads)),
        count(threads, "run"),
        byte_size(plan.disk(plan.runs(min))),
        notes(
            idle_axes(plan)
                .into_iter()
                .chain(why_no_pictures(&plan.axes))
                .chain(merged(plan))
        ),
        notes(warning_texts(plan))
    )
}

/// The axes with their levels: a line each, or a table if several keys change together.
fn axes(plan: &Plan) -> String {
    let mut text = String::new();
    for axis in &plan.axes {
        if axis.columns.len() > 1 && axis.levels.len() <= MAX_LEVELS {
            let columns: Vec<&str> = axis.columns.iter().map(String::as_str).collect();
            let rows: Vec<Vec<String>> = axis.levels.iter().map(|level| level.labels.clone()).collect();
            text += &table(&columns, &rows);
            continue;
        }
        let mut levels: Vec<String> = axis.levels.iter().map(|level| level.labels.join(" & ")).collect();
        if levels.len() > MAX_LEVELS {
            let between = format!("... ({} levels) ...", levels.len());
            levels.splice(MAX_LEVELS / 2..levels.len() - 1, [between]);
        }
        text += &format!("  {}: {}\n", axis.columns.join(" & "), levels.join(", "));
    }
    text
}

/// Note on coverages that give the same mesh.
fn merged(plan: &Plan) -> Option<String> {
    MeshedCoverage::from_plan(plan)?.merged(plan)
}

/// The results of a study: its main quantity at every point, notes, and the folder of tables and pictures,
/// with the reasons for omissions.
pub(crate) fn study_results(plan: &Plan, results: &StudyResults, folder: &Path) -> String {
    let missing = why_no_pictures(&plan.axes).into_iter();
    let missing = missing.chain(quantities_without_pictures(plan, results));
    format!(
        "{}{}{}runs.csv, points.csv and pictures in {}\n{}",
        points(plan, results),
        anisotropy(plan, results),
        notes_on_results(plan, results),
        folder.display(),
        missing
            .map(|sentence| format!("{sentence}\n"))
            .collect::<String>()
    )
}

/// The main quantity at every point, one row each.
fn points(plan: &Plan, results: &StudyResults) -> String {
    let shown = plan.points.len().min(MAX_POINTS);
    let axes = plan.axes.iter().flat_map(|axis| &axis.columns);
    let meshed = meshed(plan, shown);
    let name = meshed.as_ref().map(|_| "meshed %");
    let header = axes.map(String::as_str).chain(name).chain(["mean", "n"]);
    let header: Vec<&str> = header.collect();
    let row = |point: usize| {
        let levels = plan.columns(&plan.points[point]).into_iter();
        let levels = levels.map(|(_, level)| level.to_owned());
        let meshed = meshed.as_ref().map(|cells| cells[point].clone());
        levels
            .chain(meshed)
            .chain(point_value(plan, results, point))
            .collect()
    };
    let rows: Vec<Vec<String>> = (0..shown).map(row).collect();
    let interval = match plan.settings.max_replicates() {
        1 => "one run per point".to_owned(),
        _ => format!(
            "mean of n replicates \u{b1} half width of its {} % interval",
            four_digits(100.0 * plan.settings.confidence())
        ),
    };
    let mut text = format!(
        "{}: {interval}\n\n{}",
        plan.main_quantity(),
        table(&header, &rows)
    );
    if plan.points.len() > shown {
        let more = count(plan.points.len() - shown, "more point");
        text += &format!("  and {more} in points.csv\n");
    }
    text + "\n"
}

/// The meshed coverage at the points shown, if an axis requests another coverage at any of them.
fn meshed(plan: &Plan, shown: usize) -> Option<Vec<String>> {
    let coverage = MeshedCoverage::from_plan(plan)?;
    let levels: Vec<Vec<usize>> = plan.points[..shown]
        .iter()
        .map(|point| plan.levels(point))
        .collect();
    let meshed = levels.iter().map(|levels| coverage.at(levels).map(four_digits));
    let meshed: Vec<String> = meshed.collect::<Option<_>>()?;
    let axis = &plan.axes[coverage.axis];
    let asked = levels
        .iter()
        .map(|levels| axis.levels[levels[coverage.axis]].number.map(four_digits));
    asked
        .zip(&meshed)
        .any(|(asked, meshed)| asked.as_ref() != Some(meshed))
        .then_some(meshed)
}

/// The main quantity at a point with its interval, the number of values, and remarks.
fn point_value(plan: &Plan, results: &StudyResults, point: usize) -> Vec<String> {
    let has_failed = || results.failures().any(|(run, _)| run.point == point);
    let without = results.runs_without_transition(point, plan.main_quantity());
    let sample = results.sample(plan, point, plan.main_quantity());
    let value = match sample {
        Some(sample) => with_half_width(sample.mean, sample.half_width),
        None if has_failed() => "failed".to_owned(),
        None => "none".to_owned(),
    };
    let mut cells = vec![value, sample.map_or(0, |sample| sample.n).to_string()];
    if results.points[point].narrow == Some(false) {
        cells.push("(interval still too wide)".to_owned());
    }
    if without > 0 {
        let replicates = results.points[point].replicates;
        // A reduction is missing if the run of the point or its reference failed.
        let of = if plan.main_quantity() == REDUCTION {
            "pair"
        } else {
            "run"
        };
        cells.push(format!(
            "(no transition in {without} of {})",
            count(replicates, of)
        ));
    }
    cells
}

/// Notes on the study as a whole.
fn notes_on_results(plan: &Plan, results: &StudyResults) -> String {
    let mut text = String::new();
    // Points share references, and each reference counts once.
    let without: HashSet<String> = results
        .without_transition()
        .map(|run| plan.identity(run))
        .collect();
    if !without.is_empty() {
        text += &note(&format!(
            "{} no transition: after its peak, mu* did not drop at least half-way to the steady level within the time of a \
             transition, or sliding continues at the peak level. Such a run has no static friction and no reduction, and is \
             omitted from the means; `mu_star_max` is its largest mu*. Increase `time.duration_star` of the base if runs end \
             before the drop; runs that creep have no drop",
            match without.len() {
                1 => "1 run has".to_owned(),
                runs => format!("{runs} runs have"),
            }
        ));
    }
    text += &notes(merged(plan).into_iter().chain(warning_texts(plan)));
    if results.orphaned_runs > 0 {
        text += &note(&format!(
            "{} not part of the present study; kept in runs.jsonl",
            are(results.orphaned_runs, "recorded run")
        ));
    }
    text
}
