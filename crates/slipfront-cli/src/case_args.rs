//! Arguments of the subcommands that take a case.

use std::path::{Path, PathBuf};

use clap::Args;
use slipfront_case::case::Case;
use slipfront_case::case_file::CaseFile;

use crate::failure::Failure;
use crate::make_case::make_case;
use crate::ranks::CommandRanks;
use crate::signals::Signals;

/// The case file and the changes of it that the command line asks for.
#[derive(Args)]
pub(crate) struct CaseArgs {
    /// Case file; without one, the embedded baseline: Fig. 3 of the paper
    #[arg(value_name = "CASE.toml")]
    case: Option<PathBuf>,
    /// Sets a key of the case file, such as drive.v_star=0.05 or texture.0.coverage=5; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<String>,
    /// Seed of the random friction coefficients: short for --set friction.seed=N
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    seed: Option<String>,
}

impl CaseArgs {
    /// The case file, if one was named.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.case.as_deref()
    }

    /// Reads the case, or takes the baseline that is embedded in the program.
    pub(crate) fn load(self, ranks: &CommandRanks, signals: &Signals, quiet: bool) -> Result<Case, Failure> {
        let mut overrides = self.overrides;
        overrides.extend(self.seed.map(|seed| format!("friction.seed={seed}")));
        make_case(ranks, signals, quiet, |watch, ranks| match self.case {
            Some(path) => Case::load(&path, &overrides, watch, ranks),
            None => {
                let (text, name) = (include_str!("baseline.toml"), "baseline");
                let file = ranks.agree(CaseFile::parse(text, name, &overrides))?;
                Case::to_run(file, name, Path::new(""), watch, ranks)
            }
        })
    }
}
