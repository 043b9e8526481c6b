//! The hidden subfolder of a run folder, which holds everything that belongs to a run which is not complete:
//! its journal, temporary files that are being written, and checkpoints. It is removed when the run is
//! complete.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use slipfront_base::disk::{found_at, is_empty, is_folder, remove_if_there, sync_folder};

use super::journal::{self, Journal};
use crate::folder_error::FolderError;
use crate::manifest::ManifestFile;
use crate::names::{CHECKPOINT, JOURNAL, PREVIOUS, TEMPORARY, UNFINISHED};

/// The hidden subfolder of a run folder, whether it exists or not.
#[derive(Clone, Debug)]
pub struct Unfinished {
    path: PathBuf,
}

impl Unfinished {
    /// The hidden subfolder of a run folder.
    pub fn in_folder(run: &Path) -> Self {
        let path = run.join(UNFINISHED);
        Self { path }
    }

    /// The subfolder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The folder of temporary files.
    pub fn temporary(&self) -> PathBuf {
        self.path.join(TEMPORARY)
    }

    /// Whether slipfront made the subfolder: the subfolder holds a journal, or nothing yet. A link is never
    /// slipfront's.
    ///
    /// # Errors
    /// When the system cannot determine this.
    pub fn is_managed(&self) -> Result<bool, FolderError> {
        let read = FolderError::read(&self.path);
        if !is_folder(&self.path).map_err(&read)? {
            return Ok(false);
        }
        Ok(self.has_journal()? || is_empty(&self.path).map_err(&read)?)
    }

    fn has_journal(&self) -> Result<bool, FolderError> {
        let path = self.journal();
        let journal = found_at(&path).map_err(FolderError::read(&path))?;
        Ok(journal.is_some_and(|journal| journal.is_file()))
    }

    /// Whether a checkpoint was saved.
    ///
    /// # Errors
    /// When the system cannot determine this.
    pub fn has_checkpoint(&self) -> Result<bool, FolderError> {
        for path in [CHECKPOINT, PREVIOUS].map(|name| self.path.join(name)) {
            if found_at(&path).map_err(FolderError::read(&path))?.is_some() {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Creates the subfolder if it does not exist; an error if a link or a file is in its place.
    pub fn create(&self) -> Result<Journal, FolderError> {
        let run = self.path.parent().unwrap_or(&self.path);
        make_folder(&self.path, run)?;
        let path = self.journal();
        let journal = Journal::open(&path).map_err(FolderError::write(&path))?;
        // Files that the journal lists must not survive a power failure without it, even if a killed process
        // has created the journal.
        for folder in [&self.path, run] {
            sync_folder(folder).map_err(FolderError::write(folder))?;
        }
        let temporary = self.temporary();
        make_folder(&temporary, &temporary)?;
        Ok(journal)
    }

    fn journal(&self) -> PathBuf {
        self.path.join(JOURNAL)
    }

    /// The files that the run has finished; none if the subfolder is not slipfront's.
    pub(super) fn listed(&self) -> Result<Vec<ManifestFile>, FolderError> {
        let path = self.journal();
        if !self.is_managed()? || !self.has_journal()? {
            return Ok(Vec::new());
        }
        journal::read(&path).map_err(FolderError::read(&path))
    }

    /// Files that may be in the subfolder in addition to the journal, as paths in the run folder; none if the
    /// subfolder is not slipfront's.
    pub(super) fn managed_files(&self) -> Result<Vec<String>, FolderError> {
        if !self.is_managed()? {
            return Ok(Vec::new());
        }
        let temporary = self.temporary();
        let temporary = names_in(&temporary).map_err(FolderError::read(&temporary))?;
        let temporary = temporary.into_iter().map(|name| format!("{TEMPORARY}/{name}"));
        let names = temporary.chain([CHECKPOINT, PREVIOUS].map(str::to_owned));
        Ok(names.map(|name| format!("{UNFINISHED}/{name}")).collect())
    }

    /// Removes the temporary files that a killed program left.
    pub(super) fn clear_temporary(&self) -> std::io::Result<()> {
        let folder = self.temporary();
        let mut names = names_in(&folder)?.into_iter();
        names.try_for_each(|name| remove_if_there(&folder.join(name)))
    }

    /// Removes the subfolder of a complete run. Foreign files stay, and then so does the subfolder.
    pub fn remove(&self) -> std::io::Result<()> {
        self.clear_temporary()?;
        for name in [CHECKPOINT, PREVIOUS] {
            remove_if_there(&self.path.join(name))?;
        }
        match std::fs::remove_dir(self.temporary()) {
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
            _ => {}
        }
        // Until here, the journal marks the other files as slipfront's. No power failure may restore them
        // without the journal.
        if self.has_journal().unwrap_or(true) {
            sync_folder(&self.path)?;
        }
        remove_if_there(&self.journal())?;
        let _ = std::fs::remove_dir(&self.path);
        Ok(())
    }
}

/// Makes a folder; an error names `path_in_error`.
fn make_folder(path: &Path, path_in_error: &Path) -> Result<(), FolderError> {
    match std::fs::create_dir(path) {
        Err(error) if error.kind() != ErrorKind::AlreadyExists => {
            Err(FolderError::unwritable(path_in_error)(error))
        }
        Err(_) if !is_folder(path).map_err(FolderError::read(path))? => {
            let path = path.to_owned();
            Err(FolderError::Foreign { path })
        }
        _ => Ok(()),
    }
}

/// Names of the entries of a folder except its subfolders; none if the folder is a link.
fn names_in(folder: &Path) -> std::io::Result<Vec<String>> {
    let mut names = Vec::new();
    if is_folder(folder)? {
        for entry in std::fs::read_dir(folder)? {
            let entry = entry?;
            if !entry.file_type()?.is_dir() {
                names.push(entry.file_name().to_string_lossy().into_owned());
            }
        }
    }
    Ok(names)
}
