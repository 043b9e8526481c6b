//! Compares the files in the folder of a run with its manifest, or with the files of a repeated run.

use std::collections::BTreeSet;
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::AtomicBool;

use thiserror::Error;

use crate::folder_error::FolderError;
use crate::manifest::{ManifestError, ManifestFile};
use crate::names::{CASE, MANIFEST, RO_CRATE, UNFINISHED};
use crate::program;
use crate::run_folder::inspection::{CaseDefect, Inspection};
use crate::run_folder::unfinished::Unfinished;
use slipfront_base::disk::read_limited;
use slipfront_base::number_format::count;
use slipfront_base::text::{single_line, truncated};
use slipfront_base::unfinished::is_unfinished;

/// Largest number of bytes of a description that is read, enough for thousands of runs with their keys.
pub const DESCRIPTION_MAX_BYTES: u64 = 256 << 20;

/// Result of verifying a folder.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FolderCheck {
    /// Content of the folder in words.
    pub what: String,
    /// Differences that are errors, a line each.
    pub differences: Vec<String>,
    /// Differences that do no harm, a line each.
    pub notes: Vec<String>,
    /// Reason why the files, although unchanged, were not derived again from the recorded runs.
    pub not_derived: Option<String>,
}

/// A folder that cannot be verified.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum VerifyError {
    #[error("{path} is not a folder: give the folder of a run or a study")]
    NotAFolder { path: PathBuf },
    #[error(transparent)]
    Manifest(#[from] ManifestError),
    #[error(
        "{difference}: pictures would not show the original run; run its case again, or remove {manifest} to draw the changed \
        files"
    )]
    Changed { difference: String, manifest: PathBuf },
    #[error(transparent)]
    Folder(#[from] FolderError),
    #[error("cannot create a temporary folder for the comparison: {0}; set TMPDIR to a writable folder")]
    Temporary(std::io::Error),
}

/// Returns an error if a file of a complete run, out of those that `which` chooses, has changed since it was
/// written. Without a manifest, no file can be checked.
pub fn expect_as_written(run: &Inspection, which: impl Fn(&str) -> bool) -> Result<(), VerifyError> {
    let manifest = match run.manifest() {
        Ok(manifest) => manifest,
        Err(ManifestError::Missing { .. }) => return Ok(()),
        Err(error) => return Err(error.into()),
    };
    let files = manifest.files.iter().filter(|file| which(&file.name));
    let never = AtomicBool::new(false);
    match differences(files, &run.path, "were written", &never)
        .into_iter()
        .next()
    {
        None => Ok(()),
        Some(difference) => {
            let manifest = run.path.join(MANIFEST);
            Err(VerifyError::Changed { difference, manifest })
        }
    }
}

/// Compares the files of a complete run with its manifest.
///
/// # Errors
/// When the folder has no manifest, or the system cannot determine what it holds. After a stop, the check
/// is not complete.
pub fn verify_run(run: &Inspection, stop: &AtomicBool) -> Result<FolderCheck, VerifyError> {
    let mut check = FolderCheck::default();
    let manifest = match run.manifest() {
        Ok(manifest) => manifest,
        Err(error @ ManifestError::Missing { .. }) => return Err(error.into()),
        // It is a run folder, but nothing else can be said about it.
        Err(error @ (ManifestError::Unreadable { .. } | ManifestError::Damaged { .. })) => {
            check.differences.push(error.to_string());
            return Ok(check);
        }
    };
    check.what = format!(
        "{} unchanged since {} wrote them, finished {}",
        count(manifest.files.len(), "file"),
        manifest.program(),
        truncated(&manifest.finished)
    );
    check.differences = differences(&manifest.files, &run.path, "were written", stop);
    // Another version may have written other keys; its results are still what it wrote.
    let (as_difference, as_note) = match unresolved(run) {
        unresolved if manifest.build == program::this_build() => (unresolved, None),
        unresolved => (None, unresolved),
    };
    check.differences.extend(as_difference);
    let listed = manifest.files.iter().map(|file| file.name.as_str());
    let has_unfinished = Unfinished::in_folder(&run.path).is_managed()?;
    // An interrupted `slipfront plot` may have left a hidden file next to a picture.
    let is_left = |name: &str| match name {
        UNFINISHED => has_unfinished,
        name => is_unfinished(name),
    };
    let (described, outdated) = description_in(&run.path, &manifest.checksum);
    let listed = listed.chain([MANIFEST]).chain(described).collect();
    check.notes = unlisted_files(&run.path, &listed, is_left);
    check.notes.extend(outdated);
    check.notes.extend(as_note);
    Ok(check)
}

