//! Errors of `slipfront family`.

use slipfront::{RunError, SurfaceError};
use slipfront_case::case_file::CaseError;
use slipfront_plot::PictureError;
use slipfront_run::folder_error::FolderError;
use thiserror::Error;

/// Reason why a chapter could not be computed, or its page could not be written.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum FamilyError {
    #[error(transparent)]
    Case(#[from] CaseError),
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    #[error("the run {name} failed: {source}")]
    Run { name: String, source: RunError },
    #[error("cannot draw {name}: {source}")]
    Picture { name: String, source: PictureError },
    #[error(transparent)]
    Folder(#[from] FolderError),
}

impl FamilyError {
    /// Turns the error of a run into one with its name.
    pub(crate) fn of_run(name: &str) -> impl FnOnce(RunError) -> Self {
        let name = name.to_owned();
        |source| Self::Run { name, source }
    }
}
