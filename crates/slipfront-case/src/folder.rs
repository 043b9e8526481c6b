//! The run folder: everything needed to read a run's results and to make them again.
//!
//! Files appear whole or not at all, and `manifest.json` comes last: where it stands, the run is complete.

use std::fs::{File, TryLockError};
use std::io::{ErrorKind, Read, Take, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use slipfront::Model;
use tempfile::TempPath;
use thiserror::Error;

use crate::case::Case;
use crate::case_file::CaseFile;
use crate::checkpoint::{CHECKPOINT, Checkpoints, PREVIOUS};
use crate::manifest::{MANIFEST, Manifest};

/// The resolved case in its folder.
const CASE: &str = "case.toml";

/// Names that belong to slipfront in a run folder, besides its case and the copies in `inputs/`.
const OWN_FILES: [&str; 10] = [
    MANIFEST,
    CHECKPOINT,
    PREVIOUS,
    "summary.json",
    "series.csv",
    "fields.nc",
    "friction.svg",
    "friction.png",
    "stress.svg",
    "stress.png",
];

/// How the names of files begin while they are being written.
pub(crate) const UNFINISHED: &str = ".slipfront";

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
        "the folder {0} holds a run that was interrupted: go on with it by `slipfront run --resume {0}`, choose another \
         with --out, or begin again with --force",
        path.display()
    )]
    Interrupted {
        /// The folder.
        path: PathBuf,
    },
    /// There is no run in it to go on with.
    #[error("{} holds no run to go on with: it has no case.toml", path.display())]
    NoRun {
        /// The folder.
        path: PathBuf,
    },
    /// Somebody else writes there.
    #[error("another process is running in the folder {}: wait for it, or choose another folder", path.display())]
    Busy {
        /// The folder.
        path: PathBuf,
    },
    /// A file that is not slipfront's stands where one would be written.
    #[error("{} is not a file of an earlier run: move it away or choose another folder with --out", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// It cannot be made or written to.
    #[error("cannot write to the folder {}: {source}; choose another with --out", path.display())]
    Unwritable {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file could not be written.
    #[error("cannot write {}: {source}; the folder is left without manifest.json, as incomplete", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file could not be read back.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}

/// A folder that a run is being written to.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    written: Vec<String>,
    /// Held as long as the run goes on.
    _lock: Option<File>,
}

impl RunFolder {
    /// Makes the folder ready: it is created, or empty, or with `force` rid of the files of an earlier run (and of
    /// nothing else).
    ///
    /// # Errors
    /// When it holds something else, or cannot be written.
    pub fn prepare(path: &Path, force: bool) -> Result<Self, FolderError> {
        let unwritable = |source| FolderError::Unwritable {
            path: path.to_owned(),
            source,
        };
        std::fs::create_dir_all(path).map_err(unwritable)?;
        let lock = lock(path)?;
        remove_unfinished(path);
        if !is_empty(path).map_err(unwritable)? {
            if !force {
                let path = path.to_owned();
                return Err(if is_interrupted(&path) {
                    FolderError::Interrupted { path }
                } else {
                    FolderError::NotEmpty { path }
                });
            }
            remove_own(path)?;
        }
        // A folder that cannot be written should say so before the run, not after it.
        tempfile::Builder::new()
            .prefix(UNFINISHED)
            .tempfile_in(path)
            .map_err(unwritable)?;
        Ok(Self {
            path: path.to_owned(),
            written: Vec::new(),
            _lock: lock,
        })
    }

    /// Takes over the folder of a run that has a case.
    ///
    /// # Errors
    /// When there is no such run, or another process goes on with it.
    pub fn reopen(path: &Path) -> Result<Self, FolderError> {
        if !path.join(CASE).is_file() {
            let path = path.to_owned();
            return Err(FolderError::NoRun { path });
        }
        Ok(Self {
            path: path.to_owned(),
            written: Vec::new(),
            _lock: lock(path)?,
        })
    }

