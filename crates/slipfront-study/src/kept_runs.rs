//! The run folders that a study has kept, compared with their manifests and with the lines of the journal
//! that name them.

use std::collections::HashMap;
use std::io::ErrorKind;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use slipfront_base::number_format::{are, count};
use slipfront_run::folder_error::FolderError;
use slipfront_run::names::RUNS;
use slipfront_run::verify::{FolderCheck, inspect, verify_run};

use crate::error::StudyError;
use crate::finished_run::{FinishedRun, mark_of};
use crate::folder::study_of;
use crate::plan::folder_of_run;
use crate::project_folder::Journal;
use crate::run_journal::RunJournal;
use crate::study_file::{RetainRuns, STUDIES};

/// Compares the run folders that a study has kept with their manifests and with the lines of its journal, and
/// looks for those that it lacks; returns their number as the end of a sentence.
pub(crate) fn verify_kept(
    folder: &Path,
    check: &mut FolderCheck,
    stop: &AtomicBool,
) -> Result<String, StudyError> {
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
        Err(_) if !check.differences.is_empty() => Default::default(),
        Err(error) => return Err(error),
    };
    if damaged > 0 {
        check.notes.push(format!(
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
            check
                .notes
                .push(format!("{} is of no run in the journal", path.display()));
            continue;
        };
        if is_done {
            match inspect(&path).and_then(|run| verify_run(&run, stop)) {
                Ok(of_run) => {
                    check.differences.extend(of_run.differences);
                    check.notes.extend(of_run.notes);
                    kept += 1;
                }
                Err(error) => {
                    check.differences.push(error.to_string());
                    continue;
                }
            }
        }
        if mark.is_some() && mark_of(&path, is_done) != mark {
            check.differences.push(StudyError::NotItsRun { path }.to_string());
        }
    }
    let keep = study_of(folder).map_or(RetainRuns::All, |study| study.settings.keep);
    let is_missing = |(is_done, mark): &&(bool, Option<String>)| {
        mark.is_some() && (keep == RetainRuns::All || (keep == RetainRuns::Failed && !is_done))
    };
    let missing = recorded.values().filter(is_missing).count();
    if missing > 0 {
        check.differences.push(format!(
            "{} missing in {}: put back what was removed, or set `study.keep = \"none\"` in {} and run it again",
            are(missing, "run folder"),
            runs.display(),
            folder.join(STUDIES.file).display()
        ));
    }
    Ok(format!(", {} as they were written", count(kept, "run folder")))
}
