//! Warnings that follow from a run itself.

use slipfront::StopReason;
use slipfront::observe::{Energies, Kinetic, NoUncertainty, Peak};

/// Share of unaccounted energy above which there is a warning; a step of 0.1 stays a factor of ten below.
const LARGE_ENERGY_ERROR: f64 = 0.01;

/// Whether sliding goes on as high as a peak that a fall has ended: mu_s* is then one of many peaks of a
/// slider that creeps.
pub(crate) fn is_kept_up(peak: &Peak, kinetic: Option<Kinetic>) -> bool {
    peak.ended && kinetic.is_some_and(|kinetic| !peak.is_above(kinetic.mu_star))
}

/// Excess of a later mu* over the first peak, relative to that peak, above which there is a warning. Equal
/// peaks of stick-slip differ by less, since steps do not meet their tops.
const HIGHER_LATER: f64 = 0.01;

/// Warnings that follow from the run itself.
pub(crate) fn after_run(
    (reason, is_held): (StopReason, bool),
    peak: &Peak,
    transition: bool,
    first_slip: Option<f64>,
    kinetic: Option<Kinetic>,
    energies: &Energies,
) -> Vec<String> {
    let mut warnings = Vec::new();
    if energies.error().abs() > LARGE_ENERGY_ERROR {
        warnings.push(format!(
            "{:.0} % of the energy put in is unaccounted for: the time step is too coarse for this case",
            100.0 * energies.error().abs()
        ));
    }
    if !peak.ended {
        let rises = kinetic.is_some_and(|kinetic| kinetic.window_star[0] <= peak.drive_time_star);
        warnings.push(format!(
            "mu* did not fall half-way to its steady level in the time of a transition: there was none, and static_friction_star is the \
             largest mu* of the run{}",
            if rises {
                "; the kinetic window begins before it, so that kinetic_friction_star may have a part of the rise"
            } else {
                ""
            }
        ));
    }
    if let Some(kinetic) = kinetic.filter(|_| is_kept_up(peak, kinetic)) {
        warnings.push(format!(
            "mu* slides on at {:.4} after a first peak of {:.4}, with less between them than a twentieth of what friction can lose: there was no \
             transition, and static_friction_star is the largest mu* of the run",
            kinetic.mu_star, peak.mu_star
        ));
    }
    if transition && peak.largest.mu_star > (1.0 + HIGHER_LATER) * peak.mu_star {
        let (first, remedy) = if is_held {
            (
                "before the kinetic window",
                "set time.kinetic_from_star after it to count it as static friction",
            )
        } else {
            (
                "at its first peak",
                "slow loading by drive.loading = \"held\" takes the largest",
            )
        };
        warnings.push(format!(
            "mu* is larger later than {first}: {:.4} at t* = {:.1}, {:.0} % above static_friction_star = {:.4}; {remedy}",
            peak.largest.mu_star,
            peak.largest.time_star,
            100.0 * (peak.largest.mu_star / peak.mu_star - 1.0),
            peak.mu_star
        ));
    }
    if first_slip.is_none() {
        warnings.push(
            "no block in contact slipped before the run ended: kinetic_friction_star is empty; lengthen \
             time.duration_star"
                .to_owned(),
        );
        return warnings;
    }
    match kinetic.map(|kinetic| kinetic.uncertainty) {
        None if reason == StopReason::Onset => {}
        None => warnings.push(
            "the run ended before the kinetic window began: kinetic_friction_star is empty; lengthen \
             time.duration_star or set time.kinetic_from_star"
                .to_owned(),
        ),
        Some(Err(NoUncertainty::TooShort { needed_time_star })) => warnings.push(format!(
            "no uncertainty could be estimated for mu_k*: set time.duration_star to {:.0} or more",
            needed_time_star.ceil()
        )),
        Some(Err(NoUncertainty::SpeedChanges)) => {
            warnings.push("no uncertainty can be estimated for mu_k*, since the drive changes its speed".to_owned());
        }
        Some(Err(NoUncertainty::Drift { needed_time_star })) => warnings.push(format!(
            "no uncertainty could be estimated for mu_k*, since mu* still drifts: set time.duration_star to {needed_time_star:.0}, \
             or begin the mean later by time.kinetic_from_star"
        )),
        Some(Ok(_)) => {}
    }
    warnings
}
