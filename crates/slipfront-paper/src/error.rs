//! Errors of `slipfront paper`.

use slipfront::RunError;
use thiserror::Error;

use slipfront_case::case_file::CaseError;
use slipfront_plot::PictureError;
use slipfront_run::run_folder::error::FolderError;
use slipfront_run::study::StudyError;

/// Why the figures could not be run or the report not be written.
#[derive(Debug, Error)]
pub enum PaperError {
    /// A figure that the paper does not have.
    #[error("the paper has no `{given}`: take {known}, or all")]
    Figure {
        /// The given name.
        given: String,
        /// The names of all figures.
        known: String,
    },
    /// A case file.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// A study file, its records, or a signal to stop.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A run.
    #[error("the run {name} failed: {source}")]
    Run {
        /// Its name.
        name: String,
        /// Why.
        source: RunError,
    },
    /// A run of a study.
    #[error("a run of {study} failed: {reason}")]
    StudyRun {
        /// Name of the study.
        study: String,
        /// Why.
        reason: String,
    },
    /// A run lacks something that a figure needs.
    #[error("{file} gave no {what}")]
    Lacks {
        /// The case or study.
        file: String,
        /// What is missing.
        what: String,
    },
    /// A case file, study file or the list of claims in this crate.
    #[error("a file of the paper's cases cannot be read: {0}")]
    Text(#[from] toml::de::Error),
    /// A claim about a number that no figure measures.
    #[error("claim {number} is about `{quantity}`, which is not measured")]
    Unmeasured {
        /// Number of the claim.
        number: u32,
        /// Its quantity.
        quantity: String,
    },
    /// A picture.
    #[error("cannot draw {name}: {source}")]
    Picture {
        /// Its name.
        name: String,
        /// The reason.
        source: PictureError,
    },
    /// A table could not be written as CSV.
    #[error("cannot write a table: {0}")]
    Table(#[from] csv::Error),
    /// A file of the results folder.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

impl PaperError {
    /// Whether a signal asked to stop. Finished runs of studies and finished figures are stored then.
    pub fn is_interruption(&self) -> bool {
        matches!(self, Self::Study(StudyError::Interrupted))
    }
}
