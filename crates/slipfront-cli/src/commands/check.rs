//! `slipfront check`: the physics and the cost of a case, without running it.

use clap::Args;
use slipfront_run::estimate_cost::StepTime;

use crate::case_args::CaseArgs;
use crate::failure::Failure;
use crate::print::{print, print_json};
use crate::ranks::CommandRanks;
use crate::report::cost::cost;
use crate::report::json::check;
use crate::report::lengths::lengths;
use crate::report::physics::physics;
use crate::signals::Signals;
use crate::threads::set_threads;

/// Check a case, and print its physics and its cost
///
/// Runs only a short measurement of the speed of this machine
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront check cases/circle.toml
  slipfront check cases/circle.toml --set texture.0.coverage=25
  slipfront check cases/circle.toml --json | jq .memory_bytes")]
pub(crate) struct CheckCommand {
    #[command(flatten)]
    case: CaseArgs,
    /// Print the report as JSON
    #[arg(long)]
    json: bool,
}

impl CheckCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        set_threads(None)?;
        let signals = Signals::catch().map_err(Failure::running)?;
        let case = self.case.load(&CommandRanks::alone(), &signals, false)?;
        if self.json {
            return print_json(&check(&case, &StepTime::measure(&case)));
        }
        print(&(physics(&case) + &lengths(&case)))?;
        print(&cost(&case, &StepTime::measure(&case)))
    }
}
