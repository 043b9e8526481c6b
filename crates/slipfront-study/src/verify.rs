//! Verifies a folder by its kind. The run folders that a study has kept are compared with their manifests and
//! with the lines of the journal that name them.

use std::collections::HashMap;
use std::io::ErrorKind;
use std::path::{Component, Path};
use std::sync::atomic::{AtomicBool, Ordering};

use slipfront_base::disk::read_limited;
use slipfront_base::number_format::{are, count};
use slipfront_base::text::single_line;
use slipfront_base::unfinished::is_unfinished;
use slipfront_run::export::folders_in;
use slipfront_run::folder_error::FolderError;
use slipfront_run::manifest::{Manifest, ManifestError};
use slipfront_run::names::{FIGURE_CACHE, MANIFEST, RO_CRATE, RUNS};
use slipfront_run::verify::{
    DESCRIPTION_MAX_BYTES, Verdict, VerifyError, inspect, unlisted_files, verify_run,
};

use crate::error::StudyError;
use crate::finished_run::{FinishedRun, mark_of};
use crate::folder::{PAPER, is_of_figures, study_of};
use crate::plan::folder_of_run;
use crate::project_folder::verify::verify_project;
use crate::project_folder::{Checksums, Derivation, Extent, Journal, VerifyStudyError, verify_complete};
use crate::run_journal::RunJournal;
use crate::study_file::{RetainRuns, STUDIES};
use crate::write::STUDY_FOLDERS;

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
    let verdict = if STUDIES.has_results_in(folder) {
        verify_study(folder, extent, stop)?
    } else if let Some(derivation) = others.iter().find(|other| other.kind.has_results_in(folder)) {
        verify_project(folder, derivation, &[], extent, stop)?
    } else if is_of_figures(folder) {
        let verdict = verify_complete(folder, &PAPER, &[FIGURE_CACHE], stop)?;
        Verdict {
            not_derived: Some(format!(
                "the figures in {} were not drawn again: `slipfront verify` draws them",
                folder.display()
            )),
            ..verdict
        }
    } else if !folder.join(MANIFEST).exists() && folder.join(RO_CRATE).is_file() {
        verify_crate(folder, others, extent, stop)?
    } else {
        verify_run(&inspect(folder)?, stop)?
    };
    if stop.load(Ordering::Relaxed) {
        return Err(StudyError::Interrupted.into());
    }
    Ok(verdict)
}

/// Verifies every folder of results in a crate that `slipfront export` has made.
fn verify_crate(
    folder: &Path,
    others: &[Derivation],
    extent: Extent,
    stop: &AtomicBool,
) -> Result<Verdict, VerifyStudyError> {
    let path = folder.join(RO_CRATE);
    let mut verdict = Verdict::default();
    let description = read_limited(&path, DESCRIPTION_MAX_BYTES).map_err(FolderError::read(&path))?;
    let names = folders_in(&description).unwrap_or_default();
    if names.is_empty() {
        let damage = format!("{} is damaged: it names no folder of results", path.display());
        verdict.differences.push(damage);
    }
    for name in &names {
        let part = folder.join(name);
        let is_inside = Path::new(name)
            .components()
            .all(|part| matches!(part, Component::Normal(_)));
        if !is_inside || !part.is_dir() {
            verdict
                .differences
                .push(single_line(&format!("{} is missing", part.display())));
            continue;
        }
        let of_part = verify(&part, others, extent, stop)?;
        let seal = match seal_of(&part) {
            Ok(seal) => seal,
            // Differences of the list or manifest itself are told already.
            Err(_) if !of_part.differences.is_empty() => None,
            Err(error) => return Err(error),
        };
        verdict.differences.extend(of_part.differences);
        verdict.notes.extend(of_part.notes);
        let is_described = |seal: String| {
            description
                .windows(seal.len())
                .any(|text| text == seal.as_bytes())
        };
        if !seal.is_none_or(is_described) {
            verdict.differences.push(single_line(&format!(
                "{} has other results than {} describes: it was replaced; export the original again",
                part.display(),
                path.display()
            )));
        }
    }
    let known = names.iter().map(String::as_str).chain([RO_CRATE]).collect();
    verdict
        .notes
        .extend(unlisted_files(folder, &known, is_unfinished));
    verdict.what = format!("a crate of {}, unchanged", count(names.len(), "folder"));
    Ok(verdict)
}

