//! Copies of whole run folders.

use std::path::Path;

use slipfront_case::disk::{open_regular, sync_folder};

use super::error::FolderError;
use super::unfinished::Unfinished;
use crate::names::{CASE, MANIFEST, UNFINISHED};

/// Copies the files of a run folder. Its case and its manifest come last: without them, the copy is not taken for whole.
///
/// # Errors
/// When a file cannot be copied.
pub fn copy_run(from: &Path, to: &Path) -> Result<(), FolderError> {
    let failed = |source| FolderError::Copy {
        from: from.to_owned(),
        to: to.to_owned(),
        source,
    };
    std::fs::create_dir_all(to).map_err(failed)?;
    let unfinished = Unfinished::of(to);
    unfinished.create()?;
    let copied = unfinished
        .clear_temporary()
        .and_then(|()| copy_files(from, to, &unfinished));
    copied.and_then(|()| unfinished.remove()).map_err(failed)
}

fn copy_files(from: &Path, to: &Path, unfinished: &Unfinished) -> std::io::Result<()> {
    let last = [CASE, MANIFEST];
    for entry in std::fs::read_dir(from)? {
        let entry = entry?;
        let (from, to, name) = (entry.path(), to.join(entry.file_name()), entry.file_name());
        if !entry.file_type()?.is_dir() {
            if !last.iter().any(|last| name == *last) {
                copy_file(&from, &to, unfinished)?;
            }
        } else if name != UNFINISHED {
            std::fs::create_dir_all(&to)?;
            copy_files(&from, &to, unfinished)?;
        }
    }
    sync_folder(to)?;
    for name in last.into_iter().filter(|name| from.join(name).exists()) {
        copy_file(&from.join(name), &to.join(name), unfinished)?;
    }
    Ok(())
}

fn copy_file(from: &Path, to: &Path, unfinished: &Unfinished) -> std::io::Result<()> {
    let mut from = open_regular(from)?;
    unfinished.write(to, |to| std::io::copy(&mut from, to).map(|_| ()))
}
