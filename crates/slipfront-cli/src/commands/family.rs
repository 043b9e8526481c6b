//! `slipfront family`: compares the options of the engine with exact answers.

use std::path::PathBuf;

use clap::Args;
use slipfront_base::number_format::are;

use super::paper::refuse_foreign_docs;
use crate::failure::Failure;
use crate::print::print_message;
use crate::signals::Signals;
use crate::threads::{count_from_one, set_worker_threads};

/// Compare every law and option with an exact solution, and benchmarks of rupture with their reference
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront family                         one line per option and benchmark
  slipfront family --docs docs/validation   the pages of the documentation, with pictures")]
pub(crate) struct FamilyCommand {
    /// Write family.md, rupture.md and their pictures to this folder; with --long also transition.md
    #[arg(long, value_name = "DIR")]
    docs: Option<PathBuf>,
    /// Add the benchmark of fronts faster than shear waves, which takes half an hour or more
    #[arg(long)]
    long: bool,
    /// Maximum number of runs at a time [default: one per core]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = count_from_one)]
    threads: Option<u16>,
}

impl FamilyCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        set_worker_threads(self.threads, 1)?;
        refuse_foreign_docs(self.docs.as_deref().and_then(slipfront_family::foreign_docs))?;
        let books = slipfront_family::books(self.long).map_err(Failure::running)?;
        print_message(&slipfront_family::summary(&books));
        if let Some(docs) = &self.docs {
            // A signal leaves neither half a page nor a hidden file.
            Signals::catch().map_err(Failure::running)?;
            slipfront_family::write_docs(&books, docs).map_err(Failure::running)?;
        }
        let chapters = books.iter().flat_map(|book| &book.chapters);
        let answers = chapters.flat_map(|chapter| &chapter.answers);
        match answers.filter(|answer| !answer.holds()).count() {
            0 => Ok(()),
            missed => Err(Failure::running(format!(
                "{} out of tolerance",
                are(missed, "answer")
            ))),
        }
    }
}
