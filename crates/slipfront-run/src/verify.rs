//! Holds what stands in a results folder against what was written there, or against what is written now.
//!
//! A run folder is held against its manifest, and against the files of a repeated run; a study folder against the
//! tables and pictures that its records give.

use std::collections::{BTreeSet, HashSet};
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};

use thiserror::Error;

use crate::manifest::{ManifestError, ManifestFile};
use crate::names::{CASE, MANIFEST, RUNS, UNFINISHED};
use crate::run_folder::error::FolderError;
use crate::run_folder::inspection::{CaseDefect, Inspection};
use crate::run_folder::unfinished::Unfinished;
use crate::study;
use crate::study::{Plan, Records, RetainRuns, StudyError, StudyFolder, StudyResults};
use slipfront_case::number_format::{are, count};
use slipfront_case::text::{single_line, truncated};
use slipfront_case::unfinished::{TemporaryFolder, is_unfinished};

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
    #[error("{path} is no folder: name the folder of a run or a study")]
    NotAFolder { path: PathBuf },
    #[error(transparent)]
    Manifest(#[from] ManifestError),
    #[error(
        "{difference}: pictures of it would not show what was run; run its case again, or remove {manifest} to draw the files \
        as they are"
    )]
    Changed { difference: String, manifest: PathBuf },
    #[error(
        "the study in {path} lacks {}{}: finish it, or merge it with its other shards, and verify it then",
        count(*runs, "run"),
        study::of_others(*others)
    )]
    Unfinished {
        path: PathBuf,
        runs: usize,
        others: usize,
    },
    #[error(transparent)]
    Study(#[from] StudyError),
    #[error(transparent)]
    Folder(#[from] FolderError),
    #[error("cannot make a folder to compare with: {0}; name one that is writable in TMPDIR")]
    Temporary(std::io::Error),
}

/// Verifies the folder of a run or of a study that was finished.
pub fn verify(folder: &Path) -> Result<Verdict, VerifyError> {
    if is_study(folder) {
        verify_study(folder)
    } else {
        verify_run(&inspect(folder)?)
    }
}

/// Whether a study has been run in the folder.
pub fn is_study(folder: &Path) -> bool {
    study::is_study(folder) && folder.join(Records::FILE).exists()
}

/// Refuses files `which` of a complete run that are not as they were written; without a manifest nothing is known of them.
pub fn expect_as_written(run: &Inspection, which: impl Fn(&str) -> bool) -> Result<(), VerifyError> {
    let manifest = match run.manifest() {
        Ok(manifest) => manifest,
        Err(ManifestError::Missing { .. }) => return Ok(()),
        Err(error) => return Err(error.into()),
    };
    let files = manifest.files.iter().filter(|file| which(&file.name));
    match differences(files, &run.path, "were written").into_iter().next() {
        None => Ok(()),
        Some(difference) => {
            let manifest = run.path.join(MANIFEST);
            Err(VerifyError::Changed { difference, manifest })
        }
    }
}

/// Compares the files of a complete run with its manifest.
pub fn verify_run(run: &Inspection) -> Result<Verdict, VerifyError> {
    let mut verdict = Verdict::default();
    let manifest = match run.manifest() {
        Ok(manifest) => manifest,
        Err(error @ ManifestError::Missing { .. }) => return Err(error.into()),
        // It is a run folder, of which nothing else can be said.
        Err(error @ (ManifestError::Unreadable { .. } | ManifestError::Damaged { .. })) => {
            verdict.differences.push(error.to_string());
            return Ok(verdict);
        }
    };
    verdict.what = format!(
        "{} as {} wrote them, finished {}",
        count(manifest.files.len(), "file"),
        manifest.program(),
        truncated(&manifest.finished)
    );
    verdict.differences = differences(&manifest.files, &run.path, "were written");
    verdict.differences.extend(unresolved(run));
    let listed = manifest.files.iter().map(|file| file.name.as_str());
    let has_unfinished = Unfinished::of(&run.path).is_managed()?;
    // A picture that `slipfront plot` was writing has a hidden file beside it.
    let is_left = |name: &str| match name {
        UNFINISHED => has_unfinished,
        name => is_unfinished(name),
    };
    verdict.notes = unlisted_files(&run.path, &listed.chain([MANIFEST]).collect(), is_left);
    Ok(verdict)
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
    Ok(Inspection::of(folder)?)
}

/// Where the files of a folder differ from those listed, which for example `were written`: a sentence for each.
pub fn differences<'f>(
    files: impl IntoIterator<Item = &'f ManifestFile>,
    folder: &Path,
    how: &str,
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
    files.into_iter().filter_map(difference).collect()
}

