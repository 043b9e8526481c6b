//! The files of a run folder that belong to slipfront: those that are listed with their present hash.

use std::path::{Component, Path, PathBuf};

use slipfront_base::disk::{found_at, is_folder, remove_if_there};

use super::unfinished::Unfinished;
use crate::folder_error::FolderError;
use crate::manifest::{ManifestFile, is_one_of};
use crate::names::{CASE, FIELDS, KYMOGRAPH, MANIFEST, MOVIE, RunPicture, SERIES, STATE, SUMMARY};
use crate::observers::tables;

/// The files that a run writes in addition to its case and the copies in `inputs/`, the manifest first.
pub(super) fn result_files() -> impl Iterator<Item = String> {
    let tables = tables().map(|table| table.file);
    let files = [MANIFEST, SUMMARY, SERIES].into_iter().chain(tables);
    let files = files.chain([KYMOGRAPH, FIELDS, STATE, MOVIE]).map(str::to_owned);
    files.chain(RunPicture::ALL.into_iter().flat_map(RunPicture::files))
}

/// The files of an earlier run in a folder, in the order in which they may be removed: the manifest first, so
/// that the folder does not look complete, and the case last, which marks the folder as one of a run. The
/// files are the `listed` ones that are unchanged, even if others have changed, and those in the hidden
/// subfolder.
pub(super) fn managed_files(folder: &Path, listed: &[ManifestFile]) -> Result<Vec<String>, FolderError> {
    let mut names = Vec::new();
    for name in listed_names(folder, listed)? {
        if is_as_listed(folder, &name, listed).map_err(FolderError::read(&folder.join(&name)))? {
            names.push(name);
        }
    }
    names.sort_by_key(|name| (name == CASE, name != MANIFEST));
    names.extend(Unfinished::in_folder(folder).managed_files()?);
    Ok(names)
}

/// Bytes of the files of an earlier run in a folder, by their lengths alone.
pub(super) fn managed_bytes(folder: &Path, listed: &[ManifestFile]) -> Result<u64, FolderError> {
    let names = listed_names(folder, listed)?.into_iter();
    let names = names.chain(Unfinished::in_folder(folder).managed_files()?);
    let length = |path: PathBuf| {
        let found = found_at(&path).map_err(FolderError::read(&path))?;
        Ok(found.map_or(0, |file| file.len()))
    };
    names.map(|name| length(folder.join(name))).sum()
}

/// Listed names that a run may write, each once. Other names are left out, so that no other file is touched,
/// whatever a manifest or a journal lists.
fn listed_names(folder: &Path, listed: &[ManifestFile]) -> Result<Vec<String>, FolderError> {
    let copies = folder.join("inputs");
    let has_copies = is_folder(&copies).map_err(FolderError::read(&copies))?;
    let is_copy = |name: &str| has_copies && name.strip_prefix("inputs/").is_some_and(is_plain);
    let is_own = |name: &String| *name == CASE || is_copy(name) || result_files().any(|own| own == *name);
    let names = listed.iter().map(|file| file.name.clone());
    let mut names: Vec<String> = names.filter(is_own).collect();
    names.sort();
    names.dedup();
    Ok(names)
}

/// Whether a file exists and is unchanged since it was listed.
pub(super) fn is_as_listed(folder: &Path, name: &str, listed: &[ManifestFile]) -> std::io::Result<bool> {
    Ok(is_one_of(folder, name, listed)?.unwrap_or(false))
}

/// Whether a name is a file name without a folder, of a length that file systems allow.
fn is_plain(name: &str) -> bool {
    const LONGEST: usize = 255;
    let mut parts = Path::new(name).components();
    matches!((parts.next(), parts.next()), (Some(Component::Normal(_)), None))
        && !name.contains(['/', '\\', '\0'])
        && name.len() <= LONGEST
}

/// Refuses files at the names that a run will write, unless they are `managed`; and a hidden subfolder that
/// is not slipfront's.
pub(super) fn refuse_unmanaged(
    folder: &Path,
    names: impl Iterator<Item = String>,
    managed: &[String],
    listed: &[ManifestFile],
) -> Result<(), FolderError> {
    // A dangling link also counts.
    let found = |path: &Path| found_at(path).map_err(FolderError::read(path));
    for name in names.filter(|name| !managed.contains(name)) {
        let path = folder.join(&name);
        if let Some(above) = path.parent().filter(|parent| *parent != folder)
            && found(above)?.is_some_and(|above| !above.is_dir())
        {
            let path = above.to_owned();
            return Err(FolderError::Foreign { path });
        }
        if found(&path)?.is_none() {
            continue;
        }
        return Err(if listed.iter().any(|file| file.name == name) {
            FolderError::Edited { path }
        } else {
            FolderError::Foreign { path }
        });
    }
    let unfinished = Unfinished::in_folder(folder);
    if found(unfinished.path())?.is_some() && !unfinished.is_managed()? {
        let path = unfinished.path().to_owned();
        return Err(FolderError::Foreign { path });
    }
    Ok(())
}

/// Removes these files of a run from a folder, where they exist, and then `inputs/` if it is empty.
pub(super) fn remove_files(
    folder: &Path,
    names: impl IntoIterator<Item = impl AsRef<Path>>,
) -> Result<(), FolderError> {
    for name in names {
        remove_if_there(&folder.join(name)).map_err(FolderError::unwritable(folder))?;
    }
    // The folder stays if it has a file of somebody else.
    let _ = std::fs::remove_dir(folder.join("inputs"));
    Ok(())
}
