//! Parts of the report of `slipfront check` that follow the physics of a case.

use slipfront_base::machine::available_memory;
use slipfront_base::number_format::{byte_size, four_digits, with_half_width, with_si_prefix};
use slipfront_case::case::Case;
use slipfront_run::estimate_cost::StepTime;
use slipfront_run::running::useful_threads;
use slipfront_run::times::instant;

use super::speeds::Speeds;
use super::times::duration;
use crate::wrap::notes;

/// The expected onset, the stability of the step, the cost, the speeds and the warnings; `per_step` is the
/// time of a step.
pub(crate) fn cost(case: &Case, per_step: &StepTime) -> String {
    let (loading, _) = loading(case);
    let speeds = Speeds::new(case).map_or(String::new(), |speeds| speeds.text(case, per_step));
    let time = per_step.of_steps(&case.expected_steps());
    onset(case) + &loading + &scales(case) + &resources(case, time) + &speeds + &notes(warnings(case))
}

/// Warnings about a case, with the note on a drive that loads it faster than a front crosses it.
pub(super) fn warnings(case: &Case) -> Vec<String> {
    let (_, note) = loading(case);
    case.warnings().into_iter().chain(note).collect()
}

/// Ratio of the time in which a slip front crosses the slider, about one block per t*, to the time in which
/// the drive loads it, about 1/V*: the line of the report, and a note if the drive is faster. A held drive
/// waits for the front, and a single block has no mesh error.
fn loading(case: &Case) -> (String, Option<String>) {
    if case.model.n_blocks() == 1 {
        return (String::new(), None);
    }
    if case.model.drive.is_held() {
        let line = "loading           slow: the drive stops while a front crosses the slider\n";
        return (line.to_owned(), None);
    }
    let (name, blocks) = case.blocks_along_drive();
    let ratio = case.model.speed_against_front() * blocks;
    let line = format!(
        "loading           V* {name} = {}: time for a front to cross the {} blocks, relative to the loading time\n",
        four_digits(ratio),
        four_digits(blocks)
    );
    let note = (ratio > 1.0).then(|| {
        format!(
            "V* {name} = {} is above 1: while a slip front crosses the slider, the drive continues to load the part that still \
             sticks. mu_s* and the effect of a texture then depend on speed and size. V* {name} is 1 at V* = {}, and loading is \
             slow well below this speed",
            four_digits(ratio),
            four_digits(case.groups.v_star / ratio)
        )
    });
    (line, note)
}

fn onset(case: &Case) -> String {
    if case.initial.is_some() {
        return "onset             unknown: blocks start displaced or in motion\n".to_owned();
    }
    let late = |star: f64| {
        if star > case.time_plan.end_star() {
            ", after the end of the run: lengthen `time.duration_star`"
        } else {
            ""
        }
    };
    let at = |star: f64| instant(star, &case.scales);
    let expected = &case.expected;
    let mut text = String::new();
    let first = expected.first_slip_star.filter(|_| case.file.texture.is_empty());
    if let Some(first) = first {
        text += &format!("first slip        {}{}\n", at(first), late(first));
    }
    let [from, to] = expected.onset_star;
    text += &if from < to {
        let surface = &case.model.surface;
        let factor = surface.largest_load();
        let load = if factor > surface.load_factor() {
            format!("carry up to {} times the mean load", four_digits(factor))
        } else if factor > 1.0 {
            format!("each carry {} times the load", four_digits(factor))
        } else {
            "are also pulled by the others".to_owned()
        };
        format!(
            "onset expected    {} to {}: the {} % of blocks in contact {load}; the onset is earlier if contacts are dispersed{}\n",
            at(from),
            at(to),
            four_digits(100.0 - case.texture.meshed_percent),
            late(to)
        )
    } else if expected.first_slip_star.is_none() {
        format!(
            "onset expected    about {}, if the slider did not deform under its drive{}\n",
            at(to),
            late(to)
        )
    } else {
        format!("onset expected    about {} (Eq. 12){}\n", at(to), late(to))
    };
    text + &whole_slider(case)
}

/// Expected static friction of the whole slider, if it is known and less than that of its blocks.
fn whole_slider(case: &Case) -> String {
    let given = case.scales.mu_static_mean;
    let expected = case
        .whole_slider()
        .filter(|whole| whole.mu_static + whole.half_width < given);
    expected.map_or(String::new(), |whole| {
        format!(
            "static friction   mu_s = {} for the slider and {} for its blocks; set mu_static = {:.3} to obtain {} (estimate \
             from 50 x 50 blocks with this sigma_s*, R* and V*)\n",
            with_half_width(whole.mu_static, Some(whole.half_width)),
            four_digits(given),
            whole.for_given,
            four_digits(given)
        )
    })
}

fn scales(case: &Case) -> String {
    format!(
        "steady level      mu* = {}\n\
         scales            time {}, displacement {}, stress {}\n\
         stability         dt* = {} of at most {:.4}\n",
        four_digits(case.expected.steady_level),
        with_si_prefix(case.scales.time(), "s"),
        with_si_prefix(case.scales.displacement(), "m"),
        with_si_prefix(case.scales.stress(), "Pa"),
        four_digits(case.time_plan.dt_star),
        case.time_plan.step_limit
    )
}

/// Remark on the cost of a held drive, which excludes the unknown time in which the drive is at rest.
pub(super) fn held_drive_remark(is_held: bool) -> &'static str {
    if is_held {
        ", not counting steps in which the drive stops"
    } else {
        ""
    }
}

fn resources(case: &Case, time: [f64; 2]) -> String {
    let budget = &case.budget;
    let available = available_memory().map_or(String::new(), |there| {
        format!(" of {} available", byte_size(there))
    });
    format!(
        "cost              {:.3e} block-steps{}, {} on one thread{}\n\
         memory            {}{available}\n\
         disk              {}, of which snapshots take {}; {} more for checkpoints during the run\n",
        case.block_steps(),
        held_drive_remark(case.model.drive.is_held()),
        duration(time),
        match useful_threads(case, rayon::current_num_threads()) {
            1 => String::new(),
            threads => format!(" of the {threads} that a run uses here"),
        },
        byte_size(budget.memory()),
        byte_size(budget.disk()),
        byte_size(budget.disk_of_snapshots()),
        byte_size(budget.disk_of_checkpoints())
    )
}
