//! Which files of a run folder are slipfront's own: those that may be replaced.

use std::path::{Component, Path};

use super::error::FolderError;
use crate::manifest::{Manifest, ManifestFile};
use crate::names::{CASE, CHECKPOINT, CHECKPOINT_BEGINNING, MANIFEST, PREVIOUS};
use slipfront_case::case_file::CaseFile;
use slipfront_case::disk::{
    TEXT_MAX_BYTES, begins_with, is_folder, is_unfinished, read_limited, remove_if_there, unfinished,
};

/// What a run leaves beside its case and the copies in `inputs/`, the manifest first.
const RESULTS: [&str; 8] = [
    MANIFEST,
    "summary.json",
    "series.csv",
    "fields.nc",
    "friction.svg",
    "friction.png",
    "stress.svg",
    "stress.png",
];

/// The case in a folder if it is a resolved one, byte for byte. Another was not written by a run, and what it names may be
/// the only copy that there is.
pub(super) fn resolved_case(folder: &Path) -> Option<CaseFile> {
    let bytes = read_limited(&folder.join(CASE), TEXT_MAX_BYTES).ok()?;
    let text = String::from_utf8(bytes).ok()?;
    let case = CaseFile::parse(&text, CASE, &[]).ok()?;
    (case.to_toml().ok()? == text).then_some(case)
}

/// Files of an earlier run in this folder, finished or not: its manifest first, its case last, which until then tells
/// the copies of a run that was stopped. Where there is neither, nothing is a run's, whatever it is called.
fn own_files(path: &Path) -> Vec<String> {
    let manifest = read_limited(&path.join(MANIFEST), TEXT_MAX_BYTES).ok();
    let manifest = manifest.and_then(|bytes| serde_json::from_slice::<Manifest>(&bytes).ok());
    let mut case = resolved_case(path);
    let listed = manifest.map(|manifest| manifest.files);
    let is_result = |name: &&str| match &listed {
        Some(listed) => *name == MANIFEST || listed.iter().any(|file| file.name == *name),
        // Not complete: how far it had come is not known.
        None => case.is_some(),
    };
    // One that another version wrote may look otherwise today.
    let as_listed = |listed: &Vec<ManifestFile>| {
        let now = ManifestFile::of(path, CASE);
        now.is_ok_and(|now| listed.contains(&now))
    };
    let is_own_case = case.is_some() || listed.as_ref().is_some_and(as_listed);
    let results = RESULTS.into_iter().filter(is_result).map(str::to_owned);
    let mut names: Vec<String> = results.collect();
    // A name alone may be anybody's.
    let checkpoints = [CHECKPOINT, PREVIOUS].into_iter();
    let checkpoints = checkpoints.filter(|name| begins_with(&path.join(name), CHECKPOINT_BEGINNING));
    names.extend(checkpoints.map(str::to_owned));
    let read = case.iter_mut().flat_map(CaseFile::files_mut);
    let mut copies: Vec<String> = read.map(|(_, name)| name.clone()).collect();
    copies.extend(listed.into_iter().flatten().map(|file| file.name));
    copies.sort();
    copies.dedup();
    // They are only believed about the folder of copies: damage must not make us delete elsewhere.
    copies.retain(|name| name.strip_prefix("inputs/").is_some_and(is_plain));
    names.extend(unfinished(path, ""));
    if is_folder(&path.join("inputs")) {
        names.extend(copies);
        names.extend(unfinished(path, "inputs/"));
    }
    names.extend(is_own_case.then(|| CASE.to_owned()));
    names
}

/// Whether this is the name of a file, without any way: not that of a folder above, nor one that no file can have.
fn is_plain(name: &str) -> bool {
    const LONGEST: usize = 255;
    let mut parts = Path::new(name).components();
    matches!((parts.next(), parts.next()), (Some(Component::Normal(_)), None))
        && !name.contains(['/', '\\', '\0'])
        && name.len() <= LONGEST
}

/// Refuses files that stand where those of a run will be written, with copies of these `inputs`, and are not of an earlier
/// run.
pub(super) fn refuse_foreign<'n>(
    path: &Path,
    inputs: impl Iterator<Item = &'n str>,
) -> Result<(), FolderError> {
    let own = own_files(path);
    let names = RESULTS
        .into_iter()
        .chain([CASE, CHECKPOINT, PREVIOUS])
        .chain(inputs);
    for name in names.filter(|name| !own.iter().any(|own| own == name)) {
        let file = path.join(name);
        let parent = file.parent().filter(|parent| *parent != path);
        if let Some(parent) = parent.filter(|parent| parent.symlink_metadata().is_ok() && !is_folder(parent))
        {
            let path = parent.to_owned();
            return Err(FolderError::Foreign { path });
        }
        // A link counts even if it leads nowhere.
        if file.symlink_metadata().is_ok() {
            return Err(FolderError::Foreign { path: file });
        }
    }
    Ok(())
}

/// Whether a name in a run folder is that of a checkpoint, or of a file that was being written.
pub(crate) fn is_of_interrupted_run(name: &str) -> bool {
    let plain = name.rsplit('/').next().unwrap_or(name);
    name == CHECKPOINT || name == PREVIOUS || is_unfinished(plain)
}

/// Removes the files of an earlier run from this folder.
pub(super) fn remove_own(path: &Path) -> Result<(), FolderError> {
    // The manifest goes first: from now on the folder does not look complete.
    remove(path, own_files(path))?;
    // Gone if it held our inputs only; a foreign file keeps it.
    std::fs::remove_dir(path.join("inputs")).ok();
    Ok(())
}

/// Removes the results of a run, and what a kill left of files that were being written.
pub(super) fn remove_results(path: &Path) -> Result<(), FolderError> {
    remove(path, RESULTS.map(str::to_owned))?;
    remove(path, unfinished(path, ""))?;
    if is_folder(&path.join("inputs")) {
        remove(path, unfinished(path, "inputs/"))?;
    }
    Ok(())
}

/// Removes the checkpoints of a run.
pub(super) fn remove_checkpoints(path: &Path) -> Result<(), FolderError> {
    remove(path, [CHECKPOINT, PREVIOUS].map(str::to_owned))
}

/// Removes these files from a folder, where they are.
fn remove(folder: &Path, names: impl IntoIterator<Item = String>) -> Result<(), FolderError> {
    for name in names {
        remove_if_there(&folder.join(name)).map_err(|source| FolderError::Unwritable {
            path: folder.to_owned(),
            source,
        })?;
    }
    Ok(())
}

/// Bytes of an earlier run in this folder, which [`RunFolder::prepare`](super::RunFolder::prepare) would remove with `force`.
pub fn own_bytes(path: &Path) -> u64 {
    let length = |name| std::fs::symlink_metadata(path.join(name)).map_or(0, |file| file.len());
    own_files(path).into_iter().map(length).sum()
}