    /// Removes what was written of the results of a run before it was interrupted: it is written again. The case, the
    /// files that it reads and the checkpoints stay.
    ///
    /// # Errors
    /// What the system says.
    pub fn clear_results(&mut self, case: &Case) -> Result<(), FolderError> {
        let kept = [CHECKPOINT, PREVIOUS];
        let results = OWN_FILES.into_iter().filter(|name| !kept.contains(name));
        remove(&self.path, results.map(str::to_owned))?;
        remove(&self.path, unfinished(&self.path, ""))?;
        let inputs = case.inputs.iter().map(|input| input.name.clone());
        self.written = [CASE.to_owned()].into_iter().chain(inputs).collect();
        Ok(())
    }

    /// Removes all that was written of the run: there is nothing to go on with.
    ///
    /// # Errors
    /// What the system says.
    pub fn discard(self) -> Result<(), FolderError> {
        remove_own(&self.path)
    }

    /// Refuses foreign files that stand where `names` will be written: better now than after the run.
    ///
    /// # Errors
    /// [`FolderError::Foreign`], with the first of them.
    pub fn expect_free<'n>(&self, names: impl Iterator<Item = &'n str>) -> Result<(), FolderError> {
        for path in names.map(|name| self.path.join(name)) {
            let parent = path.parent().filter(|parent| parent.exists() && !parent.is_dir());
            if let Some(parent) = parent {
                let path = parent.to_owned();
                return Err(FolderError::Foreign { path });
            }
            // A link counts even if it leads nowhere.
            if path.symlink_metadata().is_ok() {
                return Err(FolderError::Foreign { path });
            }
        }
        Ok(())
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
        self.written.push(name.to_owned());
        Ok(path)
    }

    /// Writes the manifest: the run is complete.
    ///
    /// # Errors
    /// When a file cannot be read back or the manifest cannot be written.
    pub fn complete(
        self,
        started: jiff::Timestamp,
        threads: usize,
        model: &Model,
        seed: u64,
    ) -> Result<Manifest, FolderError> {
        let (manifest, bytes) =
            Manifest::of(&self.path, &self.written, started, threads, model, seed)?.sealed();
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

/// Whether a folder holds a run that was begun, and neither completed nor removed.
fn is_interrupted(path: &Path) -> bool {
    path.join(CASE).exists() && !path.join(MANIFEST).exists()
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

/// Files of an earlier run in this folder, finished or not: its manifest first, its case last, which until then tells
/// the copies of a run that was stopped.
fn own_files(path: &Path) -> Vec<String> {
    let manifest = read_whole(&path.join(MANIFEST), TEXT_MAX_BYTES).ok();
    let manifest = manifest.and_then(|bytes| serde_json::from_slice::<Manifest>(&bytes).ok());
    let listed = manifest
        .into_iter()
        .flat_map(|manifest| manifest.files)
        .map(|file| file.name);
    let mut copies: Vec<String> = listed.chain(named_by_case(&path.join(CASE))).collect();
    copies.sort();
    copies.dedup();
    // They are only believed about the folder of copies: damage must not make us delete elsewhere.
    copies.retain(|name| {
        name.strip_prefix("inputs/")
            .is_some_and(|plain| !plain.contains(['/', '\\']))
    });
    let mut names: Vec<String> = OWN_FILES.map(str::to_owned).to_vec();
    names.extend(copies);
    names.extend(unfinished(path, ""));
    names.extend(unfinished(path, "inputs/"));
    names.push(CASE.to_owned());
    names
}

/// Whether there is nothing in a folder.
///
/// # Errors
/// When it cannot be read.
pub fn is_empty(folder: &Path) -> std::io::Result<bool> {
    Ok(std::fs::read_dir(folder)?.next().transpose()?.is_none())
}

/// The files that a resolved case names. One that is not resolved was not written by a run, and what it names may be
/// the only copy that there is.
fn named_by_case(path: &Path) -> Vec<String> {
    let read = || {
        let bytes = read_whole(path, TEXT_MAX_BYTES).ok()?;
        let mut case = CaseFile::parse(std::str::from_utf8(&bytes).ok()?, CASE, &[]).ok()?;
        let resolved = case.to_toml().ok()? == std::str::from_utf8(&bytes).ok()?;
        resolved.then(|| case.files_mut().map(|(_, name)| name.clone()).collect())
    };
    read().unwrap_or_default()
}

/// What a kill left in a folder, or one inside it such as `inputs/`, of files that were being written.
fn unfinished(folder: &Path, inside: &str) -> Vec<String> {
    let entries = std::fs::read_dir(folder.join(inside))
        .into_iter()
        .flatten()
        .flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    names
        .filter(|name| name.starts_with(UNFINISHED))
        .map(|name| format!("{inside}{name}"))
        .collect()
}

/// Removes what a kill left of files that were being written, where nobody else writes now. A file that cannot be
/// removed does no harm.
pub(crate) fn remove_unfinished(folder: &Path) {
    for name in unfinished(folder, "") {
        let _ = std::fs::remove_file(folder.join(name));
    }
}

/// Removes the files of an earlier run from this folder.
fn remove_own(path: &Path) -> Result<(), FolderError> {
    // The manifest goes first: from now on the folder does not look complete.
    remove(path, own_files(path))?;
    // Gone if it held our inputs only; a foreign file keeps it.
    std::fs::remove_dir(path.join("inputs")).ok();
    Ok(())
}

/// Removes these files from a folder, where they are.
fn remove(folder: &Path, names: impl IntoIterator<Item = String>) -> Result<(), FolderError> {
    for name in names {
        match std::fs::remove_file(folder.join(name)) {
            Err(source) if source.kind() != ErrorKind::NotFound => {
                let path = folder.to_owned();
                return Err(FolderError::Unwritable { path, source });
            }
            _ => {}
        }
    }
    Ok(())
}

/// Bytes of an earlier run in this folder, which [`RunFolder::prepare`] would remove with `force`.
pub fn own_bytes(path: &Path) -> u64 {
    let length = |name| std::fs::symlink_metadata(path.join(name)).map_or(0, |file| file.len());
    own_files(path).into_iter().map(length).sum()
}

/// Writes a file whole or not at all: into a neighbour first, which then takes its name.
///
/// # Errors
/// What the system says; nothing is left behind then.
pub fn write_whole(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let folder = path
        .parent()
        .filter(|parent| !parent.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    stage(folder, |file| file.write_all(bytes))?.persist(path)?;
    Ok(())
}

/// Makes a file in a folder, forced to the disk, that still has to take its name and goes away if it does not.
pub(crate) fn stage(
    folder: &Path,
    fill: impl FnOnce(&mut File) -> std::io::Result<()>,
) -> std::io::Result<TempPath> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(UNFINISHED);
    // Temporary files are private by default; results are not.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder)?;
    fill(file.as_file_mut())?;
    file.as_file().sync_all()?;
    Ok(file.into_temp_path())
}

/// Forces the names in a folder to the disk.
pub(crate) fn sync_folder(folder: &Path) -> std::io::Result<()> {
    // Only Unix opens folders as files.
    if cfg!(unix) {
        File::open(folder)?.sync_all()?;
    }
    Ok(())
}

/// Opens a file that is one: a pipe would be waited for, a device such as `/dev/zero` never ends.
pub(crate) fn open_regular(path: &Path) -> std::io::Result<File> {
    if !std::fs::metadata(path)?.is_file() {
        return Err(std::io::Error::other("it is not a regular file"));
    }
    File::open(path)
}

/// Opens a regular file that can have no more than `most` bytes if it is what it should be.
///
/// A file of many gigabytes in the place of a small one would take all memory before anyone looked at it.
///
/// # Errors
/// What the system says, and for a longer file or none.
pub(crate) fn open_bounded(path: &Path, most: u64) -> std::io::Result<Take<File>> {
    let file = open_regular(path)?;
    let length = file.metadata()?.len();
    if length > most {
        let sentence = format!("it has {length} bytes where at most {most} can be meant");
        return Err(std::io::Error::new(ErrorKind::FileTooLarge, sentence));
    }
    Ok(file.take(most))
}

/// Reads a regular file that can have no more than `most` bytes.
///
/// # Errors
/// As for [`open_bounded`].
pub(crate) fn read_whole(path: &Path, most: u64) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_bounded(path, most)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The largest file of our own that is read whole: a case, a summary, a manifest.
pub(crate) const TEXT_MAX_BYTES: u64 = crate::case_file::MAX_MIB << 20;

/// Pretty JSON with a final newline.
pub(crate) fn json(value: &impl Serialize) -> Vec<u8> {
    // Our own structs of numbers and strings: serialisation cannot fail.
    let mut bytes = serde_json::to_vec_pretty(value).unwrap_or_default();
    bytes.push(b'\n');
    bytes
}
