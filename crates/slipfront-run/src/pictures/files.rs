//! The files of a run folder from which pictures are drawn.

use std::fs::Metadata;
use std::path::Path;

use slipfront_case::case_file::CaseFile;
use slipfront_case::disk::found_behind;

use super::error::RunPictureError;
use crate::folder_error::FolderError;
use crate::names::{CASE, FIELDS, KYMOGRAPH, PRECURSORS, SERIES, SUMMARY};

/// The files from which pictures are drawn.
pub const DRAWN_FROM: [&str; 6] = [CASE, SUMMARY, SERIES, PRECURSORS, KYMOGRAPH, FIELDS];

/// A file that a run may not have written.
pub(super) fn found(path: &Path) -> Result<Option<Metadata>, RunPictureError> {
    Ok(found_behind(path).map_err(FolderError::read(path))?)
}

/// The case of a run folder; none for files that have lost theirs, which can be drawn as well.
pub(super) fn case_of(folder: &Path) -> Result<Option<CaseFile>, RunPictureError> {
    let path = folder.join(CASE);
    let case = found(&path)?.map(|_| CaseFile::load(&path, &[]));
    Ok(case.transpose()?)
}
