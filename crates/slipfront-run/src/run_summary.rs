//! [`Case`] -> [`Summary`]: a run of which the numbers alone are kept, as a search and a fit need them of many small cases.

use std::sync::Arc;

use slipfront::communicator::Alone;
use slipfront::observe::{Instants, Scheduled};
use slipfront::{Execution, RunError, Simulation, StopReason};
use slipfront_case::case::Case;

use crate::running::{add_front, instants_of};
use crate::summary::{Summary, SummaryObservers};

/// Runs a case on one thread up to where its `time.stop` says, and gives the numbers of `summary.json` with the bits of
/// [`running::run`](crate::running::run). Neither curve, fields nor kymograph are recorded, and no file is written.
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

/// Runs a case as [`run_summary`] does, as long as `ends` does not say otherwise; none if it was given up.
pub fn run_summary_unless(case: &Case, ends: &dyn Fn() -> bool) -> Option<Result<Summary, RunError>> {
    let plan = &case.time_plan;
    let mut simulation = Simulation::new(Arc::clone(&case.model), plan.dt_star, None, Execution::default());
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

/// The numbers of a run that has ended.
fn summary(
    case: &Case,
    simulation: Simulation,
    reason: StopReason,
    numbers: &SummaryObservers,
    instants: Option<Instants>,
) -> Summary {
    let instants = instants.map_or(Vec::new(), Instants::found);
    let mut summary = numbers.end(case, &simulation, reason, &instants);
    let first_slips = simulation.into_first_slip_time_star();
    add_front(&mut summary, numbers, case, &first_slips, &Alone);
    summary
}
