//! `slipfront run --resume DIR`: goes on with a run that was interrupted.

use std::path::Path;

use jiff::Timestamp;
use slipfront_case::case::Case;
use slipfront_case::checkpoint::{CheckpointError, Checkpoints, Saved};
use slipfront_case::folder::{RunFolder, own_bytes};
use slipfront_case::manifest::{Manifest, ManifestError};
use slipfront_case::results;
use slipfront_case::run::Running;

use super::{Manner, complete};
use crate::commands::print;
use crate::failure::Failure;
use crate::report;

pub(super) fn resume(path: &Path, previous: bool, manner: Manner) -> Result<(), Failure> {
    let mut folder = RunFolder::reopen(path).map_err(Failure::input)?;
    match Manifest::read(path) {
        Ok(_) => return say_complete(path, &manner),
        Err(ManifestError::Missing { .. }) => {}
        Err(error @ ManifestError::Damaged { .. }) => return Err(Failure::input(error)),
    }
    let mut case = Case::load(&path.join("case.toml"), &[]).map_err(Failure::input)?;
    // Results are named after their folder, not after the file in it.
    if let Some(name) = path.file_name() {
        case.name = name.to_string_lossy().into_owned();
    }
    case.check_memory_resumed().map_err(Failure::input)?;
    let saved = load(path, &case, previous)?;
    case.check_disk(path, own_bytes(path), manner.interval.saves())
        .map_err(Failure::input)?;
    folder.clear_results(&case).map_err(Failure::input)?;
    if manner.talks() {
        print(&report::physics(&case))?;
    }
    let (running, started, from) = match saved {
        None => {
            let running = Running::start(&case, manner.threads);
            (
                running,
                Timestamp::now(),
                "the start: it has no checkpoint".to_owned(),
            )
        }
        Some(Saved { state, step, started }) => {
            let running = Running::resume(&case, manner.threads, state).ok_or_else(|| {
                let sentence = "does not fit its case: begin again with --force";
                Failure::input(anyhow::anyhow!("the checkpoint in {} {sentence}", path.display()))
            })?;
            let from = format!("step {step} of {}", case.schedule.last_step);
            (running, started, from)
        }
    };
    if manner.talks() {
        print(&format!("goes on from {from}\n"))?;
    }
    complete(running, folder, started, manner)
}

/// Nothing is left to do.
fn say_complete(path: &Path, manner: &Manner) -> Result<(), Failure> {
    // A kill may have come between the last file and this.
    Checkpoints::remove(path).map_err(Failure::running)?;
    if manner.json {
        let summary = results::read_summary(path).map_err(Failure::input)?;
        print(&results::summary_json(&summary))?;
    } else if manner.talks() {
        print(&format!("the run in {} is complete\n", path.display()))?;
    }
    Ok(())
}

/// The checkpoint to go on from, if the run has saved one.
fn load(path: &Path, case: &Case, previous: bool) -> Result<Option<Saved>, Failure> {
    match Checkpoints::load(path, case, previous) {
        Ok(None) if previous => {
            let sentence = "holds no checkpoint before the latest one";
            Err(Failure::input(anyhow::anyhow!("{} {sentence}", path.display())))
        }
        Ok(saved) => Ok(saved),
        Err(error) => {
            let remedy = remedy(&error, path, case, previous);
            Err(Failure::input(anyhow::anyhow!("{error}; {remedy}")))
        }
    }
}

/// What is left to do when a checkpoint is refused.
fn remedy(error: &CheckpointError, path: &Path, case: &Case, previous: bool) -> String {
    match error {
        CheckpointError::Damaged { .. } | CheckpointError::Unreadable { .. } if !previous => {
            match Checkpoints::load(path, case, true) {
                Ok(Some(saved)) => format!(
                    "the one before it, of step {}, is whole: add --previous to go on from there",
                    saved.step
                ),
                _ => "no whole one is kept beside it: begin the run again".to_owned(),
            }
        }
        CheckpointError::Case { .. } => {
            "put back the case.toml with which it was begun, or begin again".to_owned()
        }
        _ => "or begin the run again".to_owned(),
    }
}
