//! `slipfront study`: sweeps and ensembles of runs, with error bars.

mod merge;
mod run;
mod slurm;

use clap::{Args, Subcommand};

use crate::failure::Failure;

pub(super) use run::{dry_run, run_all};

/// Vary keys and seeds of a case, and tabulate the results
#[derive(Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
#[command(after_help = "Examples:
  slipfront study cases/studies/coverage.toml
  slipfront study cases/studies/coverage.toml --dry-run
  slipfront study cases/studies/coverage.toml --set drive.v_star=0.1 -o results/faster
  slipfront study cases/studies/coverage.toml --json | jq '.points[].static_reduction_percent.mean'
  slipfront study cases/studies/coverage.toml --shard 1/4 -o part1    a quarter of the points
  slipfront study merge part1 part2 part3 part4 -o results/whole
  slipfront study slurm cases/studies/coverage.toml --tasks 4 > coverage.sbatch

If a study is stopped in any way, the same command resumes it: finished runs are never repeated.")]
pub(crate) struct StudyCommand {
    #[command(subcommand)]
    other: Option<Other>,
    #[command(flatten)]
    run: run::StudyRun,
}

#[derive(Subcommand)]
enum Other {
    Merge(merge::Merge),
    Slurm(slurm::Slurm),
}

impl StudyCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        match self.other {
            None => self.run.execute(),
            Some(Other::Merge(merge)) => merge.execute(),
            Some(Other::Slurm(slurm)) => slurm.execute(),
        }
    }
}
