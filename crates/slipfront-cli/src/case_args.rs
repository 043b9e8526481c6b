//! Arguments of the subcommands that take a case.

use std::path::{Path, PathBuf};

use clap::Args;
use slipfront_base::disk::{folder_name, folder_of};
use slipfront_case::case::Case;
use slipfront_case::case_file::{CaseFile, read_text_from};
use slipfront_run::names::{CASE, MANIFEST, UNFINISHED};
use slipfront_study::project_folder::CHECKSUMS;

use crate::failure::Failure;
use crate::make_case::make_case;
use crate::ranks::CommandRanks;
use crate::signals::Signals;

/// Name of the case that is run if none is named.
const BASELINE: &str = "baseline";
/// Name of standard input in messages.
const STDIN: &str = "standard input";

/// The case file and the changes of it that the command line asks for.
#[derive(Args)]
pub(crate) struct CaseArgs {
    /// Case file, or - for standard input [default: the embedded baseline, Fig. 3 of the paper]
    #[arg(value_name = "CASE.toml")]
    case: Option<PathBuf>,
    /// Set a key of the case file, such as drive.v_star=0.05 or texture.0.coverage=5; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<String>,
    /// Seed of the random friction coefficients, as --set friction.seed=N
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    seed: Option<String>,
}

impl CaseArgs {
    /// The case file, if one was named.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.case.as_deref()
    }

    /// Reads the case, or uses the baseline embedded in the program.
    pub(crate) fn load(self, ranks: &CommandRanks, signals: &Signals, quiet: bool) -> Result<Case, Failure> {
        let mut overrides = self.overrides;
        overrides.extend(self.seed.map(|seed| format!("friction.seed={seed}")));
        // Without a file every key has its default. Errors then refer to keys and `--set`, not to lines of a
        // file that the user has not written.
        let (text, file, name) = match &self.case {
            None => (String::new(), BASELINE, BASELINE),
            Some(path) if path == Path::new("-") => (read_stdin(ranks)?, STDIN, "stdin"),
            Some(path) => {
                let case = make_case(ranks, signals, quiet, |watch, ranks| {
                    Case::load(path, &overrides, watch, ranks)
                })?;
                let name = name_in_results(path).unwrap_or_else(|| case.name.clone());
                return Ok(Case { name, ..case });
            }
        };
        make_case(ranks, signals, quiet, |watch, ranks| {
            let file = ranks.agree(CaseFile::parse(&text, file, &overrides))?;
            Case::to_run(file, name, Path::new(""), watch, ranks)
        })
    }
}

/// Name of the results folder that contains this case: all such folders call their copy `case.toml`.
fn name_in_results(case: &Path) -> Option<String> {
    let folder = folder_of(case);
    let is_results = || {
        let marks = [MANIFEST, UNFINISHED, CHECKSUMS];
        marks.iter().any(|mark| folder.join(mark).exists())
    };
    (case.ends_with(CASE) && is_results()).then(|| folder_name(folder))?
}

/// Reads the text of a case from standard input, which several ranks cannot share.
fn read_stdin(ranks: &CommandRanks) -> Result<String, Failure> {
    if ranks.size() > 1 {
        return Err(Failure::input(
            "ranks have no common standard input: give a case file instead of -",
        ));
    }
    read_text_from(std::io::stdin().lock(), Path::new(STDIN)).map_err(Failure::input)
}
