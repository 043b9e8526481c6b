//! Holds what stands in a results folder against what was written there, or against what is written now.
//!
//! A run folder is held against its manifest, and against the files of a repeated run; a study folder against the
//! tables and pictures that its records give.

use std::collections::{BTreeSet, HashSet};
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};

use thiserror::Error;

use crate::manifest::{Manifest, ManifestError, ManifestFile};
use crate::names::{MANIFEST, RUNS};
use crate::run_folder::contents::is_of_interrupted_run;
use crate::run_folder::error::FolderError;
use crate::study;
use crate::study::{Plan, Records, RetainRuns, RunResult, StudyError, StudyFolder, StudyResults};
use slipfront_case::case_file::CaseFile;
use slipfront_case::disk::{TEXT_MAX_BYTES, read_limited};
use slipfront_case::text::{single_line, truncated};

/// What was found in a folder.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Verdict {
    /// What it holds, in words.
    pub what: String,
    /// What is not as it should be, a line each.
    pub differences: Vec<String>,
    /// What does no harm, a line each.
    pub notes: Vec<String>,
}

/// A folder that cannot be verified.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum VerifyError {
    #[error("{} is no folder: name the folder of a run or a study", path.display())]
    NotAFolder { path: PathBuf },
    #[error(transparent)]
    Manifest(#[from] ManifestError),
    #[error(
        "{difference}: pictures of it would not show what was run; run its case again, or remove {} to draw the files \
        as they are",
        manifest.display()
    )]
    Changed { difference: String, manifest: PathBuf },
    #[error(
        "the study in {} lacks {runs} runs{}: finish it, or merge it with its other shards, and verify it then",
        path.display(),
        study::of_others(*others)
    )]
    Unfinished {
        path: PathBuf,
        runs: usize,
        others: usize,
    },
    #[error(transparent)]
    Study(#[from] StudyError),
    #[error("cannot make a folder to compare with: {0}; name one that is writable in TMPDIR")]
    Temporary(std::io::Error),
}

/// Verifies the folder of a run or of a study.
///
/// # Errors
/// When it is neither, or was not finished.
pub fn verify(folder: &Path) -> Result<Verdict, VerifyError> {
    if !folder.is_dir() {
        let path = folder.to_owned();
        return Err(VerifyError::NotAFolder { path });
    }
    if is_study(folder) {
        verify_study(folder)
    } else {
        verify_run(folder)
    }
}

/// Whether a study has been run in the folder.
pub fn is_study(folder: &Path) -> bool {
    study::is_study(folder) && folder.join(Records::FILE).exists()
}

/// Refuses files `which` of a finished run that are not as they were written; without a manifest nothing is known of them.
///
/// # Errors
/// When one differs, or the manifest is damaged.
pub fn expect_as_written(folder: &Path, which: impl Fn(&str) -> bool) -> Result<(), VerifyError> {
    let manifest = match Manifest::read(folder) {
        Ok(manifest) => manifest,
        Err(ManifestError::Missing { .. }) => return Ok(()),
        Err(error) => return Err(error.into()),
    };
    let mut files = manifest.files;
    files.retain(|file| which(&file.name));
    match compare(&files, folder, "were written").into_iter().next() {
        None => Ok(()),
        Some(difference) => Err(VerifyError::Changed {
            difference,
            manifest: folder.join(MANIFEST),
        }),
    }
}

fn verify_run(folder: &Path) -> Result<Verdict, VerifyError> {
    let manifest = match Manifest::read(folder) {
        Ok(manifest) => manifest,
        Err(error @ ManifestError::Missing { .. }) => return Err(error.into()),
        // A run folder it is, of which nothing else can be said.
        Err(error @ ManifestError::Damaged { .. }) => {
            return Ok(Verdict {
                differences: vec![error.to_string()],
                ..Verdict::default()
            });
        }
    };
    let mut differences = compare(&manifest.files, folder, "were written");
    differences.extend(unresolved(&folder.join("case.toml")));
    let listed = manifest.files.iter().map(|file| file.name.as_str());
    Ok(Verdict {
        what: format!(
            "{} files as {} wrote them, finished {}",
            manifest.files.len(),
            manifest.program(),
            truncated(&manifest.finished)
        ),
        differences,
        notes: strangers(folder, &listed.chain([MANIFEST]).collect(), &["inputs"]),
    })
}

