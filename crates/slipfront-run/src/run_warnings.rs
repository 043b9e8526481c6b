//! Warnings that follow from a run itself.

use slipfront::StopReason;
use slipfront::observe::{Energies, Kinetic, NoUncertainty, Peak};

/// Share of unaccounted energy above which there is a warning; a step of 0.1 stays a factor of ten below.
const LARGE_ENERGY_ERROR: f64 = 0.01;

/// Whether mu* of sliding is as high as a peak that ended with a fall: mu_s* is then one of many peaks of a
/// creeping slider.
pub(crate) fn is_kept_up(peak: &Peak, kinetic: Option<Kinetic>) -> bool {
    peak.ended && kinetic.is_some_and(|kinetic| !peak.is_above(kinetic.mu_star))
}

/// Excess of a later mu* over the first peak, relative to that peak, above which there is a warning. Equal
/// peaks of stick-slip differ by less, because time steps do not hit their maxima.
const HIGHER_LATER: f64 = 0.01;

/// Warnings that follow from the run itself.
pub(crate) fn after_run(
    (reason, is_held, has_usual_length): (StopReason, bool, bool),
    peak: &Peak,
    transition: bool,
    first_slip: Option<f64>,
    kinetic: Option<Kinetic>,
    energies: &Energies,
) -> Vec<String> {
    let mut warnings = Vec::new();
    if energies.error().abs() > LARGE_ENERGY_ERROR {
        warnings.push(format!(
            "{:.0} % of the input energy is missing from the balance: the time step is too coarse for this case",
            100.0 * energies.error().abs()
        ));
    }
    if !peak.ended {
        let rises = kinetic.is_some_and(|kinetic| kinetic.window_star[0] <= peak.drive_time_star);
        warnings.push(format!(
            "after its peak, mu* did not drop at least half-way to the steady level within the time of a transition: there is \
             no transition, and static_friction_star is the largest mu* of the run{}",
            if rises {
                "; the kinetic window begins before this maximum, so kinetic_friction_star may include part of the rise"
            } else {
                ""
            }
        ));
    }
    if let Some(kinetic) = kinetic.filter(|_| is_kept_up(peak, kinetic)) {
        warnings.push(format!(
            "sliding continues at mu* = {:.4} after a first peak of {:.4}, a drop of less than a twentieth of the possible \
             drop: there is no transition, and static_friction_star is the largest mu* of the run",
            kinetic.mu_star, peak.mu_star
        ));
    }
    if transition && peak.largest.mu_star > (1.0 + HIGHER_LATER) * peak.mu_star {
        let (first, remedy) = if is_held {
            (
                "before the kinetic window",
                "to count it as static friction, set time.kinetic_from_star to a later time",
            )
        } else {
            (
                "at its first peak",
                "slow loading with drive.loading = \"held\" uses the largest",
            )
        };
        warnings.push(format!(
            "mu* becomes larger than {first}: {:.4} at t* = {:.1}, {:.0} % above static_friction_star = {:.4}; {remedy}",
            peak.largest.mu_star,
            peak.largest.time_star,
            100.0 * (peak.largest.mu_star / peak.mu_star - 1.0),
            peak.mu_star
        ));
    }
    if first_slip.is_none() {
        warnings.push(
            "no block in contact slipped before the run ended: kinetic_friction_star is empty; increase time.duration_star"
                .to_owned(),
        );
        return warnings;
    }
    match kinetic.map(|kinetic| kinetic.uncertainty) {
        None if reason == StopReason::Onset => {}
        None => warnings.push(
            "the run ended before the kinetic window began: kinetic_friction_star is empty; increase time.duration_star or set \
             time.kinetic_from_star"
                .to_owned(),
        ),
        // Nobody asked for more than the usual length, which shows onset and sliding.
        Some(Err(NoUncertainty::TooShort { .. })) if has_usual_length => {}
        Some(Err(NoUncertainty::TooShort { needed_time_star })) => warnings.push(format!(
            "no uncertainty could be estimated for mu_k*: set time.duration_star to {:.0} or more",
            needed_time_star.ceil()
        )),
        Some(Err(NoUncertainty::SpeedChanges)) => {
            warnings.push("no uncertainty can be estimated for mu_k*, because the drive speed changes".to_owned());
        }
        Some(Err(NoUncertainty::Drift { needed_time_star })) => warnings.push(format!(
            "no uncertainty could be estimated for mu_k*, because mu* still drifts: set time.duration_star to \
             {needed_time_star:.0}, or start the average later with time.kinetic_from_star"
        )),
        Some(Ok(_)) => {}
    }
    warnings
}

#[cfg(test)]
mod tests {
    use slipfront_case::case::Case;

    use crate::run_summary::run_summary;

    /// The usual length is too short for an uncertainty of kinetic friction, which is no news; of a length
    /// that somebody chose, the one that is needed is told.
    #[test]
    fn only_a_chosen_length_is_called_too_short() {
        let warnings = |time: &str| {
            let text = format!("slider.blocks = [8, 8]\ndrive.v_star = 0.1\n{time}");
            let case = Case::parse(&text, "case", "", &[]).unwrap();
            run_summary(&case).unwrap().warnings.join("\n")
        };
        let said = "no uncertainty could be estimated for mu_k*: set time.duration_star to";
        assert!(!warnings("").contains(said));
        assert!(warnings("time.duration_star = 90").contains(said));
    }
}
