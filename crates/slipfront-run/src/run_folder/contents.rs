//! Which files of a run folder are slipfront's own: those that may be replaced; and copies of them all.

use std::path::{Component, Path};

use slipfront_case::case::Input;
use slipfront_case::case_file::CaseFile;
use slipfront_case::disk::{is_folder, open_regular, remove_if_there, sync_folder};

use super::error::FolderError;
use super::unfinished::Unfinished;
use crate::manifest::{Manifest, ManifestFile};
use crate::names::{CASE, CHECKPOINT, FIELDS, MANIFEST, PREVIOUS, SERIES, SUMMARY, UNFINISHED};
use crate::pictures::{RUN_PICTURES, RunPicture};

/// The files that a run leaves beside its case and the copies in `inputs/`, the manifest first.
pub(super) fn result_files() -> impl Iterator<Item = String> {
    let files = [MANIFEST, SUMMARY, SERIES, FIELDS].map(str::to_owned);
    files
        .into_iter()
        .chain(RUN_PICTURES.iter().flat_map(RunPicture::files))
}

/// The files of an earlier run in a folder, complete or not, in the order in which they may be removed: the manifest
/// first, so that the folder does not look complete; the case last, since it lists the copies of a run that was
/// interrupted. Without manifest and resolved case nothing outside of the hidden subfolder belongs to a run.
pub(super) fn managed_files(
    folder: &Path,
    manifest: Option<&Manifest>,
    case: Option<&CaseFile>,
) -> Vec<String> {
    let listed = manifest.map(|manifest| manifest.files.as_slice());
    let is_result = |name: &String| match listed {
        Some(listed) => name == MANIFEST || listed.iter().any(|file| file.name == *name),
        // The run is not complete: any of them may have been written.
        None => case.is_some(),
    };
    let mut names: Vec<String> = result_files().filter(is_result).collect();
    if is_folder(&folder.join("inputs")) {
        names.extend(copies(listed, case));
    }
    let unfinished = Unfinished::of(folder);
    if unfinished.is_managed() {
        names.extend(unfinished.files());
    }
    // A case that another version wrote may not be a resolved one today.
    if case.is_some() || listed.is_some_and(|listed| is_listed(folder, CASE, listed)) {
        names.push(CASE.to_owned());
    }
    names
}

/// Whether a file is as a manifest lists it. One of another length is not read: it may be huge.
fn is_listed(folder: &Path, name: &str, listed: &[ManifestFile]) -> bool {
    let bytes = std::fs::metadata(folder.join(name)).map(|file| file.len());
    let mut listed = listed.iter().filter(|file| file.name == name);
    listed.any(|file| {
        bytes.as_ref().is_ok_and(|bytes| *bytes == file.bytes)
            && ManifestFile::of(folder, name).is_ok_and(|now| now == *file)
    })
}

/// The copies in `inputs/` that manifest and case name.
fn copies(listed: Option<&[ManifestFile]>, case: Option<&CaseFile>) -> Vec<String> {
    let mut case = case.cloned();
    let read = case.iter_mut().flat_map(CaseFile::files_mut);
    let mut copies: Vec<String> = read.map(|name| name.clone()).collect();
    copies.extend(listed.into_iter().flatten().map(|file| file.name.clone()));
    copies.sort();
    copies.dedup();
    // A damaged manifest must not cause files to be removed elsewhere.
    copies.retain(|name| name.strip_prefix("inputs/").is_some_and(is_plain));
    copies
}

/// Whether this is the name of a file, without a folder, that a file system can hold.
fn is_plain(name: &str) -> bool {
    const LONGEST: usize = 255;
    let mut parts = Path::new(name).components();
    matches!((parts.next(), parts.next()), (Some(Component::Normal(_)), None))
        && !name.contains(['/', '\\', '\0'])
        && name.len() <= LONGEST
}

/// Refuses files that stand where those of a run will be written, with copies of these `inputs`, and are not `managed`.
pub(super) fn refuse_foreign(folder: &Path, managed: &[String], inputs: &[Input]) -> Result<(), FolderError> {
    let checkpoints = [CHECKPOINT, PREVIOUS].map(|name| format!("{UNFINISHED}/{name}"));
    let inputs = inputs.iter().map(|input| input.name.clone());
    let mut names: Vec<String> = result_files().collect();
    names.extend([CASE.to_owned()].into_iter().chain(checkpoints).chain(inputs));
    // A link counts even if nothing is at its end.
    let exists = |path: &Path| path.symlink_metadata().is_ok();
    for name in names.iter().filter(|name| !managed.contains(name)) {
        let file = folder.join(name);
        let above = file.parent().filter(|parent| *parent != folder && exists(parent));
        if let Some(path) = above.filter(|parent| !is_folder(parent)).map(Path::to_owned) {
            return Err(FolderError::Foreign { path });
        }
        if exists(&file) {
            return Err(FolderError::Foreign { path: file });
        }
    }
    let unfinished = Unfinished::of(folder);
    if exists(unfinished.path()) && !unfinished.is_managed() {
        let path = unfinished.path().to_owned();
        return Err(FolderError::Foreign { path });
    }
    Ok(())
}

/// Removes these files of a run from a folder, where they exist, and `inputs/` if it is empty then.
pub(super) fn remove_files(
    folder: &Path,
    names: impl IntoIterator<Item = impl AsRef<Path>>,
) -> Result<(), FolderError> {
    for name in names {
        remove_if_there(&folder.join(name)).map_err(FolderError::unwritable(folder))?;
    }
    // A file of somebody else keeps it.
    let _ = std::fs::remove_dir(folder.join("inputs"));
    Ok(())
}

/// Copies the files of a run folder. Its case and its manifest come last: without them, the copy is not taken for whole.
pub(crate) fn copy_run(from: &Path, to: &Path) -> Result<(), FolderError> {
    let failed = |source| FolderError::Copy {
        from: from.to_owned(),
        to: to.to_owned(),
        source,
    };
    std::fs::create_dir_all(to).map_err(failed)?;
    let unfinished = Unfinished::of(to);
    unfinished.create()?;
    unfinished
        .clear_temporary()
        .and_then(|()| copy_files(from, to, &unfinished))
        .and_then(|()| unfinished.remove())
        .map_err(failed)
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
    unfinished.write(to, |to| std::io::copy(&mut from, to).map(drop))
}
