//! Verifies the folder of a study: compares it with the list of its files, and then with the tables and
//! pictures that follow from its recorded runs; compares the kept run folders with their manifests. Other
//! folders are verified by their kind.

use std::collections::HashSet;
use std::io::ErrorKind;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use slipfront_base::number_format::{are, count};
use slipfront_base::unfinished::TemporaryFolder;
use slipfront_run::folder_error::FolderError;
use slipfront_run::names::{FIGURE_CACHE, RUNS};
use slipfront_run::verify::{Verdict, VerifyError, first_line, inspect, verify_run};

use crate::converge;
use crate::error::StudyError;
use crate::execute::collect;
use crate::folder::{StudyFolder, is_of_figures, stage, study_of};

use crate::plan::Plan;
use crate::project_folder::verify::{differences_from, verify_project};
use crate::project_folder::{Derivation, Extent, Others, VerifyStudyError, verify_checksums};
use crate::run_journal::RunJournal;
use crate::study_file::{RetainRuns, STUDIES};
use crate::study_results::StudyResults;

/// Whether a study has been run in the folder.
pub fn has_records(folder: &Path) -> bool {
    STUDIES.is_in(folder)
}

/// Verifies the folder of a run, of a study, or of a project of one of these `others` that was finished.
///
/// # Errors
/// When it is not such a folder, was not finished, or cannot be read; after a stop.
pub fn verify(
    folder: &Path,
    others: &[Derivation],
    extent: Extent,
    stop: &AtomicBool,
) -> Result<Verdict, VerifyStudyError> {
    let verdict = if has_records(folder) {
        verify_study(folder, extent, stop)?
    } else if let Some(derivation) = others.iter().find(|other| other.kind.is_in(folder)) {
        verify_project(folder, derivation, extent, stop)?
    } else if is_of_figures(folder) {
        let (verdict, _) = verify_checksums(folder, &[RunJournal::FILE, FIGURE_CACHE], stop)?;
        Verdict {
            not_derived: Some(format!(
                "the figures in {} were not drawn again: `slipfront verify` draws them",
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

/// Compares a study with its list, makes its tables and pictures again from its records, and compares its run
/// folders with their manifests.
fn verify_study(folder: &Path, extent: Extent, stop: &AtomicBool) -> Result<Verdict, VerifyStudyError> {
    let (mut verdict, is_complete) = verify_checksums(folder, &[RunJournal::FILE, RUNS], stop)?;
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

/// Makes tables and pictures of a study again from its records, and compares the folder with them. Returns
/// the plan and the results of its runs, unless damaged lines have lost them.
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
            let difference = format!("{} is not a valid study for this version: {line}", path.display());
            verdict.differences.push(difference);
            return Ok(None);
        }
    };
    plan.check_memory(0)?;
    let temporary = TemporaryFolder::new(folder).map_err(VerifyError::Temporary)?;
    let mut again = StudyFolder::open(temporary.path(), &file, false)?;
    again.records.merge(folder)?;
    let records = folder.join(RunJournal::FILE);
    let (damaged, records) = (again.records.damaged, records.display());
    let results = match collect(&plan, &again.records) {
        Ok(results) => results,
        Err(StudyError::Missing { runs, others }) if damaged == 0 => {
            let path = folder.to_owned();
            return Err(VerifyStudyError::Unfinished { path, runs, others });
        }
        // The damaged lines are needed to derive the tables again.
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

/// Verifies the run folders that a study has kept, and looks for those that it lacks if its plan and results
/// are known; returns their number.
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
    // For a failed run, only the case is kept.
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
    // They may have been removed on purpose, or the runs are older than the setting `keep`.
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
