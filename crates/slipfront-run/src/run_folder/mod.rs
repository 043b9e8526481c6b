//! The run folder: everything needed to read a run's results and to make them again.
//!
//! Files appear whole or not at all, and `manifest.json` comes last: where it stands, the run is complete.

pub(crate) mod contents;
pub mod error;
pub mod inspection;
pub mod unfinished;

use std::fs::{File, TryLockError};
use std::io::Write;
use std::path::{Path, PathBuf};

use slipfront_case::case::{Case, Input};
use slipfront_case::disk::sync_folder;

use self::contents::{refuse_foreign, remove_files, result_files};
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
        let inspection = Inspection::of(path).map_err(FolderError::unwritable(path))?;
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
            std::fs::create_dir_all(&path).map_err(FolderError::unwritable(&path))?;
            // Another process may have made it since.
            self = Self::open(&path)?;
        }
        match self.inspection.contents {
            Contents::Empty => {}
            _ if force => {
                let managed = &self.inspection.managed_files;
                refuse_foreign(&path, managed, inputs)?;
                remove_files(&path, managed)?;
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
    pub fn resume(self, case: &Case) -> Result<RunFolder, FolderError> {
        let path = self.inspection.path;
        remove_files(&path, result_files())?;
        let unfinished = Unfinished::of(&path);
        unfinished.create()?;
        unfinished
            .clear_temporary()
            .map_err(FolderError::unwritable(&path))?;
        // A case that was loaded can be written.
        let text = case.file.to_toml().unwrap_or_default();
        let mut written = vec![(CASE.to_owned(), Some(blake3::hash(text.as_bytes())))];
        let inputs = case.inputs.iter();
        written.extend(inputs.map(|input| (input.name.clone(), Some(blake3::hash(&input.bytes)))));
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
    /// Opens a folder and makes it ready: see [`OpenedFolder::open`] and [`OpenedFolder::prepare`].
    pub fn prepare(path: &Path, force: bool, inputs: &[Input]) -> Result<Self, FolderError> {
        OpenedFolder::open(path)?.prepare(force, inputs)
    }

    /// Ends a run that failed: removes what this process has written, if it began the run. A resumed run keeps its case.
    pub fn discard(mut self) {
        if self.new {
            let names = self.written.drain(..).map(|(name, _)| name).rev();
            // The error of the run is what matters.
            let _ = remove_files(&self.path, names);
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
    pub(crate) fn sync(&self) -> Result<(), FolderError> {
        for folder in [self.path.clone(), self.path.join("inputs")] {
            if folder.is_dir() {
                sync_folder(&folder).map_err(FolderError::write(&folder))?;
            }
        }
        Ok(())
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file of the run, where no foreign file stands in its place.
    pub fn write(&mut self, name: &str, bytes: &[u8]) -> Result<(), FolderError> {
        let path = self.claim(name)?;
        let written = self.unfinished.write(&path, |file| file.write_all(bytes));
        written.map_err(FolderError::write(&path))?;
        if let Some((_, hash)) = self.written.last_mut() {
            *hash = Some(blake3::hash(bytes));
        }
        Ok(())
    }

    /// The folder of temporary files, for a file that is [claimed](Self::claim).
    pub(crate) fn temporary(&self) -> PathBuf {
        self.unfinished.temporary()
    }

    /// Notes a file as part of the run, where no foreign file stands in its place, and gives its path to whoever writes it.
    pub(crate) fn claim(&mut self, name: &str) -> Result<PathBuf, FolderError> {
        let path = self.path.join(name);
        if path.exists() {
            return Err(FolderError::Foreign { path });
        }
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent).map_err(FolderError::write(parent))?;
        }
        self.written.push((name.to_owned(), None));
        Ok(path)
    }

    /// Writes the manifest: the run is complete, if every file is still as it was written.
    pub(crate) fn complete(
        self,
        case: &Case,
        started: jiff::Timestamp,
        threads: usize,
    ) -> Result<Manifest, FolderError> {
        let names: Vec<&str> = self.written.iter().map(|(name, _)| name.as_str()).collect();
        let manifest = Manifest::of(&self.path, &names, case, started, threads)?;
        for (file, (name, hash)) in manifest.files.iter().zip(&self.written) {
            if hash.is_some_and(|hash| file.blake3 != hash.to_hex().as_str()) {
                let path = self.path.join(name);
                return Err(FolderError::Changed { path });
            }
        }
        let (manifest, bytes) = manifest.with_checksum();
        let path = self.path.join(MANIFEST);
        let written = self.unfinished.write(&path, |file| file.write_all(&bytes));
        if let Err(error) = written.and_then(|()| sync_folder(&self.path)) {
            // What may not be on the disk is not complete.
            let _ = std::fs::remove_file(&path);
            return Err(FolderError::write(&path)(error));
        }
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