/// The name of the description of a folder for data repositories, if there is one that can be read. Also a
/// note if it describes other results than those with this seal of their list of checksums: a description
/// contains the seal.
pub fn description_in(folder: &Path, seal: &str) -> (Option<&'static str>, Option<String>) {
    let path = folder.join(RO_CRATE);
    let Ok(text) = read_limited(&path, DESCRIPTION_MAX_BYTES) else {
        return (None, None);
    };
    let seal = seal.as_bytes();
    let is_current = seal.is_empty() || text.windows(seal.len()).any(|bytes| bytes == seal);
    let outdated = || {
        single_line(&format!(
            "{} does not describe the results in the folder: `slipfront export --ro-crate --force` writes it again",
            path.display()
        ))
    };
    (Some(RO_CRATE), (!is_current).then(outdated))
}

/// Inspects the folder of a run, which must be a folder that can be listed.
pub fn inspect(folder: &Path) -> Result<Inspection, VerifyError> {
    match std::fs::metadata(folder) {
        Ok(found) if found.is_dir() => {}
        Err(error) if error.kind() != ErrorKind::NotFound => {
            return Err(FolderError::read(folder)(error).into());
        }
        _ => {
            let path = folder.to_owned();
            return Err(VerifyError::NotAFolder { path });
        }
    }
    Ok(Inspection::read(folder)?)
}

/// Differences between the files of a folder and the listed ones, a sentence for each; `how` is the end of
/// the sentence, such as `were written`. After a stop, some files are not checked.
pub fn differences<'f>(
    files: impl IntoIterator<Item = &'f ManifestFile>,
    folder: &Path,
    how: &str,
    stop: &AtomicBool,
) -> Vec<String> {
    let difference = |file: &ManifestFile| {
        let path = folder.join(&file.name);
        let inside = |part| matches!(part, Component::Normal(_));
        if !Path::new(&file.name).components().all(inside) {
            let outside = format!("{} lies outside of its folder", path.display());
            return Some(single_line(&outside));
        }
        // A file of another length need not be read.
        let found = match std::fs::metadata(&path) {
            Ok(found) if found.is_file() && found.len() != file.bytes => {
                format!("differs: it has {} bytes where {} {how}", found.len(), file.bytes)
            }
            Ok(_) => match ManifestFile::read_until(folder, &file.name, stop) {
                Ok(found) if found == *file => return None,
                Ok(_) => format!("differs: other bytes {how}"),
                Err(error) => format!("cannot be read: {error}"),
            },
            Err(error) if error.kind() == ErrorKind::NotFound => "is missing".to_owned(),
            Err(error) => format!("cannot be read: {error}"),
        };
        Some(single_line(&format!("{} {found}", path.display())))
    };
    files.into_iter().filter_map(difference).collect()
}

/// Reason why the case of a run is not a resolved case for this version.
fn unresolved(run: &Inspection) -> Option<String> {
    let path = run.path.join(CASE);
    match &run.case {
        // A case that cannot be read is already among the differences.
        Ok(_) | Err(CaseDefect::Unreadable(_)) => None,
        Err(CaseDefect::NotResolved(_)) => {
            Some(format!("{} is not the original resolved case", path.display()))
        }
        Err(CaseDefect::Invalid(error)) => {
            let line = first_line(error);
            Some(format!(
                "{} is not a valid case for this version: {line}",
                path.display()
            ))
        }
    }
}

/// First line of a message, for a list with one line per entry.
pub fn first_line(error: &impl ToString) -> String {
    error.to_string().lines().next().unwrap_or_default().to_owned()
}

/// A note on each entry of a folder, and on each file below its `inputs/`, that is not `listed`.
pub fn unlisted_files(folder: &Path, listed: &BTreeSet<&str>, is_left: impl Fn(&str) -> bool) -> Vec<String> {
    let mut found = Vec::new();
    let mut folders = vec![String::new()];
    while let Some(prefix) = folders.pop() {
        let entries = std::fs::read_dir(folder.join(&prefix))
            .into_iter()
            .flatten()
            .flatten();
        for entry in entries {
            let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
            let is_of_copies = name == "inputs" || name.starts_with("inputs/");
            if is_of_copies && entry.file_type().is_ok_and(|found| found.is_dir()) {
                folders.push(format!("{name}/"));
            } else {
                found.push(name);
            }
        }
    }
    found.retain(|name| !listed.contains(name.as_str()));
    found.sort();
    let in_words = |name: String| {
        let path = folder.join(&name);
        single_line(&if is_left(&name) {
            format!("{} was left by a run that was interrupted", path.display())
        } else {
            format!("{} is not slipfront's", path.display())
        })
    };
    found.into_iter().map(in_words).collect()
}
