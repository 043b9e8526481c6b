//! The run folder: everything needed to read a run's results and to make them again.
//!
//! Files appear whole or not at all, and `manifest.json` comes last: where it stands, the run is complete.

mod contents;
pub mod copy;
pub mod error;
pub mod inspection;
pub mod resume_command;
pub mod unfinished;

use std::fs::{File, TryLockError};
use std::io::Write;
use std::path::{Path, PathBuf};

use slipfront::Model;
use slipfront_case::case::{Case, Input};
use slipfront_case::disk::sync_folder;

use self::contents::{RESULTS, refuse_foreign, remove_files};
use self::error::FolderError;
use self::inspection::{Contents, Inspection};
use self::unfinished::Unfinished;
use crate::manifest::Manifest;
use crate::names::{CASE, MANIFEST};

/// A folder that was locked, if it exists, and inspected, for a run that begins or is resumed there.
#[derive(Debug)]
pub struct OpenedFolder {
    /// What it holds.
    pub inspection: Inspection,
    existed: bool,
    lock: Option<File>,
}

impl OpenedFolder {
    /// Locks a folder and inspects it.
    ///
    /// # Errors
    /// When another process runs there, or the folder cannot be listed.
    pub fn open(path: &Path) -> Result<Self, FolderError> {
        let existed = path.is_dir();
        let lock = if existed { lock(path)? } else { None };
        let inspection = inspect(path)?;
        Ok(Self {
            inspection,
            existed,
            lock,
        })
    }

    /// Makes the folder ready for a run that reads these `inputs`: it is created, or empty, or with `force` the files of an
    /// earlier run are removed (and nothing else).
    ///
    /// # Errors
    /// When it holds something else, which includes foreign files in the place of the copies, or cannot be written.
    pub fn prepare(mut self, force: bool, inputs: &[Input]) -> Result<RunFolder, FolderError> {
        let path = self.inspection.path.clone();
        if !self.existed {
            std::fs::create_dir_all(&path).map_err(|source| FolderError::Unwritable {
                path: path.clone(),
                source,
            })?;
            // Another process may have made it since.
            self = Self::open(&path)?;
        }
        match self.inspection.contents {
            Contents::Empty => {}
            _ if force => {
                let managed = &self.inspection.managed_files;
                refuse_foreign(&path, managed, inputs)?;
                remove_files(&path, managed.iter().map(String::as_str))?;
            }
            Contents::Interrupted => return Err(FolderError::Interrupted { path }),
            Contents::Foreign | Contents::Complete(_) => return Err(FolderError::NotEmpty { path }),
        }
        let unfinished = Unfinished::of(&path);
        unfinished.create()?;
        // Without a lock another process may be writing.
        if self.lock.is_some() {
            let _ = unfinished.clear_temporary();
        }
        Ok(RunFolder {
            path,
            unfinished,
            written: Vec::new(),
            new: true,
            _lock: self.lock,
        })
    }

    /// Takes over the folder of an interrupted run of this case: removes what it had written of its results, which are
    /// written again. The case, the files that it reads and the checkpoints stay.
    ///
    /// # Errors
    /// Any error of the system.
    pub fn resume(self, case: &Case) -> Result<RunFolder, FolderError> {
        let path = self.inspection.path;
        remove_files(&path, RESULTS)?;
        let unfinished = Unfinished::of(&path);
        unfinished.create()?;
        unfinished
            .clear_temporary()
            .map_err(|source| FolderError::Unwritable {
                path: path.clone(),
                source,
            })?;
        // A case that was loaded can be written.
        let text = case.file.to_toml().unwrap_or_default();
        let inputs = case.inputs.iter();
        let inputs = inputs.map(|input| (input.name.as_str(), input.bytes.as_slice()));
        let written = [(CASE, text.as_bytes())]
            .into_iter()
            .chain(inputs)
            .map(|(name, bytes)| (name.to_owned(), Some(blake3::hash(bytes))))
            .collect();
        let folder = RunFolder {
            path,
            unfinished,
            written,
            new: false,
            _lock: self.lock,
        };
        folder.sync()?;
        Ok(folder)
    }
}

fn inspect(path: &Path) -> Result<Inspection, FolderError> {
    Inspection::of(path).map_err(|source| FolderError::Unwritable {
        path: path.to_owned(),
        source,
    })
}

/// A folder that a run is being written to.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    unfinished: Unfinished,
    /// Files of the run, and the hash of what this process knows of their contents.
    written: Vec<(String, Option<blake3::Hash>)>,
    /// Whether this process began the run.
    new: bool,
    /// Held as long as the run goes on.
    _lock: Option<File>,
}

impl RunFolder {
    /// Opens a folder and makes it ready: see [`OpenedFolder::prepare`].
    ///
    /// # Errors
    /// Those of [`OpenedFolder::open`] and [`OpenedFolder::prepare`].
    pub fn prepare(path: &Path, force: bool, inputs: &[Input]) -> Result<Self, FolderError> {
        OpenedFolder::open(path)?.prepare(force, inputs)
    }

    /// Ends a run that failed: removes what this process has written, if it began the run. A resumed run keeps its case.
    pub fn discard(mut self) {
        if self.new {
            let names: Vec<String> = self.written.drain(..).map(|(name, _)| name).rev().collect();
            // The error of the run is what matters.
            let _ = remove_files(&self.path, names.iter().map(String::as_str));
            let _ = self.unfinished.remove();
        } else {
            self.leave();
        }
    }

    /// Ends with the case alone: the hidden subfolder is removed, unless it holds a checkpoint.
    pub fn leave(self) {
        if !self.unfinished.has_checkpoint() {
            let _ = self.unfinished.remove();
        }
    }

    /// Syncs the folders of the case and of the files that it reads, so that these survive a power failure.
    ///
    /// # Errors
    /// Any error of the system.
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
        self.unfinished
            .write(&path, |file| file.write_all(bytes))
            .map_err(|source| FolderError::Write { path, source })?;
        if let Some((_, hash)) = self.written.last_mut() {
            *hash = Some(blake3::hash(bytes));
        }
        Ok(())
    }

    /// The folder of temporary files, for a file that is [claimed](Self::claim).
    pub fn temporary(&self) -> PathBuf {
        self.unfinished.temporary()
    }

    /// Notes a file as part of the run, and gives its path to whoever writes it.
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
        self.unfinished
            .write(&path, |file| file.write_all(&bytes))
            .and_then(|()| sync_folder(&self.path))
            .map_err(|source| {
                // What may not be on the disk is not complete.
                let _ = std::fs::remove_file(&path);
                FolderError::Write { path, source }
            })?;
        // The run is complete whether they can be removed or not.
        let _ = self.unfinished.remove();
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
