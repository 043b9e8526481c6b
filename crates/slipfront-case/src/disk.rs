//! Files and folders: written whole or not at all, read within bounds.

use std::fs::{DirEntry, File};
use std::io::{ErrorKind, Read, Take, Write};
use std::path::Path;

use serde::Serialize;
use tempfile::TempPath;

/// How the names of files begin while they are being written.
pub const UNFINISHED: &str = ".slipfront";

/// Writes a file whole or not at all: into a neighbour first, which then takes its name.
///
/// # Errors
/// What the system says; nothing is left behind then.
pub fn write_whole(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    fill_whole(path, |file| file.write_all(bytes))
}

/// The same of a file that somebody else fills.
pub fn fill_whole(path: &Path, fill: impl FnOnce(&mut File) -> std::io::Result<()>) -> std::io::Result<()> {
    let folder = path
        .parent()
        .filter(|parent| !parent.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    stage(folder, fill)?.persist(path)?;
    Ok(())
}

/// Makes a file in a folder, forced to the disk, that still has to take its name and goes away if it does not.
pub fn stage(
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
pub fn sync_folder(folder: &Path) -> std::io::Result<()> {
    // Only Unix opens folders as files.
    if cfg!(unix) {
        File::open(folder)?.sync_all()?;
    }
    Ok(())
}

/// What a kill left in a folder, or one inside it such as `inputs/`, of files that were being written.
pub fn unfinished(folder: &Path, inside: &str) -> Vec<String> {
    let entries = std::fs::read_dir(folder.join(inside))
        .into_iter()
        .flatten()
        .flatten();
    let names = entries.filter(is_unfinished_file).map(|entry| entry.file_name());
    names
        .map(|name| format!("{inside}{}", name.to_string_lossy()))
        .collect()
}

fn is_unfinished_file(entry: &DirEntry) -> bool {
    let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
    is_file && entry.file_name().to_str().is_some_and(is_unfinished)
}

/// Whether a file has the name of one that is being written: ours, and six letters or digits.
pub fn is_unfinished(name: &str) -> bool {
    let random = name.strip_prefix(UNFINISHED).unwrap_or_default();
    random.len() == 6 && random.bytes().all(|byte| byte.is_ascii_alphanumeric())
}

/// Whether there is nothing in a folder but what a kill left of files that were being written.
///
/// # Errors
/// When it cannot be read.
pub fn holds_only_unfinished(folder: &Path) -> std::io::Result<bool> {
    for entry in std::fs::read_dir(folder)? {
        if !is_unfinished_file(&entry?) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Removes what a kill left of files that were being written, where nobody else writes now. A file that cannot be
/// removed does no harm.
pub fn remove_unfinished(folder: &Path) {
    for name in unfinished(folder, "") {
        let _ = std::fs::remove_file(folder.join(name));
    }
}

/// Removes a file, if it is there.
///
/// # Errors
/// What the system says.
pub fn remove_if_there(path: &Path) -> std::io::Result<()> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// Whether there is nothing in a folder.
///
/// # Errors
/// When it cannot be read.
pub fn is_empty(folder: &Path) -> std::io::Result<bool> {
    Ok(std::fs::read_dir(folder)?.next().transpose()?.is_none())
}

/// Opens a file that is one: a pipe would be waited for, a device such as `/dev/zero` never ends.
pub fn open_regular(path: &Path) -> std::io::Result<File> {
    if !std::fs::metadata(path)?.is_file() {
        return Err(std::io::Error::other("it is not a regular file"));
    }
    File::open(path)
}

/// Whether a regular file begins so.
pub fn begins_with(path: &Path, beginning: &[u8]) -> bool {
    let mut found = Vec::new();
    let file = open_regular(path).map(|file| file.take(beginning.len() as u64));
    file.and_then(|mut file| file.read_to_end(&mut found)).is_ok() && found == beginning
}

/// Opens a regular file that can have no more than `most` bytes if it is what it should be.
///
/// A file of many gigabytes in the place of a small one would take all memory before anyone looked at it.
///
/// # Errors
/// What the system says, and for a longer file or none.
pub fn open_bounded(path: &Path, most: u64) -> std::io::Result<Take<File>> {
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
pub fn read_whole(path: &Path, most: u64) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_bounded(path, most)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The largest file of our own that is read whole: a case, a summary, a manifest.
pub const TEXT_MAX_BYTES: u64 = 16 << 20;

/// Pretty JSON with a final newline.
pub fn json(value: &impl Serialize) -> Vec<u8> {
    // Our own structs of numbers and strings: serialisation cannot fail.
    let mut bytes = serde_json::to_vec_pretty(value).unwrap_or_default();
    bytes.push(b'\n');
    bytes
}

/// Whether this is a folder itself, and not a link to one: what a link leads to belongs to somebody else.
pub fn is_folder(path: &Path) -> bool {
    path.symlink_metadata().is_ok_and(|found| found.is_dir())
}

/// Whether two paths lead to the same file or folder, which exists.
pub fn is_same(one: &Path, other: &Path) -> bool {
    matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other)
}
