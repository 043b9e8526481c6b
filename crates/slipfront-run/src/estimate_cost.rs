//! Estimate of the cost of a run from some of its steps.

use std::time::{Duration, Instant};

use slipfront::{Execution, Simulation};
use slipfront_case::case::Case;

/// Duration of an estimate.
const ESTIMATE: Duration = Duration::from_millis(25);

/// Seconds that a step of this case takes when every block is computed: no run takes longer, and one with
/// blocks at rest is faster.
pub fn seconds_per_step(case: &Case) -> f64 {
    let execution = Execution {
        skips: false,
        ..Execution::default()
    };
    let mut simulation = Simulation::new(case.model.clone(), case.time_plan.dt_star, None, execution);
    let (began, mut steps) = (Instant::now(), 0);
    while began.elapsed() < ESTIMATE {
        simulation.step();
        steps += 1;
    }
    began.elapsed().as_secs_f64() / f64::from(steps)
}