/// Seal of the list of a folder, or of its manifest; none if it has neither.
fn seal_of(folder: &Path) -> Result<Option<String>, VerifyStudyError> {
    if let Some(list) = Checksums::read(folder)? {
        return Ok(Some(list.seal));
    }
    match Manifest::read(folder) {
        Ok(manifest) => Ok(Some(manifest.checksum)),
        Err(ManifestError::Missing { .. }) => Ok(None),
        Err(error) => Err(VerifyError::from(error).into()),
    }
}

/// Compares a study with its list and with the results that follow from its recorded runs, and its run
/// folders with their manifests.
fn verify_study(folder: &Path, extent: Extent, stop: &AtomicBool) -> Result<Verdict, VerifyStudyError> {
    let mut verdict = verify_project(folder, &STUDY_FOLDERS, &[RUNS], extent, stop)?;
    let kept = verify_kept(folder, &mut verdict, stop)?;
    verdict.what += &format!(", {} as they were written", count(kept, "run folder"));
    Ok(verdict)
}

/// Compares the run folders that a study has kept with the lines of its journal, and looks for those that it
/// lacks; returns their number.
pub(crate) fn verify_kept(
    folder: &Path,
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
    let (lines, damaged) = match Journal::read::<FinishedRun>(folder, RunJournal::FILE) {
        Ok(read) => read,
        // Differences of the journal itself are told already.
        Err(_) if !verdict.differences.is_empty() => Default::default(),
        Err(error) => return Err(error.into()),
    };
    if damaged > 0 {
        verdict.notes.push(format!(
            "{} has {}, whose runs are recorded once more or not needed",
            folder.join(RunJournal::FILE).display(),
            count(damaged, "damaged line")
        ));
    }
    let mut recorded: HashMap<String, (bool, Option<String>)> = lines
        .into_iter()
        .filter_map(|run| Some((folder_of_run(&run.id)?, (run.outcome.result().is_ok(), run.kept))))
        .collect();
    let mut kept = 0;
    for entry in entries.into_iter().flatten() {
        let path = entry.map_err(&unreadable)?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let Some((is_done, mark)) = recorded.remove(&*name) else {
            verdict
                .notes
                .push(format!("{} is of no run in the journal", path.display()));
            continue;
        };
        if is_done {
            match inspect(&path).and_then(|run| verify_run(&run, stop)) {
                Ok(of_run) => {
                    verdict.differences.extend(of_run.differences);
                    verdict.notes.extend(of_run.notes);
                    kept += 1;
                }
                Err(error) => {
                    verdict.differences.push(error.to_string());
                    continue;
                }
            }
        }
        if mark.is_some() && mark_of(&path, is_done) != mark {
            verdict
                .differences
                .push(StudyError::NotItsRun { path }.to_string());
        }
    }
    let keep = study_of(folder).map_or(RetainRuns::All, |study| study.settings.keep);
    let is_missing = |(is_done, mark): &&(bool, Option<String>)| {
        mark.is_some() && (keep == RetainRuns::All || (keep == RetainRuns::Failed && !is_done))
    };
    let missing = recorded.values().filter(is_missing).count();
    if missing > 0 {
        verdict.differences.push(format!(
            "{} missing in {}: put back what was removed, or set `study.keep = \"none\"` in {} and run it again",
            are(missing, "run folder"),
            runs.display(),
            folder.join(STUDIES.file).display()
        ));
    }
    Ok(kept)
}
