//! `slipfront study merge`: the shards of a study in one.

use std::path::PathBuf;

use clap::Args;
use slipfront_case::study::{Plan, StudyFolder, refuse_foreign, study_of};

use super::run;
use crate::failure::Failure;

/// Unite the shards of a study: their records, tables and pictures; may be repeated
#[derive(Args)]
pub(crate) struct Merge {
    /// Folders of the shards
    #[arg(required = true, value_name = "DIR")]
    shards: Vec<PathBuf>,
    /// Folder of the united study
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
}

impl Merge {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        refuse_foreign(&self.shards).map_err(Failure::input)?;
        let study = study_of(&self.shards[0]).map_err(Failure::input)?;
        let plan = Plan::new(&study, None).map_err(Failure::input)?;
        let mut folder = StudyFolder::open(&self.out, &study).map_err(Failure::input)?;
        let mut taken = 0;
        for shard in &self.shards {
            taken += folder.records.merge(shard).map_err(Failure::running)?;
        }
        eprintln!("{taken} runs taken over from {} shards", self.shards.len());
        folder.copy_inputs(&plan, &study).map_err(Failure::running)?;
        // What no shard has is run here.
        run::run(&plan, &mut folder, rayon::current_num_threads(), false)
    }
}
