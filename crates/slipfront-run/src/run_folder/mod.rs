//! The run folder: everything needed to read a run's results and to make them again.
//!
//! Files appear whole or not at all, and `manifest.json` comes last: where it stands, the run is complete.

pub mod contents;
pub mod error;
pub mod resume_command;

use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};

use slipfront::Model;
use slipfront_case::disk::{UNFINISHED, holds_only_unfinished, remove_unfinished, sync_folder, write_atomic};

use self::contents::{refuse_foreign, remove_checkpoints, remove_own, remove_results, resolved_case};
pub use self::error::FolderError;
use crate::manifest::Manifest;
use crate::names::{CASE, MANIFEST};
use slipfront_case::case::{Case, Input};

/// A folder that a run is being written to.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    /// Files of the run, and what is known to stand in them.
    written: Vec<(String, Option<blake3::Hash>)>,
    /// Whether this process has made it ready.
    new: bool,
    /// Held as long as the run goes on.
    _lock: Option<File>,
}

impl RunFolder {
    /// Makes the folder ready for a run that reads these `inputs`: it is created, or empty, or with `force` rid of the
    /// files of an earlier run (and of nothing else).
    ///
    /// # Errors
    /// When it holds something else, which includes foreign files in the place of the copies, or cannot be written.
    pub fn prepare(path: &Path, force: bool, inputs: &[Input]) -> Result<Self, FolderError> {
        let unwritable = |source| FolderError::Unwritable {
            path: path.to_owned(),
            source,
        };
        std::fs::create_dir_all(path).map_err(unwritable)?;
        let lock = lock(path)?;
        // A kill may have come before the case was written.
        if !holds_only_unfinished(path).map_err(unwritable)? {
            if !force {
                let path = path.to_owned();
                // A run that was begun, and neither completed nor removed.
                let interrupted = !path.join(MANIFEST).exists() && resolved_case(&path).is_some();
                return Err(if interrupted {
                    FolderError::Interrupted { path }
                } else {
                    FolderError::NotEmpty { path }
                });
            }
            let names = inputs.iter().map(|input| input.name.as_str());
            refuse_foreign(path, names)?;
            remove_own(path)?;
        }
        if lock.is_some() {
            remove_unfinished(path);
        }
        // A folder that cannot be written should say so before the run, not after it.
        tempfile::Builder::new()
            .prefix(UNFINISHED)
            .tempfile_in(path)
            .map_err(unwritable)?;
        Ok(Self {
            path: path.to_owned(),
            written: Vec::new(),
            new: true,
            _lock: lock,
        })
    }

    /// Takes over the folder of a run that has a case.
    ///
    /// # Errors
    /// When there is no such run, or another process goes on with it.
    pub fn reopen(path: &Path) -> Result<Self, FolderError> {
        if resolved_case(path).is_none() {
            let why = if !path.exists() {
                "there is none of this name"
            } else if !path.is_dir() {
                "it is a file: name its folder"
            } else if !path.join(CASE).exists() {
                "it has no case.toml"
            } else {
                "its case.toml is not as this version wrote it; put it back as it was, or run it to another folder"
            };
            let path = path.to_owned();
            return Err(FolderError::NoRun { path, why });
        }
        Ok(Self {
            path: path.to_owned(),
            written: Vec::new(),
            new: false,
            _lock: lock(path)?,
        })
    }

    /// Removes what was written of the results of a run before it was interrupted: it is written again. The case, the
    /// files that it reads and the checkpoints stay.
    ///
    /// # Errors
    /// What the system says.
    pub fn clear_results(&mut self, case: &Case) -> Result<(), FolderError> {
        remove_results(&self.path)?;
        // A case that was loaded can be written.
        let text = case.file.to_toml().unwrap_or_default();
        let inputs = case.inputs.iter();
        let inputs = inputs.map(|input| (input.name.as_str(), input.bytes.as_slice()));
        self.written = [(CASE, text.as_bytes())]
            .into_iter()
            .chain(inputs)
            .map(|(name, bytes)| (name.to_owned(), Some(blake3::hash(bytes))))
            .collect();
        Ok(())
    }

    /// Removes what this process has written of a run that failed. What others wrote stays.
    pub fn discard(self) {
        if self.new {
            // The run has failed, which is worse.
            let _ = remove_own(&self.path);
        }
    }

    /// Forces the names of the case and of the files that it reads to the disk.
    ///
    /// # Errors
    /// What the system says.
    pub fn sync(&self) -> Result<(), FolderError> {
        let inputs = self.path.join("inputs");
        let folders = [self.path.as_path(), &inputs];
        let mut there = folders.into_iter().filter(|folder| folder.is_dir());
        there.try_for_each(|folder| {
            let path = folder.to_owned();
            sync_folder(folder).map_err(|source| FolderError::Write { path, source })
        })
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file of the run.
    ///
    /// # Errors
    /// When it cannot be written, or a foreign file stands in its place.
    pub fn write(&mut self, name: &str, bytes: &[u8]) -> Result<(), FolderError> {
        let path = self.claim(name)?;
        write_atomic(&path, bytes).map_err(|source| FolderError::Write { path, source })?;
        if let Some((_, hash)) = self.written.last_mut() {
            *hash = Some(blake3::hash(bytes));
        }
        Ok(())
    }

    /// The path of a file that somebody else writes, which is noted as part of the run.
    ///
    /// # Errors
    /// When a foreign file stands in its place, or its folder cannot be made.
    pub fn claim(&mut self, name: &str) -> Result<PathBuf, FolderError> {
        let path = self.path.join(name);
        if path.exists() {
            return Err(FolderError::Foreign { path });
        }
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent).map_err(|source| FolderError::Write {
                path: parent.to_owned(),
                source,
            })?;
        }
        self.written.push((name.to_owned(), None));
        Ok(path)
    }

    /// Writes the manifest: the run is complete.
    ///
    /// # Errors
    /// When a file cannot be read back or is no longer as it was written, and when the manifest cannot be written.
    pub fn complete(
        self,
        started: jiff::Timestamp,
        threads: usize,
        model: &Model,
        seed: u64,
    ) -> Result<Manifest, FolderError> {
        let names: Vec<&str> = self.written.iter().map(|(name, _)| name.as_str()).collect();
        let manifest = Manifest::of(&self.path, &names, started, threads, model, seed)?;
        for (file, (name, hash)) in manifest.files.iter().zip(&self.written) {
            if hash.is_some_and(|hash| file.blake3 != hash.to_hex().as_str()) {
                let path = self.path.join(name);
                return Err(FolderError::Changed { path });
            }
        }
        let (manifest, bytes) = manifest.with_checksum();
        let path = self.path.join(MANIFEST);
        write_atomic(&path, &bytes)
            .and_then(|()| sync_folder(&self.path))
            .map_err(|source| {
                // What may not be on the disk is not complete.
                let _ = std::fs::remove_file(&path);
                FolderError::Write { path, source }
            })?;
        // The run is complete whether they can be removed or not.
        let _ = remove_checkpoints(&self.path);
        Ok(manifest)
    }
}

/// Locks a folder for one process. Some file systems of clusters have no locks, and some systems none of folders: the run
/// goes on without.
fn lock(path: &Path) -> Result<Option<File>, FolderError> {
    let Ok(folder) = File::open(path) else {
        return Ok(None);
    };
    match folder.try_lock() {
        Ok(()) => Ok(Some(folder)),
        Err(TryLockError::WouldBlock) => Err(FolderError::Busy {
            path: path.to_owned(),
        }),
        Err(TryLockError::Error(_)) => Ok(None),
    }
}
