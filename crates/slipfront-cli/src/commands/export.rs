//! Command `slipfront export`: complete runs for a data repository, and their citations.

use std::path::PathBuf;

use clap::Args;
use slipfront_run::export::{Attribution, Author, ExportError, Licence, WholeRun, bibtex, cff, write_crate};

use crate::failure::Failure;
use crate::print::{print, print_message};
use crate::signals::Signals;
use crate::wrap;

/// Export runs to a data repository, or print their citations
///
/// The description of the runs is an RO-Crate
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront export results/circle --ro-crate --author \"NAME\" --licence CC-BY-4.0
  slipfront export results/first/runs/* --ro-crate -o first-as-crate     several runs as one crate
  slipfront export results/circle --bibtex > circle.bib
  slipfront export results/circle --cff --author \"NAME\" > CITATION.cff

Only runs that `slipfront verify` finds as they were written are exported.")]
pub(crate) struct ExportCommand {
    /// Folders of complete runs
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,
    #[command(flatten)]
    form: Form,
    /// Who made the runs: a name, or "NAME <https://orcid.org/0000-0000-0000-0000>"
    #[arg(long, value_name = "NAME")]
    author: Option<Author>,
    /// Licence of the results: an identifier of SPDX such as CC-BY-4.0, or an address
    #[arg(long, value_name = "ID")]
    licence: Option<Licence>,
    /// A new folder for the crate, to which the runs are copied [default: the folder of the run itself, of
    /// one run]
    #[arg(short, long, value_name = "DIR", conflicts_with_all = ["bibtex", "cff"])]
    out: Option<PathBuf>,
    /// Replace a description that stands in the folder of the run
    #[arg(long, conflicts_with_all = ["out", "bibtex", "cff"])]
    force: bool,
}

/// Form in which the runs are exported.
#[derive(Args)]
#[group(required = true, multiple = false)]
struct Form {
    /// Write ro-crate-metadata.json, with which the folder is a Process Run Crate
    #[arg(long)]
    ro_crate: bool,
    /// Print entries of BibTeX: each run, slipfront and the article of its model
    #[arg(long)]
    bibtex: bool,
    /// Print a citation file, CITATION.cff; it needs --author
    #[arg(long)]
    cff: bool,
}

impl ExportCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let by = Attribution {
            author: self.author,
            licence: self.licence,
        };
        let runs = self.folders.iter().map(|folder| WholeRun::read(folder));
        let runs = runs.collect::<Result<Vec<_>, _>>().map_err(failure)?;
        if self.form.bibtex {
            return print(&bibtex(&runs, &by));
        }
        if self.form.cff {
            return print(&cff(&runs, &by).map_err(failure)?);
        }
        let signals = Signals::catch().map_err(Failure::running)?;
        let path = write_crate(&runs, self.out.as_deref(), &by, self.force, &signals.stop);
        let path = path.map_err(|error| match error {
            ExportError::Interrupted => Failure::stopped(&signals, error),
            error => failure(error),
        })?;
        print_message(&format!("{}\n", path.display()));
        for note in by.notes() {
            print_message(&wrap::note(note));
        }
        Ok(())
    }
}

/// A change of the results, or a disk that cannot be written, is a failure of the work; all else is one of
/// the input.
fn failure(error: ExportError) -> Failure {
    if matches!(error, ExportError::Changed { .. } | ExportError::Write { .. }) {
        Failure::running(error)
    } else {
        Failure::input(error)
    }
}
