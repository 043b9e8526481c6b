//! The case with which the laboratory starts.

use std::path::{Path, PathBuf};

use slipfront_case::case_file::CaseError;
use slipfront_session::Document;

use crate::{files, replay};

/// The case or run that the page shows first.
#[derive(Default)]
pub enum Start {
    /// The preset with which the page opens by default.
    #[default]
    Preset,
    /// A case of the user, as a document.
    Case(Box<Document>),
    /// The folder of a recorded run.
    Folder(PathBuf),
}

/// The reason why the laboratory cannot start with a case: a sentence.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct OpeningError(String);

impl Start {
    /// Reads the case of a file, or of the folder of a complete run, with the files that it names in its own
    /// folder or in an allowed one.
    ///
    /// # Errors
    /// When there is no such case or run, or it cannot be shown, or names a file elsewhere.
    pub fn read(path: &Path, allow_files: &[PathBuf]) -> Result<Self, OpeningError> {
        let refused = |error: CaseError| OpeningError(error.to_string());
        if path.is_dir() {
            let opened = replay::read(path, allow_files).map_err(OpeningError)?;
            opened.document.case_to_show(&mut |_| true).map_err(refused)?;
            return Ok(Self::Folder(path.to_owned()));
        }
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let document = files::document(path, &name, allow_files).map_err(refused)?;
        document.case_to_show(&mut |_| true).map_err(refused)?;
        Ok(Self::Case(Box::new(document)))
    }
}
