//! A worker thread of a study: it takes tasks, runs their cases one after the other, and hands back the outcomes.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, Sender};
use std::time::Instant;

use super::error::StudyError;
use super::plan::{Plan, RunKey};
use super::record::{Outcome, Record};
use super::study_file::RetainRuns;
use crate::error::ResultsError;
use crate::run_folder::RunFolder;
use crate::{results, running};
use slipfront_case::case::Case;

/// Whether runs should be given up: after a signal, and when the study cannot go on.
pub(super) type IsStopped<'a> = dyn Fn() -> bool + Sync + 'a;

/// Runs a case; without an outcome if the run was given up.
pub(super) type RunCase<'a> = dyn Fn(RunKey, &IsStopped) -> Result<Option<Outcome>, StudyError> + Sync + 'a;

/// A run to be done.
pub(super) struct Task {
    pub(super) run: RunKey,
    /// [`Plan::identity`] of the run.
    pub(super) id: String,
}

/// The record of a run that has ended; none if it was given up.
pub(super) type Ended = Result<Option<Record>, StudyError>;

/// Runs tasks until there are no more.
pub(super) fn work(
    run_case: &RunCase,
    tasks: &Mutex<Receiver<Task>>,
    finished: &Sender<Ended>,
    is_stopped: &IsStopped,
) {
    loop {
        let task = match tasks.lock() {
            Ok(tasks) => tasks.recv(),
            Err(_) => return,
        };
        let Ok(Task { run, id }) = task else { return };
        let began = Instant::now();
        let outcome = if is_stopped() {
            Ok(None)
        } else {
            // A panic is recorded as a failed run, so that the scheduler does not wait for it without end.
            catch_unwind(AssertUnwindSafe(|| run_case(run, is_stopped)))
                .unwrap_or_else(|panic| Ok(Some(Outcome::Failed(panicked(panic.as_ref())))))
        };
        let record = |outcome| Record {
            id,
            wall_time_s: began.elapsed().as_secs_f64(),
            outcome,
        };
        let ended = outcome.map(|outcome| outcome.map(record));
        if finished.send(ended).is_err() {
            return;
        }
    }
}

/// The reason of a run that failed by a panic.
fn panicked(panic: &(dyn std::any::Any + Send)) -> String {
    let message = panic
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| panic.downcast_ref::<&str>().copied());
    format!("a fault of the program: {}", message.unwrap_or("unknown"))
}

/// Runs the case of a run, and writes its folder to `runs` if the study keeps it.
pub(super) fn run_one(
    plan: &Plan,
    runs: &Path,
    run: RunKey,
    is_stopped: &IsStopped,
) -> Result<Option<Outcome>, StudyError> {
    let started = jiff::Timestamp::now();
    // The point was valid when the study began. If it is not now, a file that it reads has changed: that ends the study and is
    // not recorded as a failure of the run.
    let case = Arc::new(plan.case(run)?);
    let Some(mut record) = running::run_unless(&case, is_stopped) else {
        return Ok(None);
    };
    let is_kept = match plan.settings.keep {
        RetainRuns::All => true,
        RetainRuns::None => false,
        RetainRuns::Failed => record.is_err(),
    };
    if is_kept {
        let path = runs.join(plan.folder_name(run));
        write_folder(&case, record.as_mut().ok(), &path, started)?;
    }
    Ok(Some(match record {
        Ok(record) => Outcome::Done(Box::new(record.summary)).or_not_finite(),
        Err(error) => Outcome::Failed(error.to_string()),
    }))
}

/// Writes a run folder. The folder of a failed run holds the case file alone, by which the run can be repeated.
fn write_folder(
    case: &Case,
    record: Option<&mut running::Record>,
    path: &Path,
    started: jiff::Timestamp,
) -> Result<(), ResultsError> {
    let mut folder = RunFolder::prepare(path, true, &case.inputs)?;
    results::write_case(case, &mut folder)?;
    match record {
        Some(record) => drop(results::write(case, record, folder, started, 1)?),
        None => folder.leave(),
    }
    Ok(())
}
