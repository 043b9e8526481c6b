//! Files that are written atomically and read up to a limit, and folders.

use std::fs::{File, Metadata};
use std::io::{ErrorKind, Read, Take, Write};
use std::path::Path;

use serde::Serialize;
use tempfile::{NamedTempFile, TempPath};

pub use crate::folders::{folder_name, folder_of, sync_folder};
use crate::unfinished;

/// Writes a file atomically: writes a [hidden file](unfinished) in the same folder and renames it, or removes
/// it after an error. The written file survives a power failure.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    write_atomic_with(path, |file| file.write_all(bytes))
}

/// Writes a file atomically with `fill`, so that the whole contents need not be in memory.
pub fn write_atomic_with(
    path: &Path,
    fill: impl FnOnce(&mut File) -> std::io::Result<()>,
) -> std::io::Result<()> {
    write_beside(path, fill)?.persist(path)?;
    sync_folder(folder_of(path))
}

/// Writes a [hidden file](unfinished) in the folder of its final path, and syncs it. The hidden file is
/// removed when dropped, unless it is renamed (`persist`).
pub fn write_beside(
    path: &Path,
    fill: impl FnOnce(&mut File) -> std::io::Result<()>,
) -> std::io::Result<NamedTempFile> {
    fill_and_sync(unfinished::file_for(folder_of(path), path)?, fill)
}

/// Writes a temporary file in a folder that no other process writes to, and syncs it. The file is removed
/// when dropped, unless it is renamed (`persist`).
pub fn write_temp(
    folder: &Path,
    fill: impl FnOnce(&mut File) -> std::io::Result<()>,
) -> std::io::Result<TempPath> {
    let file = unfinished::builder("", 0o666).tempfile_in(folder)?;
    Ok(fill_and_sync(file, fill)?.into_temp_path())
}

fn fill_and_sync(
    mut file: NamedTempFile,
    fill: impl FnOnce(&mut File) -> std::io::Result<()>,
) -> std::io::Result<NamedTempFile> {
    fill(file.as_file_mut())?;
    file.as_file().sync_all()?;
    Ok(file)
}

/// Removes a file if it exists.
pub fn remove_if_there(path: &Path) -> std::io::Result<()> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// Whether a folder is empty.
pub fn is_empty(folder: &Path) -> std::io::Result<bool> {
    Ok(std::fs::read_dir(folder)?.next().transpose()?.is_none())
}

/// Creates a folder and its missing parents, so that they survive a power failure.
pub fn make_folders(path: &Path) -> std::io::Result<()> {
    // If an existing folder cannot be examined, the standard library reports that it exists.
    if found_behind(path)?.is_some_and(|found| found.is_dir()) {
        return Ok(());
    }
    let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
    let missing: Vec<&Path> = path.ancestors().take_while(is_missing).collect();
    std::fs::create_dir_all(path)?;
    missing
        .into_iter()
        .rev()
        .try_for_each(|made| sync_folder(folder_of(made)))
}

/// Writes a file atomically, and creates the missing folders above it.
///
/// # Errors
/// When the system refuses.
pub fn write_with_folders(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    make_folders(folder_of(path))?;
    write_atomic(path, bytes)
}

/// Opens a regular file, and nothing else: a pipe may block, and a device such as `/dev/zero` has no end.
pub fn open_regular(path: &Path) -> std::io::Result<File> {
    if !std::fs::metadata(path)?.is_file() {
        return Err(std::io::Error::other("it is not a regular file"));
    }
    File::open(path)
}

/// Whether `path` is a regular file that starts with these bytes.
pub fn begins_with(path: &Path, beginning: &[u8]) -> bool {
    let mut found = Vec::new();
    let file = open_regular(path).map(|file| file.take(beginning.len() as u64));
    file.and_then(|mut file| file.read_to_end(&mut found)).is_ok() && found == beginning
}

/// Opens a regular file of at most `most` bytes, so that a huge file in the place of a small one is refused
/// before it fills the memory.
pub fn open_limited(path: &Path, most: u64) -> std::io::Result<Take<File>> {
    let file = open_regular(path)?;
    expect_at_most(file.metadata()?.len(), most)?;
    Ok(file.take(most))
}

/// Refuses a file of more than `most` bytes.
///
/// # Errors
/// With both numbers.
pub fn expect_at_most(length: u64, most: u64) -> std::io::Result<()> {
    if length > most {
        let sentence = format!("it has {length} bytes; at most {most} are expected");
        return Err(std::io::Error::new(ErrorKind::FileTooLarge, sentence));
    }
    Ok(())
}

/// Reads a regular file of at most `most` bytes.
pub fn read_limited(path: &Path, most: u64) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_limited(path, most)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Limit on the size of the text files that slipfront writes and reads at once: cases, summaries, manifests.
pub const TEXT_MAX_BYTES: u64 = 16 << 20;

/// Pretty JSON with a final newline.
pub fn json(value: &impl Serialize) -> Vec<u8> {
    // Serialisation of our own structs of numbers and strings cannot fail.
    let mut bytes = serde_json::to_vec_pretty(value).unwrap_or_default();
    bytes.push(b'\n');
    bytes
}

/// Metadata of a path, without following a symbolic link; none if nothing is there.
///
/// # Errors
/// When the system returns an error other than "not found", which does not mean that nothing is there.
pub fn found_at(path: &Path) -> std::io::Result<Option<Metadata>> {
    found(path.symlink_metadata())
}

/// Metadata of the target of a path, through symbolic links; none if nothing is there.
///
/// # Errors
/// When the system returns an error other than "not found", which does not mean that nothing is there.
pub fn found_behind(path: &Path) -> std::io::Result<Option<Metadata>> {
    found(path.metadata())
}

fn found(looked: std::io::Result<Metadata>) -> std::io::Result<Option<Metadata>> {
    match looked {
        Ok(found) => Ok(Some(found)),
        Err(error) if [ErrorKind::NotFound, ErrorKind::NotADirectory].contains(&error.kind()) => Ok(None),
        Err(error) => Err(error),
    }
}

/// Whether the path is a folder itself, and not a symbolic link to one.
///
/// # Errors
/// When the system returns an error other than "not found", which does not mean that nothing is there.
pub fn is_folder(path: &Path) -> std::io::Result<bool> {
    Ok(found_at(path)?.is_some_and(|found| found.is_dir()))
}

/// Whether two paths lead to the same existing file or folder.
pub fn is_same(one: &Path, other: &Path) -> bool {
    matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other)
}
