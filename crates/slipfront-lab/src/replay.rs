//! Folders of runs on the disk: their names, and their files for a session.

use std::path::{Path, PathBuf};

use slipfront_base::text::{display_path, truncated};
use slipfront_run::names::{FIELDS, MANIFEST, SERIES};
use slipfront_session::{MAX_FILES, OpenedCase, is_plain_name, recorded_run};

use crate::files::ReadableFolders;

/// Largest file of fields from which snapshots are shown, in bytes.
const MAX_FIELDS: u64 = 32 << 20;

/// Names of the complete runs among the results.
pub(crate) fn folders(results: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(results).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .filter(|entry| entry.path().join(MANIFEST).is_file())
        .filter_map(|entry| entry.file_name().into_string().ok())
        .filter(|name| is_plain_name(name))
        .collect();
    names.sort();
    names
}

/// Folder of the run with this name.
///
/// # Errors
/// A sentence, if the name is not a plain name, or leads out of the results and the `allowed` folders.
pub(crate) fn folder(results: &Path, name: &str, allowed: &[PathBuf]) -> Result<PathBuf, String> {
    if !is_plain_name(name) {
        return Err(format!(
            "{:?} is no run of the folder of results",
            truncated(name)
        ));
    }
    let found = ReadableFolders::new(results, "the results", allowed).and_then(|reach| reach.resolve(name));
    found.map_err(|error| format!("{} cannot be read: {error}", display_path(&results.join(name))))
}

/// Reads a complete run.
///
/// # Errors
/// A sentence, if it is not a complete run, or was changed since it was written, or one of its files lies
/// outside the folder and the `allowed` folders.
pub(crate) fn read(folder: &Path, allowed: &[PathBuf]) -> Result<OpenedCase, String> {
    let reach = ReadableFolders::new(folder, "the run", allowed)?;
    let canonical = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let name = canonical.file_name().unwrap_or_default().to_string_lossy();
    recorded_run(&name, folder, |file| {
        let path = folder.join(file);
        let Ok(found) = path.metadata() else {
            return Ok(None);
        };
        if file == FIELDS && found.len() > MAX_FIELDS {
            return Ok(None);
        }
        let limit = if file == SERIES { u64::MAX } else { MAX_FILES };
        let contents = reach.read_up_to(file, limit);
        contents
            .map(Some)
            .map_err(|error| format!("{} cannot be read: {error}", display_path(&path)))
    })
}
