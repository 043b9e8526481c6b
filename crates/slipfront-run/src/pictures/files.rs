//! The files of a run from which pictures are drawn.

use std::fs::Metadata;
use std::path::Path;

use slipfront_base::disk::found_behind;
use slipfront_case::case_file::{CaseFile, read_text_from};

use super::error::RunPictureError;
use crate::folder_error::FolderError;
use crate::names::{CASE, FIELDS, KYMOGRAPH, SERIES, SUMMARY};
use crate::observers::tables;
use crate::run_files::RunFiles;

/// Whether pictures are drawn from the file of this name.
pub fn is_drawn_from(name: &str) -> bool {
    [CASE, SUMMARY, SERIES, KYMOGRAPH, FIELDS].contains(&name) || tables().any(|table| table.file == name)
}

/// A file of a folder that a run may not have written.
pub(super) fn found(path: &Path) -> Result<Option<Metadata>, RunPictureError> {
    Ok(found_behind(path).map_err(FolderError::read(path))?)
}

/// The case of a run; none if it is missing, because pictures can also be drawn without it.
pub(super) fn case_of(run: RunFiles) -> Result<Option<CaseFile>, RunPictureError> {
    let Some(file) = run.found(CASE)? else {
        return Ok(None);
    };
    let path = file.path();
    let (bytes, _) = file.open().map_err(FolderError::read(path))?;
    let text = read_text_from(bytes, path)?;
    Ok(Some(CaseFile::parse(&text, &path.display().to_string(), &[])?))
}
