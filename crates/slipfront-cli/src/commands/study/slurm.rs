//! `slipfront study slurm`: prints a batch script for the queue of a cluster.

use std::path::PathBuf;

use clap::Args;
use slipfront_study::slurm::{Batch, script};
use slipfront_study::{Plan, StudyFile};

use super::run::refuse_large;
use crate::failure::Failure;
use crate::print::print;
use crate::threads::{count_from_one, set_threads};

/// Print a batch script for Slurm with a few tasks, each on all cores of its node; tasks can be requeued
#[derive(Args)]
pub(crate) struct Slurm {
    /// Study file
    #[arg(value_name = "STUDY.toml")]
    study: PathBuf,
    /// Number of tasks, one per node
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = count_from_one)]
    tasks: u16,
    /// Folder for the results of all tasks [default: results/NAME with the name of the study]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Allow more than 10 000 runs
    #[arg(long)]
    yes: bool,
}

impl Slurm {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        set_threads(None)?;
        let study = StudyFile::load(&self.study).map_err(Failure::input)?;
        refuse_large(&study, self.yes)?;
        // An invalid study is refused now, not by a task that has waited in the queue.
        let points = Plan::new(&study, None).map_err(Failure::input)?.points.len();
        let out = self
            .out
            .unwrap_or_else(|| PathBuf::from("results").join(&study.name));
        let absolute = |path: PathBuf| std::path::absolute(path).map_err(Failure::input);
        let command = std::env::current_exe().map_err(Failure::running)?;
        print(&script(&Batch {
            name: study.name.clone(),
            command,
            study: absolute(self.study)?,
            out: absolute(out)?,
            // Tasks beyond the number of points would have nothing to do.
            tasks: usize::from(self.tasks).min(points),
        }))
    }
}
