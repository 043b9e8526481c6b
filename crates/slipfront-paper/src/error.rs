//! What can go wrong with the paper.

use slipfront::RunError;
use thiserror::Error;

use slipfront_case::case_file::CaseError;
use slipfront_plot::PictureError;
use slipfront_run::run_folder::error::FolderError;
use slipfront_run::study::StudyError;

/// A paper that could not be gone through.
#[derive(Debug, Error)]
pub enum PaperError {
    /// A figure that the paper does not have.
    #[error("the paper has no `{given}`: take {known}, or all")]
    Figure {
        /// What was asked for.
        given: String,
        /// What there is.
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
    /// Something that a figure needs did not come about in a run.
    #[error("{file} gave no {what}")]
    Lacks {
        /// The case or study.
        file: String,
        /// What is missing.
        what: String,
    },
    /// A file of `cases/paper/`.
    #[error("a file of cases/paper cannot be read: {0}")]
    Text(#[from] toml::de::Error),
    /// A claim about something that no figure measures.
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
        /// What is wrong with it.
        source: PictureError,
    },
    /// A table could not be put into words.
    #[error("cannot write a table: {0}")]
    Table(#[from] csv::Error),
    /// A file of the results folder.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

impl PaperError {
    /// Whether a signal asked to stop, and everything finished is safe.
    pub fn is_interruption(&self) -> bool {
        matches!(self, Self::Study(StudyError::Interrupted))
    }
}
