//! The folder of a file, and names in folders that survive a power failure.

use std::fs::File;
use std::io::ErrorKind;
use std::path::Path;

/// The folder in which a file is, or will be.
pub fn folder_of(path: &Path) -> &Path {
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    parent.unwrap_or(Path::new("."))
}

/// Name of a folder. The system resolves a path such as `.`; the root of a file system has no name.
pub fn folder_name(folder: &Path) -> Option<String> {
    let known = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    Some(known.file_name()?.to_string_lossy().into_owned())
}

/// Syncs a folder, so that files renamed in it keep their names after a power failure.
pub fn sync_folder(folder: &Path) -> std::io::Result<()> {
    // Only Unix opens folders as files.
    if cfg!(not(unix)) {
        return Ok(());
    }
    match File::open(folder) {
        Ok(folder) => folder.sync_all(),
        // A folder that may be written to but not read cannot be synced.
        Err(error) if error.kind() == ErrorKind::PermissionDenied => Ok(()),
        Err(error) => Err(error),
    }
}
