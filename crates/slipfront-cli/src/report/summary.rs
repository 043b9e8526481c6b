//! The summary of a run, readable at a glance.

use slipfront_base::number_format::{count, four_digits, with_si_prefix, with_uncertainty};
use slipfront_case::case::Case;
use slipfront_case::case_file::Motion;
use slipfront_run::observers;
use slipfront_run::summary::Summary;
use slipfront_run::times::instant;

use crate::wrap::notes;

/// The summary of a run, with one line per number, and its warnings.
pub(crate) fn summary(case: &Case, summary: &Summary) -> String {
    let mut lines = vec![("static friction", static_friction(case, summary))];
    if let Some(first) = summary.first_slip_time_star {
        lines.push(("first slip", format!("at {}", instant(first, &case.scales))));
    }
    lines.push(("kinetic friction", kinetic_friction(case, summary)));
    lines.push(("sliding blocks", sliding_blocks(case, summary)));
    if let Some(drive_steps) = summary.drive_steps {
        lines.push(("held drive", held_drive(summary.steps, drive_steps)));
    }
    lines.extend(observers::lines(summary, case));
    lines.push(("energy", energy(summary)));
    lines.push(("mesh", case.deciding_length()));
    let mut text = match summary.motion {
        Some(Motion::Rotation) => String::from("\nmu is the torque divided by load and mean radius\n"),
        _ => String::from("\n"),
    };
    for (name, value) in lines {
        text += &format!("{name:<18}{value}\n");
    }
    text + &notes(&summary.warnings)
}

fn static_friction(case: &Case, summary: &Summary) -> String {
    // Without a fall after it, a peak may still be exceeded.
    let bound = if summary.transition { "" } else { "at least " };
    format!(
        "{bound}mu_s* = {:.4}   mu_s = {:.4}   at {}",
        summary.static_friction_star,
        summary.static_friction,
        instant(summary.onset_time_star, &case.scales)
    )
}

fn kinetic_friction(case: &Case, summary: &Summary) -> String {
    let kinetic = summary
        .kinetic_friction_star
        .zip(summary.kinetic_friction)
        .zip(summary.kinetic_window_star);
    let Some(((star, mu), [from, to])) = kinetic else {
        return "none: the run has no kinetic window".to_owned();
    };
    let uncertainty = summary.kinetic_friction_star_uncertainty;
    let dimensional = uncertainty.map(|error| error * case.scales.mu_static_mean);
    format!(
        "mu_k* = {}   mu_k = {}   over t* = {} to {}",
        with_uncertainty(star, uncertainty),
        with_uncertainty(mu, dimensional),
        four_digits(from),
        four_digits(to)
    )
}

fn sliding_blocks(case: &Case, summary: &Summary) -> String {
    let most = format!("N* = {:.1} % at most", summary.sliding_percent_max);
    let kinetic = summary.sliding_percent_kinetic;
    let kinetic = kinetic.map_or(String::new(), |kinetic| {
        format!(", {kinetic:.1} % in the kinetic window")
    });
    // If sliding means that contacts break, a block without a contact does not count.
    let breaks = case.model.friction.needs().stores_energy;
    let textured = if summary.texture_percent > 0.0 && !breaks {
        format!(
            "; {:.1} % are textured, have no friction, and count as sliding from the start",
            summary.texture_percent
        )
    } else {
        String::new()
    };
    most + &kinetic + &textured
}

fn held_drive(steps: u64, drive_steps: u64) -> String {
    format!(
        "moved in {} of {}, and stopped in the others",
        drive_steps,
        count(steps as usize, "step")
    )
}

fn energy(summary: &Summary) -> String {
    format!(
        "{} of work, {:.1e} of it missing from the balance",
        with_si_prefix(summary.work_j, "J"),
        summary.energy_error.abs()
    )
}
