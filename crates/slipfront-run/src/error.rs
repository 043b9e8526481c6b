//! Errors of the results of a run.

use std::path::PathBuf;

use slipfront_base::text;
use slipfront_case::case_file::CaseError;
use thiserror::Error;

use crate::fields::FieldsError;
use crate::folder_error::FolderError;

/// An error of results.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum ResultsError {
    #[error(transparent)]
    Folder(#[from] FolderError),
    #[error(transparent)]
    Case(#[from] CaseError),
    #[error(transparent)]
    Fields(#[from] FieldsError),
    #[error("cannot write series.csv: {0}")]
    Csv(#[from] csv::Error),
    #[error("{path} is not the summary of a slipfront run: {}", text::single_line(&source.to_string()))]
    Summary {
        path: PathBuf,
        source: serde_json::Error,
    },
}
