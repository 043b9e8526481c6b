//! The content of a run folder: read once, and passed on to the code that needs it.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use slipfront_base::disk::{TEXT_MAX_BYTES, open_limited};
use slipfront_case::case_file::{CaseError, CaseFile, read_text};

use super::contents::{is_as_listed, managed_bytes};
use super::unfinished::Unfinished;
use crate::folder_error::FolderError;
use crate::manifest::{Manifest, ManifestError, ManifestFile};
use crate::names::{CASE, MANIFEST, UNFINISHED};

/// A folder that may be a run folder, as it was found.
#[derive(Debug)]
pub struct Inspection {
    /// The folder.
    pub path: PathBuf,
    /// Owner and state of the folder.
    pub contents: Contents,
    /// The folder's `case.toml`.
    pub case: Result<CaseFile, CaseDefect>,
}

/// Owner and state of a folder.
#[derive(Debug)]
pub enum Contents {
    /// A free folder: it does not exist, or holds only what a run leaves that was killed before it wrote its
    /// case.
    Empty,
    /// A folder of somebody else.
    Foreign,
    /// The folder of a run which is not complete: it has a resolved case, and no manifest.
    Interrupted,
    /// The folder of a run which was completed: it has a manifest.
    Complete(Result<Box<Manifest>, ManifestError>),
}

/// Reason why the case in a folder was not written by a run.
#[derive(Debug)]
pub enum CaseDefect {
    /// The case cannot be read.
    Unreadable(std::io::Error),
    /// The file is not a case.
    Invalid(CaseError),
    /// The file is a case, but not a resolved one, byte for byte.
    NotResolved(Box<CaseFile>),
}

impl Inspection {
    /// Reads the case and the manifest of a folder.
    ///
    /// # Errors
    /// When the folder cannot be listed, or the system cannot determine what it holds.
    pub fn read(folder: &Path) -> Result<Self, FolderError> {
        let is_unused = is_unused(folder)?;
        let case = read_case(folder);
        let manifest = Manifest::read(folder);
        let contents = match manifest {
            _ if is_unused => Contents::Empty,
            Err(ManifestError::Missing { .. }) if case.is_ok() => Contents::Interrupted,
            Err(ManifestError::Missing { .. }) => Contents::Foreign,
            manifest => Contents::Complete(manifest.map(Box::new)),
        };
        Ok(Self {
            path: folder.to_owned(),
            contents,
            case,
        })
    }

    /// The manifest of a run that is complete, if it is unchanged.
    pub fn manifest(&self) -> Result<&Manifest, ManifestError> {
        match &self.contents {
            Contents::Complete(manifest) => manifest.as_deref().map_err(Clone::clone),
            Contents::Empty | Contents::Foreign | Contents::Interrupted => Err(ManifestError::Missing {
                path: self.path.clone(),
            }),
        }
    }

    /// The case of a run that can be resumed, or is complete.
    pub fn case_to_resume(&self) -> Result<&CaseFile, FolderError> {
        let path = self.path.clone();
        let defect = match &self.case {
            Ok(case) => return Ok(case),
            Err(defect) => defect,
        };
        let unread = match defect {
            CaseDefect::Unreadable(error)
            | CaseDefect::Invalid(CaseError::Unreadable { source: error, .. }) => Some(error),
            CaseDefect::Invalid(_) | CaseDefect::NotResolved(_) => None,
        };
        let why = match unread.map(std::io::Error::kind) {
            Some(ErrorKind::NotFound) if path.exists() => {
                "it has no case.toml; start the run again in this folder with --force"
            }
            Some(ErrorKind::NotFound) => "it does not exist; start the run again",
            Some(ErrorKind::NotADirectory) => "it is a file: give its folder",
            None => {
                "its case.toml was changed, or was written by another version; restore it, or run it in another folder"
            }
            Some(kind) => {
                let sentence = unread.map(ToString::to_string).unwrap_or_default();
                let error = std::io::Error::new(kind, sentence);
                return Err(FolderError::read(&path.join(CASE))(error));
            }
        };
        Err(FolderError::NoRun { path, why })
    }

    /// Every file that slipfront has written in the folder, from the manifest and the journal of a run that
    /// is not complete.
    pub(super) fn listed(&self) -> Result<Vec<ManifestFile>, FolderError> {
        let mut listed = Unfinished::in_folder(&self.path).listed()?;
        if let Contents::Complete(Ok(manifest)) = &self.contents {
            let itself = ManifestFile::read(&self.path, MANIFEST);
            listed.push(itself.map_err(FolderError::read(&self.path.join(MANIFEST)))?);
            listed.extend_from_slice(&manifest.files);
        }
        Ok(listed)
    }

    /// Whether the folder has a file of this name that is unchanged since slipfront wrote it.
    pub fn has_written(&self, name: &str) -> Result<bool, FolderError> {
        let listed = self.listed()?;
        is_as_listed(&self.path, name, &listed).map_err(FolderError::read(&self.path.join(name)))
    }

    /// Bytes that become free when the files of the run in the folder are removed.
    pub fn managed_bytes(&self) -> Result<u64, FolderError> {
        managed_bytes(&self.path, &self.listed()?)
    }
}

/// The case in a folder if it is a resolved one. Another case was not written by a run, and the files that it
/// names may have no other copy.
fn read_case(folder: &Path) -> Result<CaseFile, CaseDefect> {
    let path = folder.join(CASE);
    // A user may pass a case through a pipe, but in a folder of results a pipe would block.
    open_limited(&path, TEXT_MAX_BYTES).map_err(CaseDefect::Unreadable)?;
    let text = read_text(&path).map_err(CaseDefect::Invalid)?;
    let case = CaseFile::parse(&text, &path.display().to_string(), &[]).map_err(CaseDefect::Invalid)?;
    match case.to_toml() {
        Ok(resolved) if resolved == text => Ok(case),
        Ok(_) => Err(CaseDefect::NotResolved(Box::new(case))),
        Err(error) => Err(CaseDefect::Invalid(error)),
    }
}

/// Whether there is no folder, or it holds only a hidden subfolder of slipfront without a checkpoint.
fn is_unused(folder: &Path) -> Result<bool, FolderError> {
    let read = FolderError::read(folder);
    let entries = match std::fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if [ErrorKind::NotFound, ErrorKind::NotADirectory].contains(&error.kind()) => {
            return Ok(true);
        }
        Err(error) => return Err(read(error)),
    };
    let unfinished = Unfinished::in_folder(folder);
    for entry in entries {
        let is_hidden = entry.map_err(&read)?.file_name() == UNFINISHED;
        if !is_hidden || !unfinished.is_managed()? || unfinished.has_checkpoint()? {
            return Ok(false);
        }
    }
    Ok(true)
}
