//! Saves a run from rest into its own folder, with the same bytes as `slipfront run`.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use slipfront::Execution;
use slipfront_base::disk::{folder_of, make_folders, sync_folder};
use slipfront_base::text::{display_path, truncated};
use slipfront_case::case_file::CaseError;
use slipfront_run::clock;
use slipfront_run::manifest::Processors;
use slipfront_run::pictures;
use slipfront_run::results;
use slipfront_run::run_folder::RunFolder;
use slipfront_run::running::Running;
use slipfront_session::{Document, is_plain_name, sentence};

/// Time between two progress reports.
const REPORT_INTERVAL: Duration = Duration::from_millis(200);

/// The folder for this name in the results.
///
/// # Errors
/// A sentence, if the name is not a plain name, or is taken.
pub(crate) fn folder(results: &Path, name: &str) -> Result<PathBuf, String> {
    if !is_plain_name(name) {
        return Err(format!(
            "{:?} is no name for a folder: take up to 100 letters, digits, blanks and -_.+(), and no dot at the start",
            truncated(name)
        ));
    }
    let folder = results.join(name);
    match folder.symlink_metadata() {
        Err(_) => Ok(folder),
        Ok(_) => Err(is_taken(&folder)),
    }
}

fn is_taken(folder: &Path) -> String {
    format!("{} exists already: take another name", display_path(folder))
}

/// Makes a new folder. Fails if the name is taken, even by a link to an empty folder.
fn make_folder(path: &Path) -> Result<(), String> {
    let above = folder_of(path);
    make_folders(above)
        .and_then(|()| std::fs::create_dir(path))
        .and_then(|()| sync_folder(above))
        .map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists => is_taken(path),
            _ => format!("{} cannot be made: {error}", display_path(path)),
        })
}

/// Runs the case to its end and writes it into a new folder. From time to time, reports the completed
/// fraction and checks whether to stop. Returns whether the run was completed.
///
/// # Errors
/// A sentence; in that case there is no folder.
pub(crate) fn save(
    document: &Document,
    out: &Path,
    threads: usize,
    stop: &AtomicBool,
    report_progress: impl Fn(f64),
) -> Result<bool, String> {
    let started = clock::now();
    let case = match document.case(&mut |_| !stop.load(Ordering::Relaxed)) {
        Err(CaseError::Stopped) => return Ok(false),
        case => Arc::new(case.map_err(sentence)?),
    };
    case.budget.check_memory(&case.file, false).map_err(sentence)?;
    case.budget
        .check_disk(&case.file, out, 0, false)
        .map_err(sentence)?;
    make_folder(out)?;
    let prepared = RunFolder::prepare(out, false, &case.inputs);
    let mut folder = prepared.map_err(|error| {
        let _ = std::fs::remove_dir(out);
        sentence(error)
    })?;
    if let Err(error) = results::write_case(&case, &mut folder) {
        discard_folder(folder);
        return Err(sentence(error));
    }
    let mut running = Running::start(&case, None, Execution::on_threads(threads));
    let mut last_report = Instant::now();
    let reason = loop {
        match running.advance(case.steps_per_poll()) {
            Ok(Some(reason)) => break reason,
            Ok(None) => {}
            Err(error) => {
                discard_folder(folder);
                return Err(sentence(error));
            }
        }
        if stop.load(Ordering::Relaxed) {
            discard_folder(folder);
            return Ok(false);
        }
        if last_report.elapsed() > REPORT_INTERVAL {
            last_report = Instant::now();
            report_progress(running.snapshot().drive_steps as f64 / case.time_plan.last_step as f64);
        }
    };
    let processors = Processors::threads(threads);
    let mut record = running.record(reason);
    pictures::write_run(&case, &mut record, folder, started, processors).map_err(sentence)?;
    Ok(true)
}

/// Removes the folder of a run that was not completed.
fn discard_folder(folder: RunFolder) {
    let path = folder.path().to_owned();
    folder.discard();
    // The folder stays if another process has put something into it.
    let _ = std::fs::remove_dir(path);
}
