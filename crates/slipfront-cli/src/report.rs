//! What the commands print: the physics of a case as a tree, its cost, the summary of a run.

use std::collections::HashSet;
use std::path::Path;

use slipfront::lattice::dt_star_limit;
use slipfront_case::case::Case;
use slipfront_case::case_file::Law;
use slipfront_case::machine::available_memory;
use slipfront_case::number_format::byte_size;
use slipfront_run::study;
use slipfront_run::study::{Plan, RunKey, RunResult, StudyResults};
use slipfront_run::summary::Summary;

/// The resolved physics of a case.
pub(crate) fn physics(case: &Case) -> String {
    let (groups, scales, file) = (&case.groups, &case.scales, &case.file);
    let lattice = &case.model.lattice;
    let [edges_x, edges_y] = lattice.edges.map(|edges| format!("{edges:?}").to_lowercase());
    let edges = if edges_x == edges_y {
        edges_x
    } else {
        format!("{edges_x} in x, {edges_y} in y")
    };
    let law = match file.friction.law {
        Law::Projection => "projection",
        Law::Reversal => "reversal (for comparison)",
        Law::Literal => "literal (for comparison)",
    };
    let (time_plan, time) = (&case.time_plan, scales.time());
    let mut tree = vec![
        (
            "slider",
            format!(
                "{} x {} blocks of {}, {edges} edges",
                lattice.nx,
                lattice.ny,
                si(scales.block_size, "m")
            ),
        ),
        (
            "material",
            format!(
                "E = {}, rho = {} kg/m^3, Omega* = {}",
                si(scales.young_modulus, "Pa"),
                plain(scales.density),
                plain(groups.omega_star)
            ),
        ),
        (
            "load",
            format!("P = {}, strain {:.2e}", si(scales.pressure, "Pa"), groups.epsilon),
        ),
        (
            "drive",
            format!(
                "V* = {} ({}) at {} degrees",
                plain(groups.v_star),
                si(groups.v_star * scales.speed(), "m/s"),
                file.drive.direction
            ),
        ),
        ("friction", friction(case, law)),
        ("texture", texture(case)),
        (
            "time",
            format!(
                "to t* = {} ({}) in {} steps of dt* = {}",
                plain(time_plan.end_star()),
                si(time_plan.end_star() * time, "s"),
                time_plan.last_step,
                plain(time_plan.dt_star)
            ),
        ),
    ];
    let last = tree.pop();
    let mut text = format!("{}\n", case.name);
    for (name, what) in tree {
        text += &format!("\u{251c}\u{2500} {name:<9} {what}\n");
    }
    if let Some((name, what)) = last {
        text += &format!("\u{2514}\u{2500} {name:<9} {what}\n");
    }
    text
}

fn friction(case: &Case, law: &str) -> String {
    let (groups, friction) = (&case.groups, &case.file.friction);
    let spread = |field: &Option<String>, sigma: f64| match field {
        Some(file) => format!("from {file}"),
        None => format!("sigma* = {}", plain(sigma)),
    };
    format!(
        "{law}; mu_s = {} ({}), R* = {} ({}), seed {}",
        plain(friction.mu_static),
        spread(&friction.mu_static_field, groups.sigma_static_star),
        plain(groups.r_star),
        spread(&friction.mu_kinetic_field, groups.sigma_kinetic_star),
        friction.seed
    )
}

/// The texture as asked and as meshed, in a line.
pub(crate) fn texture(case: &Case) -> String {
    if case.file.texture.is_empty() {
        return "none".to_owned();
    }
    let asked = case
        .texture
        .asked_percent
        .map_or(String::new(), |asked| format!(", {} % asked", plain(asked)));
    format!("{} % of the blocks{asked}", plain(case.texture.meshed_percent))
}

/// What `check` adds to the physics: the expected onset, the cost, the warnings.
pub(crate) fn cost(case: &Case, seconds: f64) -> String {
    let (time_plan, budget) = (&case.time_plan, &case.budget);
    let v_star = case.groups.v_star;
    let at = |star: f64| format!("t* = {} ({})", plain(star), si(star * case.scales.time(), "s"));
    let late = |star: f64| {
        if star > time_plan.end_star() {
            ", after the end of the run: lengthen `time.duration_star`"
        } else {
            ""
        }
    };
    let mut text = String::new();
    if case.file.texture.is_empty() {
        let first = case.model.first_slip_estimate();
        text += &format!("first slip        {}, exactly{}\n", at(first), late(first));
    }
    let onset = 2.5 / v_star;
    text += &format!("onset expected    about {} (Eq. 12){}\n", at(onset), late(onset));
    text += &format!("steady level      mu* = {}\n", plain(case.model.steady_level()));
    text += &format!(
        "scales            time {}, displacement {}, stress {}\n",
        si(case.scales.time(), "s"),
        si(case.scales.displacement(), "m"),
        si(case.scales.stress(), "Pa")
    );
    text += &format!(
        "stability         dt* = {} of at most {:.4}\n",
        plain(time_plan.dt_star),
        dt_star_limit()
    );
    text += &format!(
        "cost              {:.3e} block-steps, {} on this machine\n",
        case.block_steps(),
        duration(seconds)
    );
    let resumed = budget.resumed().memory();
    text += &format!(
        "memory            {}{}{}\n",
        byte_size(budget.memory()),
        available_memory().map_or(String::new(), |there| format!(
            " of {} available",
            byte_size(there)
        )),
        // Of a small run, pictures take the most in any case.
        if resumed > budget.memory() {
            format!("; {} to go on from a checkpoint", byte_size(resumed))
        } else {
            String::new()
        }
    );
    text += &format!(
        "disk              {}, the snapshots {} of it; {} more for checkpoints while it runs\n",
        byte_size(budget.disk()),
        byte_size(budget.disk_of_snapshots()),
        byte_size(budget.disk_of_checkpoints())
    );
    text + &warnings(&case.warnings())
}

