//! The run folder: everything needed to read a run's results and to make them again.
//!
//! Files appear whole or not at all, and `manifest.json` comes last: where it stands, the run is complete.

mod files;
mod own;

use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};

use slipfront::Model;
use thiserror::Error;

use self::files::holds_only_unfinished;
pub(crate) use self::files::{
    TEXT_MAX_BYTES, UNFINISHED, begins_with, fill_whole, json, open_bounded, open_regular, read_whole,
    remove_if_there, remove_unfinished, stage, sync_folder,
};
pub use self::files::{is_empty, write_whole};
pub use self::own::own_bytes;
pub(crate) use self::own::{CASE, is_folder, is_of_interrupted_run};
use self::own::{refuse_foreign, remove_own, remove_results, resolved_case};
use crate::case::{Case, Input};
use crate::checkpoint::Checkpoints;
use crate::legible::{quoted, shown};
use crate::manifest::{MANIFEST, Manifest};

/// What can go wrong with a run folder.
#[derive(Debug, Error)]
pub enum FolderError {
    /// There is something in it already.
    #[error(
        "the folder {} is not empty: choose another with --out, or replace slipfront's own files in it with --force",
        path.display()
    )]
    NotEmpty {
        /// The folder.
        path: PathBuf,
    },
    /// There is a run in it that was interrupted.
    #[error(
        "the folder {} holds a run that was interrupted: go on with it by `{}`, choose another with --out, or begin again \
         with --force",
        path.display(),
        resume_command(path)
    )]
    Interrupted {
        /// The folder.
        path: PathBuf,
    },
    /// There is no run in it to go on with.
    #[error("{} is no folder of a run to go on with: {why}", path.display())]
    NoRun {
        /// The folder.
        path: PathBuf,
        /// What is missing.
        why: &'static str,
    },
    /// Somebody else writes there.
    #[error("another process is running in the folder {}: wait for it, or choose another folder", path.display())]
    Busy {
        /// The folder.
        path: PathBuf,
    },
    /// A file that is not slipfront's stands where one would be written.
    #[error(
        "{} is not a file of an earlier run: move it away or choose another folder with --out",
        shown(path)
    )]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// It cannot be made or written to.
    #[error("cannot write to the folder {}: {source}; make it writable, or choose another", path.display())]
    Unwritable {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file could not be written.
    #[error(
        "cannot write {}: {source}; the folder is left without manifest.json, as incomplete",
        shown(path)
    )]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The folder of a run could not be copied.
    #[error(
        "cannot copy {} to {}: {source}; what is there is whole, and the command may be repeated",
        shown(from),
        shown(to)
    )]
    Copy {
        /// The folder.
        from: PathBuf,
        /// Where it should have gone.
        to: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file was changed before the run was complete.
    #[error(
        "{} was changed while the run went on, so that it does not tell what was run; the folder is left without \
         manifest.json, as incomplete: put the file back as it was",
        shown(path)
    )]
    Changed {
        /// The file.
        path: PathBuf,
    },
    /// A file could not be read back.
    #[error("cannot read {}: {source}", shown(path))]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}

/// The command that goes on with the run in a folder, as a shell reads it.
pub fn resume_command(folder: &Path) -> String {
    let mut folder = shown(folder);
    // Else it would be taken for an option.
    if folder.starts_with('-') {
        folder.insert_str(0, "./");
    }
    format!("slipfront run --resume {}", quoted(&folder))
}

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
        write_whole(&path, bytes).map_err(|source| FolderError::Write { path, source })?;
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
        let (manifest, bytes) = manifest.sealed();
        let path = self.path.join(MANIFEST);
        write_whole(&path, &bytes)
            .and_then(|()| sync_folder(&self.path))
            .map_err(|source| {
                // What may not be on the disk is not complete.
                let _ = std::fs::remove_file(&path);
                FolderError::Write { path, source }
            })?;
        // The run is complete whether they can be removed or not.
        let _ = Checkpoints::remove(&self.path);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_suggested_command_can_be_typed() {
        let of = |name: &str| resume_command(Path::new(name));
        assert_eq!(of("results/a-1"), "slipfront run --resume results/a-1");
        assert_eq!(of("my run"), "slipfront run --resume 'my run'");
        assert_eq!(of("$HOME"), "slipfront run --resume '$HOME'");
        assert_eq!(of("-o"), "slipfront run --resume ./-o");
    }
}
