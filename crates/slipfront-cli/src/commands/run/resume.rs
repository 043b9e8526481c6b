//! `slipfront run --resume DIR`: goes on with a run that was interrupted.

use std::path::Path;

use jiff::Timestamp;
use slipfront_case::case::Case;
use slipfront_run::checkpoint::{CheckpointError, Checkpoints, LoadedCheckpoint};
use slipfront_run::manifest::{Manifest, ManifestError};
use slipfront_run::run_folder::RunFolder;
use slipfront_run::run_folder::contents::own_bytes;
use slipfront_run::running::Running;
use slipfront_run::summary::{read_summary, summary_json};
use slipfront_run::verify::{VerifyError, expect_as_written};

use super::{Manner, complete};
use crate::failure::Failure;
use crate::print::print;
use crate::report;

pub(super) fn resume(path: &Path, previous: bool, manner: Manner) -> Result<(), Failure> {
    let mut folder = RunFolder::reopen(path).map_err(Failure::input)?;
    match Manifest::read(path) {
        Ok(_) => return say_complete(path, &manner),
        Err(ManifestError::Missing { .. }) => {}
        Err(error @ ManifestError::Damaged { .. }) => return Err(Failure::input(error)),
    }
    let case = load_case(path)?;
    case.check_memory_resumed().map_err(Failure::input)?;
    let saved = load(path, &case, previous)?;
    case.check_disk(path, own_bytes(path), manner.interval.saves())
        .map_err(Failure::input)?;
    let (running, checkpoints, from) = match saved {
        None => {
            let checkpoints = Checkpoints::new(path, &case, Timestamp::now());
            let running = Running::start(&case, manner.threads);
            (running, checkpoints, "the start: it has no checkpoint".to_owned())
        }
        Some(saved) => {
            let checkpoints = Checkpoints::after(path, &case, &saved);
            let from = format!("step {} of {}", saved.step, case.time_plan.last_step);
            let running = Running::resume(&case, manner.threads, saved.state).ok_or_else(|| {
                let sentence = "is not one of a run of its case";
                Failure::input(anyhow::anyhow!(
                    "the checkpoint in {} {sentence}; {ANEW}",
                    path.display()
                ))
            })?;
            (running, checkpoints, from)
        }
    };
    folder.clear_results(&case).map_err(Failure::input)?;
    if manner.talks() {
        print(&report::physics(&case))?;
        print(&format!("goes on from {from}\n"))?;
    }
    complete(running, folder, checkpoints, manner)
}

/// What is left where no checkpoint can be used.
const ANEW: &str = "remove the checkpoints, and --resume begins from the start";

fn load_case(path: &Path) -> Result<Case, Failure> {
    let mut case = Case::load(&path.join("case.toml"), &[]).map_err(|error| {
        let hint = "if the run was stopped before all its inputs were copied, begin it again with --force";
        Failure::input(anyhow::anyhow!("{error}\n{hint}"))
    })?;
    // Results are named after their folder, not after the file in it.
    let folder = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    if let Some(name) = folder.file_name() {
        case.name = name.to_string_lossy().into_owned();
    }
    Ok(case)
}

/// Nothing is left to do.
fn say_complete(path: &Path, manner: &Manner) -> Result<(), Failure> {
    // A kill may have come between the last file and this. On a disk that cannot be written they do no harm.
    let _ = Checkpoints::remove(path);
    let unchanged = |which: &dyn Fn(&str) -> bool, remedy: &str| {
        expect_as_written(path, which).map_err(|error| match error {
            VerifyError::Changed { difference, .. } => Failure::input(anyhow::anyhow!(
                "{difference}, and the run in {} is complete: {remedy}",
                path.display()
            )),
            error => Failure::input(error),
        })
    };
    // Whoever wants a longer run may have changed its case.
    let is_case = |name: &str| name == "case.toml" || name.starts_with("inputs/");
    unchanged(&is_case, "run a changed case to another folder with --out")?;
    if manner.json {
        let is_summary = |name: &str| name == "summary.json";
        unchanged(
            &is_summary,
            "run its case.toml again, to another folder with --out",
        )?;
        let summary = read_summary(path).map_err(Failure::input)?;
        print(&summary_json(&summary))?;
    } else if manner.talks() {
        print(&format!("the run in {} is complete\n", path.display()))?;
    }
    Ok(())
}

/// The checkpoint to go on from, if the run has saved one.
fn load(path: &Path, case: &Case, previous: bool) -> Result<Option<LoadedCheckpoint>, Failure> {
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
                _ => format!("no whole one is kept beside it: {ANEW}"),
            }
        }
        CheckpointError::Case { .. } => format!("put back the files with which it was begun, or {ANEW}"),
        CheckpointError::Damaged { .. } | CheckpointError::Unreadable { .. } => ANEW.to_owned(),
        CheckpointError::Layout { .. } | CheckpointError::Program { .. } => format!("or {ANEW}"),
    }
}