/// The summary of a run, to be read at a glance.
pub(crate) fn summary(case: &Case, summary: &Summary) -> String {
    let time = case.scales.time();
    let at = |star: f64| format!("t* = {} ({})", plain(star), si(star * time, "s"));
    let mut text = String::from("\n");
    let mut line = |name: &str, value: String| text += &format!("{name:<18}{value}\n");
    line(
        "static friction",
        format!(
            "mu_s* = {:.4}   mu_s = {:.4}   at {}",
            summary.static_friction_star,
            summary.static_friction,
            at(summary.onset_time_star)
        ),
    );
    if let Some(first) = summary.first_slip_time_star {
        line("first slip", format!("at {}", at(first)));
    }
    let kinetic = summary
        .kinetic_friction_star
        .zip(summary.kinetic_friction)
        .zip(summary.kinetic_window_star);
    match kinetic {
        Some(((star, mu), [from, to])) => {
            let uncertainty = summary.kinetic_friction_star_uncertainty;
            let dimensional = uncertainty.map(|error| error * case.scales.mu_static_mean);
            line(
                "kinetic friction",
                format!(
                    "mu_k* = {}   mu_k = {}   over t* = {} to {}",
                    with_uncertainty(star, uncertainty),
                    with_uncertainty(mu, dimensional),
                    plain(from),
                    plain(to)
                ),
            );
        }
        None => line(
            "kinetic friction",
            "none: the run has no kinetic window".to_owned(),
        ),
    }
    line(
        "sliding blocks",
        match summary.sliding_percent_kinetic {
            Some(kinetic) => format!(
                "N* = {:.1} % at most, {kinetic:.1} % in that window",
                summary.sliding_percent_max
            ),
            None => format!("N* = {:.1} % at most", summary.sliding_percent_max),
        },
    );
    line(
        "energy",
        format!(
            "{} put in, the ledger closes to {:.1e}",
            si(summary.work_j, "J"),
            summary.energy_error.abs()
        ),
    );
    text + &warnings(&summary.warnings)
}

/// The plan of a study and what it will cost.
pub(crate) fn plan(plan: &Plan, block_steps: f64, seconds: f64, threads: usize) -> String {
    let settings = &plan.settings;
    let mut text = format!("{}\n", plan.name);
    for axis in &plan.axes {
        let mut levels: Vec<String> = axis.levels.iter().map(|level| level.labels.join(" & ")).collect();
        if levels.len() > MOST_LEVELS {
            let between = format!("... ({} levels) ...", levels.len());
            levels.splice(MOST_LEVELS / 2..levels.len() - 1, [between]);
        }
        text += &format!("  {}: {}\n", axis.columns.join(" & "), levels.join(", "));
    }
    let replicates = match &settings.until {
        None => format!("{} replicates", settings.replicates),
        Some(until) => format!(
            "{} to {} replicates, until {} is known within {}",
            until.min, until.max, until.key, until.half_width
        ),
    };
    let reference = if plan.has_reference() {
        ", each with its reference"
    } else {
        ""
    };
    let runs = |replicates| plan.runs(replicates).count();
    let (least, most) = (runs(settings.min_replicates()), runs(settings.max_replicates()));
    let count = if least == most {
        format!("{least}")
    } else {
        format!("{least} to {most}")
    };
    text += &format!(
        "  {} points, {replicates}{reference}: at most {count} runs\n",
        plan.points.len()
    );
    text += &format!(
        "  {block_steps:.2e} block-steps, {} on {threads} threads of this machine\n",
        duration(seconds)
    );
    text += &format!(
        "  {} of memory for {threads} runs at once, {} on the disk\n",
        byte_size(plan.memory(threads)),
        byte_size(plan.disk(plan.runs(settings.min_replicates())))
    );
    text + &warnings_of_plan(plan)
}

