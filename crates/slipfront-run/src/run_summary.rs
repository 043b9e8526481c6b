//! Runs a [`Case`] and keeps only its [`Summary`], which a search or a fit needs for many small cases.

use std::borrow::Cow;
use std::sync::Arc;

use slipfront::communicator::Alone;
use slipfront::observe::{Instants, Scheduled};
use slipfront::{Execution, RunError, SearchOutcome, Simulation, StopReason};
use slipfront_case::case::Case;

use crate::running::instants_of;
use crate::summary::Summary;
use crate::summary_observers::SummaryObservers;

/// Runs a case on one thread up to the end that its `time.stop` sets, and returns the numbers of
/// `summary.json`, bit for bit as [`running::run`](crate::running::run) does. No curve, fields or kymograph
/// are recorded, and no file is written.
///
/// ```
/// use slipfront_case::case::Case;
/// use slipfront_run::run_summary::run_summary;
/// // Blocks that are all alike and have no damping slip together, when the drive springs pull with mu_s.
/// let text = "slider = { blocks = [4, 4], omega_star = 0 }\ndrive.v_star = 0.1\ntime.stop = 'after_onset'\n\
///             friction = { sigma_static_star = 0, sigma_kinetic_star = 0 }";
/// let summary = run_summary(&Case::parse(text, "alike", "", &[])?)?;
/// assert!(summary.transition && (summary.static_friction_star - 1.0).abs() < 0.005);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the run diverges.
pub fn run_summary(case: &Case) -> Result<Summary, RunError> {
    loop {
        if let Some(ended) = run_summary_unless(case, &|| false) {
            return ended;
        }
    }
}

/// Runs a case as [`run_summary`] does until `ends` returns true; none if it was given up.
pub fn run_summary_unless(case: &Case, ends: &dyn Fn() -> bool) -> Option<Result<Summary, RunError>> {
    let case = &match with_increments(case, ends)? {
        Ok(case) => case,
        Err(error) => return Some(Err(error)),
    };
    let plan = &case.time_plan;
    let mut simulation = Simulation::new(
        Arc::clone(&case.model),
        plan.dt_star,
        case.state(),
        Execution::default(),
    );
    let mut numbers = SummaryObservers::without_curve(case);
    let mut instants = instants_of(case, Vec::new());
    while !ends() {
        let mut observers = numbers.scheduled();
        observers.extend(instants.as_mut().map(|instants| Scheduled::always(instants)));
        match simulation.advance(plan.stop, case.steps_per_poll(), &mut observers) {
            Ok(None) => {}
            Ok(Some(reason)) => return Some(Ok(summary(case, simulation, reason, &numbers, instants))),
            Err(error) => return Some(Err(error)),
        }
    }
    None
}

/// The case with the increments of a held drive that lead a bulk body to its onset, if they are searched;
/// none if `ends` gave the search up.
pub(crate) fn with_increments<'a>(
    case: &'a Case,
    ends: &dyn Fn() -> bool,
) -> Option<Result<Cow<'a, Case>, RunError>> {
    let Some(mut search) = case.search(Execution::default()) else {
        return Some(Ok(Cow::Borrowed(case)));
    };
    while !ends() {
        search = match search.advance(case.steps_per_poll()) {
            Ok(SearchOutcome::Unfinished(search)) => search,
            Ok(SearchOutcome::Found(found)) => return Some(Ok(Cow::Owned(case.with_increments(found)))),
            Err(error) => return Some(Err(error)),
        };
    }
    None
}

/// The numbers of a run that has ended.
pub(crate) fn summary(
    case: &Case,
    simulation: Simulation,
    reason: StopReason,
    numbers: &SummaryObservers,
    instants: Option<Instants>,
) -> Summary {
    let instants = instants.map_or(Vec::new(), Instants::found);
    let mut summary = numbers.end(case, &simulation, reason, &instants);
    let first_slips = simulation.into_first_slip_time_star();
    numbers.add_front(&mut summary, case, &first_slips, &Alone);
    summary
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::running;

    /// The numbers are those of a run that records all: every observer has numbers in the summary of one of
    /// these cases.
    #[test]
    fn the_numbers_are_those_of_a_run_that_records_all() {
        for text in [
            "texture = [{ shape = 'cavity', coverage = 10 }]",
            "texture = [{ shape = 'cavity', coverage = 10 }]\ntime.stop = 'after_onset'",
            "drive.loading = 'held'\ntime = { stop = 'after_onset', kinetic_from_star = 120 }",
            "drive = { attach = 'left', v_star = 0.1 }\ntime.duration_star = 300",
            "drive.program = [{ v_star = 0.1, until_star = 40 }, { v_star = 0.2 }]\noutput.series = 7",
            "drive.v_star = 0.1\noutput.snapshots = [10, 20]",
            "drive.v_star = 0.1\noutput = { snapshots = { every = 9 }, stride = 3, fields = ['traction'] }",
            "drive.v_star = 0.1\nfriction = { law = 'rate_and_state', a = 0.02, b = 0.06, d_c_star = 0.05, v_0_star = 0.01, mu_0 = 0.6 }",
        ] {
            let text = format!("slider.blocks = [20, 12]\n{text}");
            let case = Arc::new(Case::parse(&text, "case", "", &[]).unwrap());
            let whole = running::run(&case, 1).unwrap().summary;
            // Compared as text, in which NaN equals NaN.
            assert_eq!(
                format!("{:?}", run_summary(&case).unwrap()),
                format!("{whole:?}"),
                "{text}"
            );
        }
    }

    #[test]
    fn a_run_is_given_up_when_it_is_told_so() {
        let case = Case::parse(
            "slider.blocks = [20, 20]\ntime.duration_star = 1e8",
            "case",
            "",
            &[],
        )
        .unwrap();
        let looks = std::cell::Cell::new(0);
        let ends = || looks.replace(looks.get() + 1) == 3;
        assert_eq!(run_summary_unless(&case, &ends), None);
        assert_eq!(looks.get(), 4);
    }

    #[test]
    fn a_run_that_diverges_is_an_error() {
        let text = "slider = { blocks = [8, 8], omega_star = 0 }\nload.pressure = '50 GPa'\ndrive.v_star = 10\n\
                    friction = { r_star = 0, sigma_static_star = 1 }\ntime = { step = 0.9, duration_star = 2000 }";
        let case = Case::parse(text, "case", "", &[]).unwrap();
        assert!(run_summary(&case).unwrap_err().to_string().contains("diverged"));
    }
}
