//! Compares the folder of a study with the tables and pictures that its records give, and with the comparison of its meshes
//! if it has one; the folders of the runs that it kept with their manifests; and the folder of a design or a calibration
//! with the results of its runs.

use std::collections::HashSet;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use slipfront_case::number_format::{are, count};
use slipfront_case::unfinished::{TemporaryFolder, is_unfinished};
use slipfront_run::folder_error::FolderError;
use slipfront_run::manifest::ManifestFile;
use slipfront_run::names::RUNS;
use slipfront_run::verify::{
    Verdict, VerifyError, differences, first_line, inspect, unlisted_files, verify_run,
};
use thiserror::Error;

use crate::calibrate::{CalibrationFolder, TRAINING, is_calibration, is_finished};
use crate::converge::{is_written, write_meshes};
use crate::design::{Bounds, DesignFile, DesignFolder, JOURNAL, is_design, search_of};
use crate::error::{StudyError, of_others};
use crate::execute::collect;
use crate::folder::{StudyFolder, study_of, write};
use crate::journal::Records;
use crate::plan::Plan;
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

/// Verifies the folder of a run or of a study that was finished.
pub fn verify(folder: &Path) -> Result<Verdict, VerifyStudyError> {
    if has_records(folder) {
        verify_study(folder)
    } else if is_design(folder) {
        verify_design(folder)
    } else if is_calibration(folder) {
        verify_calibration(folder)
    } else {
        Ok(verify_run(&inspect(folder)?)?)
    }
}

/// Finds a design again from the runs in its journal, and compares the folder with the results.
fn verify_design(folder: &Path) -> Result<Verdict, VerifyStudyError> {
    let Some(search) = search_of(folder)? else {
        let (what, path) = ("design", folder.to_owned());
        return Err(VerifyStudyError::UnfinishedSearch { what, path });
    };
    if search.is_cut_short {
        let what =
            "a design whose search --time has cut short: which drafts were tried depends on the machine";
        return Ok(Verdict {
            what: what.to_owned(),
            notes: vec!["its files were not derived again from its runs".to_owned()],
            ..Verdict::default()
        });
    }
    verify_from_runs(folder, "design", JOURNAL, |temporary| {
        let file = DesignFile::load(&folder.join("design.toml"))?;
        let mut again = DesignFolder::open(temporary, &file)?;
        let kept = again.n_kept();
        let bounds = Bounds {
            runs: search.runs,
            share_of_time: &|| 0.0,
            stop: &AtomicBool::new(false),
        };
        again.find(&bounds, &mut |_| {})?;
        Ok([kept, again.n_kept()])
    })
}

/// Calibrates again from the runs in the journal, and compares the folder with the results.
fn verify_calibration(folder: &Path) -> Result<Verdict, VerifyStudyError> {
    if !is_finished(folder) {
        let (what, path) = ("calibration", folder.to_owned());
        return Err(VerifyStudyError::UnfinishedSearch { what, path });
    }
    verify_from_runs(folder, "calibration", TRAINING, |temporary| {
        let mut again = CalibrationFolder::again(folder, temporary)?;
        let kept = again.n_kept();
        again.find(&AtomicBool::new(false), &mut |_| {})?;
        Ok([kept, again.n_kept()])
    })
}

/// Compares a folder with the results that `again` finds in another folder from the runs in its journal; `again` returns the
/// numbers of runs there before and after, since runs that the journal lacks are made.
fn verify_from_runs(
    folder: &Path,
    what: &str,
    journal: &str,
    again: impl FnOnce(&Path) -> Result<[usize; 2], StudyError>,
) -> Result<Verdict, VerifyStudyError> {
    let mut verdict = Verdict::default();
    let temporary = TemporaryFolder::new(folder).map_err(VerifyError::Temporary)?;
    std::fs::copy(folder.join(journal), temporary.path().join(journal)).map_err(VerifyError::Temporary)?;
    let [kept, all] = again(temporary.path())?;
    if all > kept {
        let sentence = format!("{} not in the journal, and made again", are(all - kept, "run"));
        verdict.notes.push(sentence);
    }
    let mut files = files_below(temporary.path(), "").map_err(VerifyError::Temporary)?;
    files.retain(|file| file.name != journal);
    verdict.differences = differences(&files, folder, "follow from its runs");
    let is_left = |name: &str| name.rsplit('/').next().is_some_and(is_unfinished);
    let known = files.iter().map(|file| file.name.as_str());
    verdict
        .notes
        .extend(unlisted_files(folder, &known.chain([journal]).collect(), is_left));
    verdict.what = format!("a {what} as its {} give it", count(kept, "recorded run"));
    Ok(verdict)
}

/// Makes tables and pictures of a study again from its records, and compares the folder with them; then its run folders with
/// their manifests.
fn verify_study(folder: &Path) -> Result<Verdict, VerifyStudyError> {
    let mut verdict = Verdict::default();
    let made = study_of(folder).and_then(|file| Ok((Plan::new(&file, None)?, file)));
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
            return Ok(verdict);
        }
        Err(error) => return Err(error.into()),
    };
    write(&plan, &results, &again)?;
    if is_written(folder, &plan.axes) {
        write_meshes(&plan, &results, &again)?;
    }
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

/// Verifies the run folders that a study has kept; returns their number.
fn verify_kept(
    folder: &Path,
    plan: &Plan,
    results: &StudyResults,
    verdict: &mut Verdict,
) -> Result<usize, VerifyStudyError> {
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
