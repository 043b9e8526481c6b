//! Kinds of projects, such as studies and designs, and their names for the files of a folder.

use std::path::Path;

use slipfront_base::disk::{folder_name, folder_of, is_empty, make_folders};
use slipfront_case::case_file::read_text;
use slipfront_run::folder_error::FolderError;

use super::checksums::Checksums;
use super::journal::Journal;
use super::line::JournalEntry;
use crate::error::StudyError;

/// A kind of project with a results folder.
#[derive(Debug)]
pub struct ProjectKind {
    /// Name of the kind in messages, such as `design`.
    pub name: &'static str,
    /// Name of the kind's own table in its files.
    pub table: &'static str,
    /// Name of the file in the folder from which the project is repeated.
    pub file: &'static str,
    /// Name of the journal of runs.
    pub journal: &'static str,
    /// Beginnings of the names of other files that the project is made from, with the meaning of these files.
    pub given: &'static [(&'static str, &'static str)],
    /// Beginnings of the names of result files, with the meaning of these files.
    pub found: &'static [(&'static str, &'static str)],
}

impl ProjectKind {
    /// Whether the folder is one of this kind.
    pub fn is_in(&self, folder: &Path) -> bool {
        folder.join(self.file).exists() && folder.join(self.journal).exists()
    }

    /// Whether the folder holds results of this kind, even if its file or its journal is gone.
    pub fn has_results_in(&self, folder: &Path) -> bool {
        self.is_in(folder) || Checksums::unsealed(folder).is_some_and(|list| list.of == self.name)
    }

    /// Loads a file of this kind by `parse`, which receives its text, its path, the name of the project, and
    /// the folder of the file. The name of the project is that of the file without the ending, or that of the
    /// folder if the file is the copy in a results folder.
    ///
    /// # Errors
    /// When the file cannot be read, or `parse` refuses its text.
    pub fn load<T>(
        &self,
        path: &Path,
        parse: impl FnOnce(&str, &str, &str, &Path) -> Result<T, StudyError>,
    ) -> Result<T, StudyError> {
        let text = read_text(path)?;
        let is_kept = path.ends_with(self.file) && self.is_in(folder_of(path));
        let kept = is_kept.then(|| folder_name(folder_of(path))).flatten();
        let stem = || Some(path.file_stem()?.to_string_lossy().into_owned());
        let name = kept.or_else(stem).unwrap_or_else(|| self.name.to_owned());
        let folder = path.parent().unwrap_or(Path::new(""));
        parse(&text, &path.display().to_string(), &name, folder)
    }

    /// Whether the folder has a journal of this kind. A folder without one must be new or empty.
    ///
    /// # Errors
    /// When the folder contains other things, or cannot be read.
    pub fn is_used(&self, folder: &Path) -> Result<bool, StudyError> {
        let is_used = folder.join(self.journal).exists();
        let is_free = || Ok(!folder.is_dir() || is_empty(folder)?);
        if is_used || is_free().map_err(FolderError::unwritable(folder))? {
            Ok(is_used)
        } else {
            Err(self.other_things(folder))
        }
    }

    /// The error for a folder that contains something other than a project of this kind.
    pub fn other_things(&self, folder: &Path) -> StudyError {
        StudyError::OtherThings {
            what: self.name,
            path: folder.to_owned(),
        }
    }

    /// Opens the journal in a folder, unless another process uses it, and creates the folder if it is
    /// missing. Returns the journal, its runs, and the number of its damaged lines.
    ///
    /// # Errors
    /// When another process has it open, when it is not a journal of this kind, or when the system refuses.
    pub fn open_journal<T: JournalEntry>(
        &self,
        folder: &Path,
    ) -> Result<(Journal, Vec<T>, usize), StudyError> {
        make_folders(folder).map_err(FolderError::unwritable(folder))?;
        Journal::open(folder, self.journal).map_err(|error| match error {
            StudyError::NotJournal { path } => FolderError::Foreign { path }.into(),
            error => error,
        })
    }
}
