//! Command `slipfront export`: complete results for a data repository, and their citations.

use std::path::PathBuf;

use clap::Args;
use slipfront_calibrate::CALIBRATIONS;
use slipfront_design::DESIGNS;
use slipfront_run::export::{Attribution, Author, ExportError, Licence, bibtex, cff, write_crate};
use slipfront_study::{StudyError, exported};

use crate::failure::Failure;
use crate::print::{print, print_message};
use crate::signals::Signals;
use crate::wrap::notes;

/// Export results to a data repository, or print their citations
///
/// Runs, studies, convergences, designs and calibrations are exported as an RO-Crate
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront export results/circle --ro-crate --author \"NAME\" --licence CC-BY-4.0
  slipfront export results/first --ro-crate        a study: its file, tables, pictures and runs
  slipfront export results/circle results/first --ro-crate -o both    several folders as one crate
  slipfront export results/circle --bibtex > circle.bib
  slipfront export results/circle --cff --author \"NAME\" > CITATION.cff

Only complete and unchanged folders are exported, as checked by `slipfront verify --checksums`.")]
pub(crate) struct ExportCommand {
    /// Folders of complete results of runs, studies, convergences, designs or calibrations
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,
    #[command(flatten)]
    form: Form,
    /// Author of the results: a name, or "NAME <https://orcid.org/0000-0000-0000-0000>"
    #[arg(long, value_name = "NAME")]
    author: Option<Author>,
    /// Licence of the results: an SPDX identifier such as CC-BY-4.0, or an address
    #[arg(long, value_name = "ID")]
    licence: Option<Licence>,
    /// New folder for the crate; the results folders are copied to it [default: the results folder itself, if
    /// there is only one]
    #[arg(short, long, value_name = "DIR", conflicts_with_all = ["bibtex", "cff"])]
    out: Option<PathBuf>,
    /// Replace an existing description in the results folder
    #[arg(long, conflicts_with_all = ["out", "bibtex", "cff"])]
    force: bool,
}

/// Form in which results are exported.
#[derive(Args)]
#[group(required = true, multiple = false)]
struct Form {
    /// Write ro-crate-metadata.json, which makes the folder a Process Run Crate
    #[arg(long)]
    ro_crate: bool,
    /// Print BibTeX entries for each folder of results, slipfront and the article on its model
    #[arg(long)]
    bibtex: bool,
    /// Print a citation file, CITATION.cff; requires --author
    #[arg(long)]
    cff: bool,
}

impl ExportCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let by = Attribution {
            author: self.author,
            licence: self.licence,
        };
        let results = self.folders.iter().map(|folder| {
            exported(folder, &[DESIGNS, CALIBRATIONS]).map_err(|error| match error {
                StudyError::Export(error) => failure(error),
                error => Failure::input(error),
            })
        });
        let results = results.collect::<Result<Vec<_>, _>>()?;
        if self.form.bibtex {
            return print(&bibtex(&results, &by));
        }
        if self.form.cff {
            return print(&cff(&results, &by).map_err(failure)?);
        }
        let signals = Signals::catch().map_err(Failure::running)?;
        let path = write_crate(&results, self.out.as_deref(), &by, self.force, &signals.stop);
        let path = path.map_err(|error| match error {
            ExportError::Interrupted => Failure::stopped(&signals, error),
            error => failure(error),
        })?;
        print_message(&format!("{}\n", path.display()));
        print_message(&notes(by.notes()));
        Ok(())
    }
}

/// Changed results and disks that cannot be written are failures of the work; all other errors are errors of
/// the input.
fn failure(error: ExportError) -> Failure {
    match error {
        ExportError::Changed { .. } | ExportError::Write { .. } => Failure::running(error),
        error => Failure::input(error),
    }
}
