//! `slipfront paper`: computes the figures of the paper and checks its claims.

use std::path::{Path, PathBuf};

use clap::Args;
use slipfront_base::disk::{is_empty, make_folders};
use slipfront_base::number_format::are;
use slipfront_paper::{PaperError, PaperOptions};
use slipfront_study::project_folder::ResultFiles;
use slipfront_study::{RunJournal, is_study};

use crate::failure::Failure;
use crate::print::print_message;
use crate::progress::display::ProgressDisplay;
use crate::progress::paper::{PAPER_BAR, show_paper};
use crate::runs_args::ForceArg;
use crate::signals::Signals;
use crate::threads::{count_from_one, set_worker_threads};

/// Reproduce the figures and tables of the paper
///
/// Tests the claims of the paper one by one
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront paper                     everything: figures, claims.csv and report.html in results/paper
  slipfront paper fig12 fig15         two figures and the claims about them
  slipfront paper --docs docs/validation   also writes the claims table of the documentation")]
pub(crate) struct PaperCommand {
    /// Figures: fig1 ... fig18, table1, sensitivity, or all; figures already finished in the folder are
    /// always reported
    #[arg(value_name = "FIGURE")]
    figures: Vec<String>,
    /// Folder for the results; figures that an earlier call finished there are not run again
    #[arg(short, long, value_name = "DIR", default_value = "results/paper")]
    out: PathBuf,
    #[command(flatten)]
    force: ForceArg,
    /// Maximum number of runs at a time [default: one per core]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = count_from_one)]
    threads: Option<u16>,
    /// Do not print progress and claims
    #[arg(short, long)]
    quiet: bool,
    /// Write paper.md and its pictures to this folder, in addition to --out
    #[arg(long, value_name = "DIR")]
    docs: Option<PathBuf>,
    /// Two random surfaces in place of five, one time step, and only the claims that survive that
    #[arg(long, hide = true)]
    reduced: bool,
}

impl PaperCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let threads = set_worker_threads(self.threads, 1)?;
        let figures = slipfront_paper::figures(&self.figures).map_err(Failure::input)?;
        refuse_foreign_docs(self.docs.as_deref().and_then(slipfront_paper::foreign_docs))?;
        let records = open(&self.out)?;
        let files = ResultFiles::new(&self.out, "paper", self.force.given);
        files.expect_unedited().map_err(Failure::input)?;
        let signals = Signals::catch().map_err(Failure::running)?;
        let options = PaperOptions {
            threads,
            stop: &signals.stop,
            reduced: self.reduced,
            folder: &self.out,
        };
        let progress = ProgressDisplay::with_bar(PAPER_BAR, self.quiet);
        let done = slipfront_paper::run(&figures, &records, &options, &|stage| {
            show_paper(&progress, stage);
        });
        progress.finish();
        let paper = done.map_err(|error| {
            if error.is_interruption() {
                Failure::stopped(&signals, error)
            } else {
                Failure::running(error)
            }
        })?;
        let sources = slipfront_paper::sources(&self.out, &records).map_err(Failure::running)?;
        slipfront_paper::write(&paper, &files, sources).map_err(|error| match error {
            PaperError::Study(error) => Failure::from_results(&signals, error),
            error => Failure::running(error),
        })?;
        if let Some(docs) = &self.docs {
            slipfront_paper::write_docs(&paper, docs).map_err(Failure::running)?;
        }
        if !self.quiet {
            print_message(&slipfront_paper::summary(&paper));
            print_message(&format!("{}\n", self.out.join("report.html").display()));
        }
        match paper.unexpected_verdicts().count() {
            0 => Ok(()),
            unexpected => Err(Failure::running(format!(
                "{} not as expected: see {}",
                are(unexpected, "verdict"),
                self.out.join("claims.csv").display()
            ))),
        }
    }
}

/// Refuses to replace a page that was not written by an earlier call.
pub(super) fn refuse_foreign_docs(page: Option<PathBuf>) -> Result<(), Failure> {
    let Some(page) = page else { return Ok(()) };
    Err(Failure::input(format!(
        "{} was not written by an earlier call: move it away, or choose another folder with --docs",
        page.display()
    )))
}

/// Opens the records of an earlier call, or creates them in an empty folder.
fn open(folder: &Path) -> Result<RunJournal, Failure> {
    let unusable = |error: std::io::Error| {
        Failure::input(format!(
            "cannot use the folder {}: {error}; choose another with --out",
            folder.display()
        ))
    };
    make_folders(folder).map_err(unusable)?;
    let used = folder.join(RunJournal::FILE).exists() && !is_study(folder);
    if !used && !is_empty(folder).map_err(unusable)? {
        let sentence = "contains files other than figures of the paper: choose another with --out";
        return Err(Failure::input(format!(
            "the folder {} {sentence}",
            folder.display()
        )));
    }
    RunJournal::open(folder).map_err(Failure::input)
}
