//! `slipfront study merge`: merges the shards of a study in one folder.

use std::path::PathBuf;

use clap::Args;
use slipfront_base::number_format::count;
use slipfront_study::{Plan, StudyFolder, collect, is_study, refuse_foreign, study_of, write};

use crate::failure::Failure;
use crate::print::print_message;
use crate::print_stderr::print_stderr;
use crate::report::study::study_results;
use crate::runs_args::ForceArg;
use crate::signals::Signals;
use crate::threads::set_threads;

/// Merge the shards of a study: their records, tables and pictures; repeatable
#[derive(Args)]
pub(crate) struct Merge {
    /// Folders of the shards
    #[arg(required = true, value_name = "DIR")]
    shards: Vec<PathBuf>,
    /// Folder of the merged study
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    force: ForceArg,
    /// Do not print tables
    #[arg(short, long)]
    quiet: bool,
}

impl Merge {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        set_threads(None)?;
        let mut folders = self.shards.clone();
        // Merging may be repeated: the folder then already holds a study, which must be the study of the
        // shards.
        folders.extend(is_study(&self.out).then(|| self.out.clone()));
        refuse_foreign(&folders).map_err(Failure::input)?;
        let study = study_of(&self.shards[0]).map_err(Failure::input)?;
        let plan = Plan::new(&study, None).map_err(Failure::input)?;
        plan.check_memory(0).map_err(Failure::input)?;
        // A signal removes all files that were copied to the folder.
        let signals = Signals::catch().map_err(Failure::running)?;
        let mut folder =
            StudyFolder::open(&self.out, &study, None, self.force.given).map_err(Failure::from_folder)?;
        let mut taken = 0;
        for shard in &self.shards {
            Failure::if_stopped(&signals)?;
            taken += folder.records.merge(shard).map_err(Failure::running)?;
        }
        if !self.quiet {
            print_stderr(&format!(
                "{} taken over from {}",
                count(taken, "run"),
                count(self.shards.len(), "shard")
            ));
        }
        let results = collect(&plan, &folder.records).map_err(Failure::running)?;
        folder
            .take_kept(&plan, &results, &self.shards, &signals.stop)
            .and_then(|_| write(&plan, &results, &folder, &signals.stop))
            .map_err(|error| Failure::from_results(&signals, error))?;
        if !self.quiet {
            print_message(&study_results(&plan, &results, folder.path()));
        }
        results.expect_no_failures(&plan).map_err(Failure::running)?;
        results.expect_values(&plan).map_err(Failure::running)
    }
}
