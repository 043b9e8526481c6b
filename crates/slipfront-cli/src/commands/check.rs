//! `slipfront check`: what a case means and costs, without running it.

use std::time::{Duration, Instant};

use clap::Args;
use slipfront::Simulation;
use slipfront_case::case::Case;

use super::{CaseArgs, print};
use crate::failure::Failure;
use crate::report;

/// Validate a case and print what it means and what it will cost
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront check cases/circle.toml
  slipfront check cases/circle.toml --set texture.0.coverage=25")]
pub(crate) struct Check {
    #[command(flatten)]
    case: CaseArgs,
}

impl Check {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let case = self.case.load()?;
        print(&report::physics(&case))?;
        print(&report::cost(&case, probe(&case)))
    }
}

/// How long the probe may take.
const PROBE: Duration = Duration::from_millis(100);

/// Seconds that the whole run would take at the speed of its first steps.
fn probe(case: &Case) -> f64 {
    let mut simulation = Simulation::at_rest(&case.model, case.schedule.dt_star);
    let (began, mut steps) = (Instant::now(), 0);
    while began.elapsed() < PROBE {
        simulation.step();
        steps += 1;
    }
    began.elapsed().as_secs_f64() / f64::from(steps) * case.schedule.last_step as f64
}
