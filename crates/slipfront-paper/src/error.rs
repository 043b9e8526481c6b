//! Errors of `slipfront paper`.

use slipfront::RunError;
use thiserror::Error;

use slipfront_case::case_file::CaseError;
use slipfront_plot::PictureError;
use slipfront_run::folder_error::FolderError;
use slipfront_study::StudyError;

/// Reason why the figures could not be run or the report could not be written.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the error sentence describes each variant")]
pub enum PaperError {
    #[error("the paper has no `{given}`: choose {known}, or all")]
    Figure { given: String, known: String },
    #[error(transparent)]
    Case(#[from] CaseError),
    #[error(transparent)]
    Study(#[from] StudyError),
    #[error("the run {name} failed: {source}")]
    Run { name: String, source: RunError },
    #[error("a run of {study} failed: {reason}")]
    StudyRun { study: String, reason: String },
    #[error("the run of {file} produced no {what}")]
    Lacks { file: String, what: String },
    #[error("a case file of the paper cannot be read: {0}")]
    Text(#[from] toml::de::Error),
    #[error("claim {number} needs `{quantity}`, which no figure measures")]
    Unmeasured { number: u32, quantity: String },
    #[error("cannot draw {name}: {source}")]
    Picture { name: String, source: PictureError },
    #[error("cannot write a table: {0}")]
    Table(#[from] csv::Error),
    #[error(transparent)]
    Folder(#[from] FolderError),
}

impl PaperError {
    /// Whether a signal asked to stop. Finished runs of studies and finished figures are stored then.
    pub fn is_interruption(&self) -> bool {
        matches!(self, Self::Study(StudyError::Interrupted))
    }
}
