//! Reasons why results are not exported.

use std::path::PathBuf;

use thiserror::Error;

use crate::verify::VerifyError;

/// Reason why results are not exported.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum ExportError {
    #[error(transparent)]
    Run(#[from] VerifyError),
    #[error("{difference}: only unchanged results can be exported; compute them again in another folder")]
    Changed { difference: String },
    #[error("{path} exists: replace it with --force, or write the crate to a new folder with --out")]
    Exists { path: PathBuf },
    #[error("the folder {path} is not empty: choose another with --out")]
    NotEmpty { path: PathBuf },
    #[error(
        "the command runs in the folder {path}, which would be replaced: give a folder inside it with --out"
    )]
    WorkedIn { path: PathBuf },
    #[error("stopped by a signal: nothing is written")]
    Interrupted,
    #[error("two of the folders have the same name {name}: rename one of them")]
    SameName { name: String },
    #[error("several folders are copied into one crate: give its folder with --out")]
    NeedsFolder,
    #[error("a citation file needs an author: add --author \"NAME\"")]
    NeedsAuthor,
    #[error("cannot write {path}: {source}; choose another folder with --out")]
    Write { path: PathBuf, source: std::io::Error },
}

impl ExportError {
    /// Refuses results with differences from what was written, and names the first.
    ///
    /// # Errors
    /// [`ExportError::Changed`] with the first difference.
    pub fn expect_none(differences: Vec<String>) -> Result<(), Self> {
        match differences.into_iter().next() {
            Some(difference) => Err(Self::Changed { difference }),
            None => Ok(()),
        }
    }
}