/// Why the case of a run is not a resolved case for this version.
fn unresolved(run: &Inspection) -> Option<String> {
    let path = run.path.join(CASE);
    match &run.case {
        // One that cannot be read is among the differences already.
        Ok(_) | Err(CaseDefect::Unreadable(_)) => None,
        Err(CaseDefect::NotResolved(_)) => {
            Some(format!("{} is not the resolved case that it was", path.display()))
        }
        Err(CaseDefect::Invalid(error)) => {
            let line = first_line(error);
            Some(format!("{} is no case for this version: {line}", path.display()))
        }
    }
}

fn first_line(error: &impl ToString) -> String {
    error.to_string().lines().next().unwrap_or_default().to_owned()
}

/// A note on each entry of a folder and of its `inputs/` that is not among the `listed`.
fn unlisted_files(folder: &Path, listed: &BTreeSet<&str>, is_left: impl Fn(&str) -> bool) -> Vec<String> {
    let names = |folder: &Path| {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned())
    };
    let inputs = names(&folder.join("inputs")).map(|name| format!("inputs/{name}"));
    let own = names(folder).filter(|name| name != "inputs");
    let mut found: Vec<String> = own.chain(inputs).collect();
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

/// Makes tables and pictures of a study again from its records, and holds the folder against them; then its run
/// folders against their manifests.
fn verify_study(folder: &Path) -> Result<Verdict, VerifyError> {
    let mut verdict = Verdict::default();
    let made = study::study_of(folder).and_then(|file| Ok((Plan::new(&file, None)?, file)));
    let (plan, file) = match made {
        Ok(made) => made,
        Err(error) => {
            let (path, line) = (folder.join("study.toml"), first_line(&error));
            let difference = format!("{} is no study for this version: {line}", path.display());
            verdict.differences.push(difference);
            return Ok(verdict);
        }
    };
    plan.check_memory(0)?;
    let temporary = TemporaryFolder::new(folder).map_err(VerifyError::Temporary)?;
    let mut again = StudyFolder::open(temporary.path(), &file)?;
    again.records.merge(folder)?;
    let records = folder.join(Records::FILE);
    let (damaged, records) = (again.records.damaged, records.display());
    let results = match study::collect(&plan, &again.records) {
        Ok(results) => results,
        Err(StudyError::Missing { runs, others }) if damaged == 0 => {
            let path = folder.to_owned();
            return Err(VerifyError::Unfinished { path, runs, others });
        }
        // What its tables should be is lost with the damaged lines.
        Err(StudyError::Missing { .. }) => {
            let damage = format!("{records} differs: it has {}", count(damaged, "damaged line"));
            verdict.differences.push(damage);
            return Ok(verdict);
        }
        Err(error) => return Err(error.into()),
    };
    study::write(&plan, &results, &again)?;
    let mut files = files_below(temporary.path(), "").map_err(VerifyError::Temporary)?;
    files.retain(|file| file.name != Records::FILE);
    let differ = differences(&files, folder, "follow from the records");
    verdict.differences.extend(differ);
    let is_left = |name: &str| name.rsplit('/').next().is_some_and(is_unfinished);
    let known = files.iter().map(|file| file.name.as_str());
    let known = known.chain([Records::FILE, RUNS]).collect();
    verdict.notes = unlisted_files(folder, &known, is_left);
    if damaged > 0 {
        let damage = format!(
            "{records} has {}, whose runs are recorded once more or not needed",
            count(damaged, "damaged line")
        );
        verdict.notes.push(damage);
    }
    let kept = verify_kept(folder, &plan, &results, &mut verdict)?;
    verdict.what = format!(
        "tables and pictures as its {} give them, {} as they were written",
        count(again.records.len(), "recorded run"),
        count(kept, "run folder")
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
    let unreadable = FolderError::read(&runs);
    let entries = match std::fs::read_dir(&runs) {
        Ok(entries) => Some(entries),
        Err(error) if error.kind() == ErrorKind::NotFound => None,
        Err(error) => return Err(unreadable(error).into()),
    };
    // Of a run that failed the case alone is kept.
    let done = results.runs.iter().filter(|(_, result)| result.is_ok());
    let done: HashSet<String> = done.map(|(run, _)| plan.folder_name(*run)).collect();
    let (mut kept, mut missing) = (0, done.clone());
    for entry in entries.into_iter().flatten() {
        let entry = entry.map_err(&unreadable)?;
        let is_done = missing.remove(&*entry.file_name().to_string_lossy());
        if !is_done && !entry.path().is_dir() {
            continue;
        }
        match inspect(&entry.path()).and_then(|run| verify_run(&run)) {
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
            "{} of {} not in {}, where the study keeps all",
            missing.len(),
            are(done.len(), "run folder"),
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
        let name = Path::new(prefix).join(entry.file_name());
        let name = name.to_string_lossy().into_owned();
        if entry.file_type()?.is_dir() {
            files.extend(files_below(folder, &name)?);
        } else {
            files.push(ManifestFile::of(folder, &name)?);
        }
    }
    files.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(files)
}