/// Where the files of a folder differ from those listed, which for example `were written`.
pub fn compare(files: &[ManifestFile], folder: &Path, how: &str) -> Vec<String> {
    let difference = |file: &ManifestFile| {
        let path = folder.join(&file.name);
        let inside = |part| matches!(part, Component::Normal(_));
        if !Path::new(&file.name).components().all(inside) {
            return Some(single_line(&format!(
                "{} lies outside of its folder",
                path.display()
            )));
        }
        // A file of another length need not be read.
        let found = match std::fs::metadata(&path) {
            Ok(found) if found.is_file() && found.len() != file.bytes => {
                format!("differs: it has {} bytes where {} {how}", found.len(), file.bytes)
            }
            Ok(_) => match ManifestFile::of(folder, &file.name) {
                Ok(found) if found == *file => return None,
                Ok(_) => format!("differs: other bytes {how}"),
                Err(error) => format!("cannot be read: {error}"),
            },
            Err(error) if error.kind() == ErrorKind::NotFound => "is missing".to_owned(),
            Err(error) => format!("cannot be read: {error}"),
        };
        Some(single_line(&format!("{} {found}", path.display())))
    };
    files.iter().filter_map(difference).collect()
}

/// Why a resolved case is none, or resolves to another one.
fn unresolved(path: &Path) -> Option<String> {
    // One that is missing is named already.
    let text = read_limited(path, TEXT_MAX_BYTES).ok()?;
    let resolved = CaseFile::load(path, &[]).and_then(|case| case.to_toml());
    match resolved {
        Ok(resolved) if resolved.as_bytes() == text => None,
        Ok(_) => Some(format!("{} is not the resolved case that it was", path.display())),
        Err(error) => {
            let message = error.to_string();
            let line = message.lines().next().unwrap_or_default();
            Some(format!("{} is no case for this version: {line}", path.display()))
        }
    }
}

/// What stands in a folder, and in those of its `folders` that are ours, beside the names that are `known`.
fn strangers(folder: &Path, known: &BTreeSet<&str>, folders: &[&str]) -> Vec<String> {
    let names = |folder: &Path| -> Vec<String> {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        entries
            .map(|entry| entry.file_name().to_string_lossy().into_owned())
            .collect()
    };
    let inside = |own: &&str| -> Vec<String> {
        let files = names(&folder.join(own)).into_iter();
        files.map(|name| format!("{own}/{name}")).collect()
    };
    let mut found: Vec<String> = names(folder);
    found.retain(|name| !folders.contains(&name.as_str()));
    found.extend(folders.iter().flat_map(inside));
    found.retain(|name| !known.contains(name.as_str()));
    found.sort();
    let in_words = |name: String| {
        let path = folder.join(&name);
        single_line(&if is_of_interrupted_run(&name) {
            format!("{} was left by a run that was interrupted", path.display())
        } else {
            format!("{} is not slipfront's", path.display())
        })
    };
    found.into_iter().map(in_words).collect()
}

