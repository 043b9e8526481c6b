//! A run from rest into a folder of its own, with the bytes that `slipfront run` writes, in a thread of its own.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use slipfront_case::text::display_path;
use slipfront_run::clock;
use slipfront_run::results;
use slipfront_run::run_folder::RunFolder;
use slipfront_run::running::Running;

use crate::document::Document;
use crate::files::is_plain_name;
use crate::outbox::Outbox;
use crate::protocol::Reply;
use crate::replay;

/// Time from one report of the progress to the next.
const REPORT: Duration = Duration::from_millis(200);

/// The folder of this name among the results.
///
/// # Errors
/// A sentence, if the name is more than a name, or is taken.
pub(crate) fn folder(results: &Path, name: &str) -> Result<PathBuf, String> {
    if !is_plain_name(name) {
        return Err(format!(
            "{name:?} is no name for a folder: take up to 100 letters, digits, blanks and -_.+(), and no dot at the start"
        ));
    }
    let folder = results.join(name);
    match folder.symlink_metadata() {
        Err(_) => Ok(folder),
        Ok(_) => Err(format!(
            "{} exists already: take another name",
            display_path(&folder)
        )),
    }
}

/// Runs the case to its end and writes it into a folder of the results; tells how far it is, and where they are.
pub(crate) fn save(document: &Document, out: &Path, threads: usize, outbox: &Outbox, stop: &AtomicBool) {
    match saved(document, out, threads, outbox, stop) {
        Ok(true) => outbox.reply(&Reply::Saved {
            name: &document.name,
            folder: display_path(out),
            folders: out.parent().map(replay::folders).unwrap_or_default(),
        }),
        Ok(false) => {}
        Err(sentence) => outbox.reply(&Reply::Refused { of: "save", sentence }),
    }
}

/// Whether the run came to its end.
fn saved(
    document: &Document,
    out: &Path,
    threads: usize,
    outbox: &Outbox,
    stop: &AtomicBool,
) -> Result<bool, String> {
    /// Any error as its sentence.
    fn sentence(error: impl std::fmt::Display) -> String {
        error.to_string()
    }
    let started = clock::now();
    let case = Arc::new(document.case().map_err(sentence)?);
    case.budget
        .check_disk(&case.file, out, 0, false)
        .map_err(sentence)?;
    let mut folder = RunFolder::prepare(out, false, &case.inputs).map_err(sentence)?;
    results::write_case(&case, &mut folder).map_err(sentence)?;
    let mut running = Running::start(&case, threads);
    let mut told = Instant::now();
    let reason = loop {
        match running.advance(case.steps_per_poll()) {
            Ok(Some(reason)) => break reason,
            Ok(None) => {}
            Err(error) => {
                give_up(folder);
                return Err(sentence(error));
            }
        }
        if stop.load(Ordering::Relaxed) {
            give_up(folder);
            return Ok(false);
        }
        if told.elapsed() > REPORT {
            told = Instant::now();
            let share = running.snapshot().step as f64 / case.time_plan.last_step as f64;
            outbox.reply(&Reply::Saving { share });
        }
    };
    let mut record = running.record(reason);
    results::write(&case, &mut record, folder, started, threads).map_err(sentence)?;
    Ok(true)
}

/// Takes away the folder of a run that is not completed, which was made for it.
fn give_up(folder: RunFolder) {
    let path = folder.path().to_owned();
    folder.discard();
    // One in which somebody else has put something stays.
    let _ = std::fs::remove_dir(path);
}
