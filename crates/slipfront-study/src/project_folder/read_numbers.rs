//! Reads numbers that a report has written to a results folder.

use std::path::Path;

use serde::de::DeserializeOwned;
use slipfront_base::disk::{TEXT_MAX_BYTES, read_limited};
use slipfront_run::folder_error::FolderError;

use crate::error::StudyError;

/// Reads the part of a JSON file that `T` describes.
///
/// # Errors
/// When the file cannot be read, or lacks this part.
pub fn read_numbers<T: DeserializeOwned>(path: &Path) -> Result<T, StudyError> {
    let failed = FolderError::read(path);
    let bytes = read_limited(path, TEXT_MAX_BYTES).map_err(&failed)?;
    Ok(serde_json::from_slice(&bytes).map_err(|error| failed(error.into()))?)
}