/// Makes tables and pictures of a study again from its records, and holds the folder against them; then its run
/// folders against their manifests.
fn verify_study(folder: &Path) -> Result<Verdict, VerifyError> {
    let mut verdict = Verdict::default();
    let made = study::study_of(folder).and_then(|file| Ok((Plan::new(&file, None)?, file)));
    let (plan, file) = match made {
        Ok(made) => made,
        Err(error) => {
            let message = error.to_string();
            let line = message.lines().next().unwrap_or_default();
            verdict.differences.push(format!(
                "{} is no study for this version: {line}",
                folder.join("study.toml").display()
            ));
            return Ok(verdict);
        }
    };
    let temporary = tempfile::tempdir().map_err(VerifyError::Temporary)?;
    let mut again = StudyFolder::open(temporary.path(), &file)?;
    again.records.merge(folder)?;
    let records = folder.join(Records::FILE);
    let (damaged, records) = (again.records.damaged, records.display());
    let results = match study::collect(&plan, &mut again.records) {
        Ok(results) => results,
        Err(StudyError::Missing { runs, others }) if damaged == 0 => {
            let path = folder.to_owned();
            return Err(VerifyError::Unfinished { path, runs, others });
        }
        // What its tables should be is lost with the damaged lines.
        Err(StudyError::Missing { .. }) => {
            let damage = format!("{records} differs: {damaged} lines of it are damaged");
            verdict.differences.push(damage);
            return Ok(verdict);
        }
        Err(error) => return Err(error.into()),
    };
    study::write(&plan, &results, &again)?;
    let mut files = files_below(temporary.path(), "").map_err(VerifyError::Temporary)?;
    files.retain(|file| file.name != Records::FILE);
    verdict
        .differences
        .extend(compare(&files, folder, "follow from the records"));
    let known = files.iter().map(|file| file.name.as_str());
    let known = known.chain([Records::FILE, RUNS]).collect();
    verdict.notes = strangers(folder, &known, &["inputs"]);
    if damaged > 0 {
        let damage =
            format!("{records} has {damaged} damaged lines, whose runs are recorded once more or not needed");
        verdict.notes.push(damage);
    }
    let kept = verify_kept(folder, &plan, &results, &mut verdict)?;
    verdict.what = format!(
        "tables and pictures as its {} recorded runs give them, {kept} run folders as they were written",
        again.records.len()
    );
    Ok(verdict)
}

/// Verifies the run folders that a study has kept; gives their number.
fn verify_kept(
    folder: &Path,
    plan: &Plan,
    results: &StudyResults,
    verdict: &mut Verdict,
) -> Result<usize, VerifyError> {
    let runs = folder.join(RUNS);
    let unreadable = |source| {
        let path = runs.clone();
        VerifyError::Study(FolderError::Read { path, source }.into())
    };
    let entries = match std::fs::read_dir(&runs) {
        Ok(entries) => Some(entries),
        Err(error) if error.kind() == ErrorKind::NotFound => None,
        Err(error) => return Err(unreadable(error)),
    };
    let done = results.runs.iter().filter(|(_, result)| match result.as_ref() {
        RunResult::Done(_) => true,
        // Of a run that failed the case alone is kept.
        RunResult::Failed(_) => false,
    });
    let done: HashSet<String> = done.map(|(run, _)| plan.folder_name(*run)).collect();
    let (mut kept, mut missing) = (0, done.clone());
    for entry in entries.into_iter().flatten() {
        let entry = entry.map_err(unreadable)?;
        let is_done = missing.remove(&*entry.file_name().to_string_lossy());
        if !is_done && !entry.path().is_dir() {
            continue;
        }
        match verify_run(&entry.path()) {
            Ok(of_run) => {
                verdict.differences.extend(of_run.differences);
                verdict.notes.extend(of_run.notes);
                kept += 1;
            }
            Err(error) if is_done => verdict.differences.push(error.to_string()),
            Err(_) => {}
        }
    }
    // They may have been removed on purpose, or have run before the study was told to keep them.
    if plan.settings.keep == RetainRuns::All && !missing.is_empty() {
        verdict.notes.push(format!(
            "{} of {} runs have no folder in {}, where the study keeps all",
            missing.len(),
            done.len(),
            runs.display()
        ));
    }
    Ok(kept)
}

/// Every file below a folder, named by its path from there.
fn files_below(folder: &Path, prefix: &str) -> std::io::Result<Vec<ManifestFile>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder.join(prefix))? {
        let entry = entry?;
        let name = Path::new(prefix)
            .join(entry.file_name())
            .to_string_lossy()
            .into_owned();
        if entry.file_type()?.is_dir() {
            files.extend(files_below(folder, &name)?);
        } else {
            files.push(ManifestFile::of(folder, &name)?);
        }
    }
    files.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(files)
}