/// What is the matter with the cases of a study.
fn warnings_of_plan(plan: &Plan) -> String {
    let all = plan.warnings();
    let mut text = String::new();
    for warning in all.iter().take(MOST_WARNINGS) {
        let first = plan.describe(&plan.points[warning.first]);
        let place = match (warning.points, plan.points.len()) {
            (some, all) if some == all => "at every point".to_owned(),
            (1, _) => format!("at the point {first}"),
            (some, _) => format!("at {some} points, the first {first}"),
        };
        text += &format!("note: {} ({place})\n", warning.sentence);
    }
    if all.len() > MOST_WARNINGS {
        let more = all.len() - MOST_WARNINGS;
        text += &format!("note: and {more} more of the kind, which `slipfront check` tells for a case\n");
    }
    text
}

/// What a study has found, and where it is.
pub(crate) fn study(plan: &Plan, results: &StudyResults, folder: &Path) -> String {
    let mut text = String::new();
    let name = study::main_quantity(plan);
    text += &format!("{name}\n");
    let without: Vec<RunKey> = results.without_transition().collect();
    let rows: Vec<(String, String)> = (0..plan.points.len())
        .take(MOST_ROWS)
        .map(|position| {
            let mut of_point = results.runs.iter().filter(|(run, _)| run.point == position);
            let mut value = match study::sample(plan, results, position, name) {
                Some(sample) => format!(
                    "{}   n = {}",
                    with_uncertainty(sample.mean, sample.half_width),
                    sample.n
                ),
                None if of_point.any(|(_, result)| matches!(**result, RunResult::Failed(_))) => {
                    "failed".to_owned()
                }
                None => "none".to_owned(),
            };
            if results.points[position].narrow == Some(false) {
                value += "   (interval still too wide)";
            }
            let without = without.iter().filter(|run| run.point == position).count();
            if without > 0 {
                let runs = results.runs.keys().filter(|run| run.point == position).count();
                value += &format!("   (no transition in {without} of {runs} runs)");
            }
            (plan.describe(&plan.points[position]), value)
        })
        .collect();
    let width = rows
        .iter()
        .map(|(point, _)| point.chars().count())
        .max()
        .unwrap_or_default();
    for (point, value) in rows {
        text += &format!("  {point:<width$}   {value}\n");
    }
    if plan.points.len() > MOST_ROWS {
        text += &format!(
            "  and {} more points in points.csv\n",
            plan.points.len() - MOST_ROWS
        );
    }
    // Points share references.
    let without: HashSet<String> = without.into_iter().map(|run| plan.identity(run)).collect();
    if !without.is_empty() {
        text += &format!(
            "note: mu* never fell half-way to its steady level in {} runs, and static_friction_star is the largest mu* of them: \
             lengthen `time.duration_star` of the base, unless they were expected to have no transition\n",
            without.len()
        );
    }
    text += &warnings_of_plan(plan);
    if results.orphaned_runs > 0 {
        text += &format!(
            "note: {} recorded runs are not part of the study as it is now; they stay in records.jsonl\n",
            results.orphaned_runs
        );
    }
    text + &format!("runs.csv, points.csv and pictures in {}\n", folder.display())
}

/// Most levels of an axis that are printed.
const MOST_LEVELS: usize = 10;

/// Most warnings about the cases of a study that are printed.
const MOST_WARNINGS: usize = 8;

/// Most points that are printed.
const MOST_ROWS: usize = 40;

fn warnings(warnings: &[String]) -> String {
    warnings
        .iter()
        .map(|warning| format!("note: {warning}\n"))
        .collect()
}

/// A number to four digits, without trailing zeros.
fn plain(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e6).contains(&value.abs()) {
        return format!("{value:.3e}");
    }
    let digits = (3 - value.abs().max(1e-9).log10().floor() as i32).clamp(0, 6) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// A value and its uncertainty, both to the second digit of the uncertainty; to four places where there is none.
fn with_uncertainty(value: f64, uncertainty: Option<f64>) -> String {
    match uncertainty {
        Some(error) if error > 0.0 => {
            let places = (1 - error.log10().floor() as i32).clamp(0, 12) as usize;
            format!("{value:.places$} \u{b1} {error:.places$}")
        }
        Some(_) => format!("{} \u{b1} 0", to_four_places(value)),
        None => to_four_places(value),
    }
}

/// A number to four places, or to four digits where that would leave none of it.
fn to_four_places(value: f64) -> String {
    if value != 0.0 && value.abs() < 1e-3 {
        plain(value)
    } else {
        format!("{value:.4}")
    }
}

/// A quantity with the SI prefix that suits it.
fn si(value: f64, unit: &str) -> String {
    const PREFIXES: [&str; 13] = ["a", "f", "p", "n", "u", "m", "", "k", "M", "G", "T", "P", "E"];
    let magnitude = value.abs();
    if !magnitude.is_normal() {
        return format!("{value} {unit}");
    }
    let step = (magnitude.log10() / 3.0 + 1e-9).floor().clamp(-6.0, 6.0);
    format!(
        "{} {}{unit}",
        plain(value / 1000f64.powf(step)),
        PREFIXES[(step + 6.0) as usize]
    )
}

fn duration(seconds: f64) -> String {
    if seconds < 1.0 {
        return "less than a second".to_owned();
    }
    let rounded = std::time::Duration::from_secs_f64(seconds.min(1e15));
    format!("about {}", indicatif::HumanDuration(rounded))
}
