//! Compares the folder of a study or of another project with the list of its files, then with the tables, pictures and other
//! results that its recorded runs give; and the run folders that a study has kept with their manifests.

use std::collections::HashSet;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use slipfront_base::disk::{TEXT_MAX_BYTES, open_limited};
use slipfront_base::number_format::{are, count};
use slipfront_base::unfinished::{TemporaryFolder, is_unfinished};
use slipfront_run::folder_error::FolderError;
use slipfront_run::names::{FIGURE_CACHE, RUNS};
use slipfront_run::program;
use slipfront_run::verify::{
    Verdict, VerifyError, differences, first_line, inspect, unlisted_files, verify_run,
};
use thiserror::Error;

use crate::converge;
use crate::error::{StudyError, of_others};
use crate::execute::collect;
use crate::folder::{StudyFolder, is_of_figures, stage, study_of};
use crate::journal::Records;
use crate::plan::Plan;
use crate::project_kind::ProjectKind;
use crate::result_files::{CHECKSUMS, Checksums, Others};
use crate::study_file::RetainRuns;
use crate::study_results::StudyResults;

/// The folder of a study that cannot be verified.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum VerifyStudyError {
    #[error(
        "the study in {path} lacks {}{}: finish it, or merge it with its other shards, and verify it then",
        count(*runs, "run"),
        of_others(*others)
    )]
    Unfinished {
        path: PathBuf,
        runs: usize,
        others: usize,
    },
    #[error("the {what} in {path} was not finished: run it again to go on with it, and verify it then")]
    UnfinishedSearch { what: &'static str, path: PathBuf },
    #[error(transparent)]
    Study(#[from] StudyError),
    #[error(transparent)]
    Run(#[from] VerifyError),
    #[error(transparent)]
    Folder(#[from] FolderError),
}

/// Whether a study has been run in the folder.
pub fn has_records(folder: &Path) -> bool {
    crate::folder::is_study(folder) && folder.join(Records::FILE).exists()
}

/// Extent of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Files are compared with their checksums.
    Checksums,
    /// Results of recorded runs are derived from these again, too.
    Derived,
}

/// Verifies the folder of a run, of a study, or of a project of one of these kinds that was finished.
///
/// # Errors
/// When it is no such folder, was not finished, or cannot be read; after a stop.
pub fn verify(
    folder: &Path,
    kinds: &[&ProjectKind],
    extent: Extent,
    stop: &AtomicBool,
) -> Result<Verdict, VerifyStudyError> {
    let verdict = if has_records(folder) {
        verify_study(folder, extent, stop)?
    } else if let Some(kind) = kinds.iter().find(|kind| kind.is_in(folder)) {
        verify_project(folder, kind, extent, stop)?
    } else if is_of_figures(folder) {
        let (verdict, _) = verify_checksums(folder, &[Records::FILE, FIGURE_CACHE], stop)?;
        Verdict {
            not_derived: Some(format!(
                "the figures in {} were not drawn again: `slipfront verify` does so",
                folder.display()
            )),
            ..verdict
        }
    } else {
        verify_run(&inspect(folder)?, stop)?
    };
    if stop.load(Ordering::Relaxed) {
        return Err(StudyError::Interrupted.into());
    }
    Ok(verdict)
}

/// Compares the files of a folder with its list, and notes entries that are neither in the list nor among the `others`; the results are
/// complete if the second value is true.
///
/// # Errors
/// When the system does not say what the folder holds.
pub fn verify_checksums(
    folder: &Path,
    others: &[&str],
    stop: &AtomicBool,
) -> Result<(Verdict, bool), StudyError> {
    let mut verdict = Verdict::default();
    let path = folder.join(CHECKSUMS);
    let list = match Checksums::read(folder) {
        Ok(Some(list)) => list,
        Ok(None) => {
            let sentence = format!(
                "{} is missing: the command that made the folder writes it when it is run again",
                path.display()
            );
            verdict.differences.push(sentence);
            return Ok((verdict, false));
        }
        Err(StudyError::Checksums { why, .. }) => {
            verdict
                .differences
                .push(format!("{} is damaged: {why}", path.display()));
            return Ok((verdict, false));
        }
        Err(error) => return Err(error),
    };
    verdict.differences = differences(&list.files, folder, "were written", stop);
    if !list.replaced.is_empty() {
        let sentence = format!(
            "{}: the results were not written to their end; the command that made the folder ends it when it is run again",
            path.display()
        );
        verdict.differences.push(sentence);
    }
    let by = program::in_words(&list.version, list.revision.as_deref());
    verdict.what = format!("{} as {by} wrote them", count(list.files.len(), "file"));
    let is_left = |name: &str| name.rsplit('/').next().is_some_and(is_unfinished);
    let known = list.files.iter().map(|file| file.name.as_str());
    let known = known.chain([CHECKSUMS]).chain(others.iter().copied()).collect();
    verdict.notes = unlisted_files(folder, &known, is_left);
    Ok((verdict, list.is_complete))
}

/// Compares the folder of a project with its list, then with the results that follow from the runs in its journal.
fn verify_project(
    folder: &Path,
    kind: &ProjectKind,
    extent: Extent,
    stop: &AtomicBool,
) -> Result<Verdict, VerifyStudyError> {
    let (mut verdict, is_complete) = verify_checksums(folder, &[kind.journal], stop)?;
    if !verdict.differences.is_empty() {
        return Ok(verdict);
    }
    if !is_complete {
        let (what, path) = (kind.name, folder.to_owned());
        return Err(VerifyStudyError::UnfinishedSearch { what, path });
    }
    if extent == Extent::Derived {
        derive_from_runs(folder, kind, &mut verdict, stop)?;
    }
    Ok(verdict)
}

/// Compares the folder of a project with the results that are found in another folder from the runs in its journal.
fn derive_from_runs(
    folder: &Path,
    kind: &ProjectKind,
    verdict: &mut Verdict,
    stop: &AtomicBool,
) -> Result<(), VerifyStudyError> {
    let temporary = TemporaryFolder::new(folder).map_err(VerifyError::Temporary)?;
    // Opening a pipe would wait without end.
    let file = folder.join(kind.file);
    open_limited(&file, TEXT_MAX_BYTES).map_err(FolderError::read(&file))?;
    let [kept, all] = (kind.find_again)(folder, temporary.path(), stop)?;
    if all > kept {
        let sentence = format!("{} not in the journal, and made again", are(all - kept, "run"));
        verdict.notes.push(sentence);
    }
    verdict.differences = differences_from(temporary.path(), folder, "follow from its runs", stop)?;
    verdict.what = format!(
        "{}, a {} as its {} give it",
        verdict.what,
        kind.name,
        count(kept, "recorded run")
    );
    Ok(())
}

/// Differences of a folder from the results that were made again in a temporary one.
fn differences_from(
    temporary: &Path,
    folder: &Path,
    how: &str,
    stop: &AtomicBool,
) -> Result<Vec<String>, StudyError> {
    let again = Checksums::read(temporary)?.unwrap_or_default();
    Ok(differences(&again.files, folder, how, stop))
}

/// Compares a study with its list, makes its tables and pictures again from its records, and compares its run folders with their
/// manifests.
fn verify_study(folder: &Path, extent: Extent, stop: &AtomicBool) -> Result<Verdict, VerifyStudyError> {
    let (mut verdict, is_complete) = verify_checksums(folder, &[Records::FILE, RUNS], stop)?;
    let mut derived = None;
    if extent == Extent::Derived && verdict.differences.is_empty() {
        derived = derive_study(folder, &mut verdict, stop)?;
    }
    if verdict.differences.is_empty() && !is_complete {
        let (what, path) = ("study", folder.to_owned());
        return Err(VerifyStudyError::UnfinishedSearch { what, path });
    }
    let kept = verify_kept(folder, derived.as_ref(), &mut verdict, stop)?;
    verdict.what += &format!(", {} as they were written", count(kept, "run folder"));
    Ok(verdict)
}

/// Makes tables and pictures of a study again from its records, and compares the folder with them; returns the plan and the results
/// of its runs unless they are lost.
fn derive_study(
    folder: &Path,
    verdict: &mut Verdict,
    stop: &AtomicBool,
) -> Result<Option<(Plan, StudyResults)>, VerifyStudyError> {
    let made = study_of(folder).and_then(|file| Ok((Plan::new(&file, None)?, file)));
    let (plan, file) = match made {
        Ok(made) => made,
        Err(error) => {
            let (path, line) = (folder.join("study.toml"), first_line(&error));
            let difference = format!("{} is no study for this version: {line}", path.display());
            verdict.differences.push(difference);
            return Ok(None);
        }
    };
    plan.check_memory(0)?;
    let temporary = TemporaryFolder::new(folder).map_err(VerifyError::Temporary)?;
    let mut again = StudyFolder::open(temporary.path(), &file, false)?;
    again.records.merge(folder)?;
    let records = folder.join(Records::FILE);
    let (damaged, records) = (again.records.damaged, records.display());
    let results = match collect(&plan, &again.records) {
        Ok(results) => results,
        Err(StudyError::Missing { runs, others }) if damaged == 0 => {
            let path = folder.to_owned();
            return Err(VerifyStudyError::Unfinished { path, runs, others });
        }
        // What its tables should be is lost with the damaged lines.
        Err(StudyError::Missing { .. }) => {
            let damage = format!("{records} differs: it has {}", count(damaged, "damaged line"));
            verdict.differences.push(damage);
            return Ok(None);
        }
        Err(error) => return Err(error.into()),
    };
    let mut batch = again.files.begin();
    stage(&plan, &results, &mut batch, stop)?;
    if converge::is_written(folder, &plan.axes) {
        converge::stage(&plan, &results, &mut batch)?;
    }
    batch.place(Others::Go)?;
    let how = "follow from the records";
    verdict.differences = differences_from(temporary.path(), folder, how, stop)?;
    if damaged > 0 {
        let damage = format!(
            "{records} has {}, whose runs are recorded once more or not needed",
            count(damaged, "damaged line")
        );
        verdict.notes.push(damage);
    }
    verdict.what = format!(
        "tables and pictures as its {} give them",
        count(again.records.len(), "recorded run")
    );
    Ok(Some((plan, results)))
}

/// Verifies the run folders that a study has kept, and looks for those that it lacks if its plan and results are known; returns their
/// number.
fn verify_kept(
    folder: &Path,
    derived: Option<&(Plan, StudyResults)>,
    verdict: &mut Verdict,
    stop: &AtomicBool,
) -> Result<usize, VerifyStudyError> {
    let runs = folder.join(RUNS);
    let unreadable = FolderError::read(&runs);
    let entries = match std::fs::read_dir(&runs) {
        Ok(entries) => Some(entries),
        Err(error) if error.kind() == ErrorKind::NotFound => None,
        Err(error) => return Err(unreadable(error).into()),
    };
    // Of a run that failed the case alone is kept.
    let done = derived.map(|(plan, results)| {
        let done = results.runs.iter().filter(|(_, result)| result.is_ok());
        done.map(|(run, _)| plan.folder_name(*run)).collect()
    });
    let done: HashSet<String> = done.unwrap_or_default();
    let (mut kept, mut missing) = (0, done.clone());
    for entry in entries.into_iter().flatten() {
        let entry = entry.map_err(&unreadable)?;
        let is_done = missing.remove(&*entry.file_name().to_string_lossy());
        if !is_done && !entry.path().is_dir() {
            continue;
        }
        match inspect(&entry.path()).and_then(|run| verify_run(&run, stop)) {
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
    let keeps_all = derived.is_some_and(|(plan, _)| plan.settings.keep == RetainRuns::All);
    if keeps_all && !missing.is_empty() {
        verdict.notes.push(format!(
            "{} of {} not in {}, where the study keeps all",
            missing.len(),
            are(done.len(), "run folder"),
            runs.display()
        ));
    }
    Ok(kept)
}
