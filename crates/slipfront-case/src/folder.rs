//! The run folder: everything needed to read a run's results and to make them again.
//!
//! Files appear whole or not at all, and `manifest.json` comes last: where it stands, the run is complete.

use std::fs::File;
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use slipfront::Model;
use tempfile::TempPath;
use thiserror::Error;

use crate::manifest::{MANIFEST, Manifest};

/// Names that belong to slipfront in a run folder, besides the files in `inputs/` that a manifest lists.
const OWN_FILES: [&str; 9] = [
    MANIFEST,
    "case.toml",
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
        if std::fs::read_dir(path).map_err(unwritable)?.next().is_some() {
            if !force {
                return Err(FolderError::NotEmpty {
                    path: path.to_owned(),
                });
            }
            // The manifest goes first: from now on the folder does not look complete.
            for name in own_files(path) {
                match std::fs::remove_file(path.join(name)) {
                    Err(error) if error.kind() != ErrorKind::NotFound => {
                        return Err(unwritable(error));
                    }
                    _ => {}
                }
            }
            // Gone if it held our inputs only; a foreign file keeps it.
            std::fs::remove_dir(path.join("inputs")).ok();
        }
        // A folder that cannot be written should say so before the run, not after it.
        tempfile::Builder::new()
            .prefix(UNFINISHED)
            .tempfile_in(path)
            .map_err(unwritable)?;
        Ok(Self {
            path: path.to_owned(),
            written: Vec::new(),
        })
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
        write_whole(&path, &bytes).map_err(|source| FolderError::Write { path, source })?;
        Ok(manifest)
    }
}

/// Files of an earlier run in this folder, its manifest first.
fn own_files(path: &Path) -> Vec<String> {
    let mut names: Vec<String> = OWN_FILES.map(str::to_owned).to_vec();
    let manifest = read_whole(&path.join(MANIFEST), TEXT_MAX_BYTES).ok();
    let manifest = manifest.and_then(|bytes| serde_json::from_slice::<Manifest>(&bytes).ok());
    let listed = manifest
        .into_iter()
        .flat_map(|manifest| manifest.files)
        .map(|file| file.name);
    // A manifest is only believed about the folder of copies: a damaged one must not make us delete elsewhere.
    names.extend(listed.filter(|name| {
        name.strip_prefix("inputs/")
            .is_some_and(|plain| !plain.contains(['/', '\\']))
    }));
    names
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

/// Reads a regular file that can have no more than `most` bytes if it is what it should be.
///
/// A pipe would be waited for, a device such as `/dev/zero` never ends, and a file of many gigabytes in the place of
/// a small one would take all memory before anyone looked at it.
///
/// # Errors
/// What the system says, and for a longer file or none.
pub(crate) fn read_whole(path: &Path, most: u64) -> std::io::Result<Vec<u8>> {
    let file = open_regular(path)?;
    let length = file.metadata()?.len();
    if length > most {
        let sentence = format!("it has {length} bytes where at most {most} can be meant");
        return Err(std::io::Error::new(ErrorKind::FileTooLarge, sentence));
    }
    let mut bytes = Vec::new();
    file.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Opens a regular file. The check comes before the opening, because opening a pipe waits for a writer.
///
/// # Errors
/// What the system says, and for anything else than a regular file.
pub(crate) fn open_regular(path: &Path) -> std::io::Result<File> {
    if std::fs::metadata(path)?.is_file() {
        File::open(path)
    } else {
        Err(std::io::Error::other("it is not a regular file"))
    }
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
