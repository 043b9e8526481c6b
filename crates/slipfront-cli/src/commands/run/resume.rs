//! `slipfront run --resume DIR`: goes on with a run that was interrupted.

use std::path::Path;
use std::sync::Arc;

use slipfront::communicator::Alone;
use slipfront_case::case::Case;
use slipfront_case::case_file::CaseFile;
use slipfront_run::checkpoint::{CheckpointError, Checkpoints, LoadedCheckpoint};
use slipfront_run::clock;
use slipfront_run::run_folder::OpenedFolder;
use slipfront_run::run_folder::inspection::{Contents, Inspection};
use slipfront_run::run_folder::unfinished::Unfinished;
use slipfront_run::running::Running;
use slipfront_run::summary::{read_summary, summary_json};
use slipfront_run::verify::{VerifyError, expect_as_written};

use super::complete::complete;
use super::options::RunOptions;
use crate::failure::Failure;
use crate::make_case::make_case;
use crate::print::{print, print_message};
use crate::report;

pub(super) fn resume(path: &Path, previous: bool, options: RunOptions) -> Result<(), Failure> {
    let folder = OpenedFolder::open(path).map_err(Failure::input)?;
    let run = &folder.inspection;
    let file = run.case_to_resume().map_err(Failure::input)?;
    match &run.contents {
        Contents::Complete(Ok(_)) => return report_complete(run, &options),
        Contents::Complete(Err(error)) => return Err(Failure::input(error.clone())),
        Contents::Empty | Contents::Foreign | Contents::Interrupted => {}
    }
    let case = Arc::new(case_to_resume(path, file.clone(), &options)?);
    let budget = case.budget.resumed();
    budget.check_memory(&case.file, true).map_err(Failure::input)?;
    let loaded = load(path, &case, previous)?;
    let replaced = run.managed_bytes().map_err(Failure::input)?;
    case.budget
        .check_disk(&case.file, path, replaced, options.interval.saves())
        .map_err(Failure::input)?;
    let (running, checkpoints, from) = match loaded {
        None => {
            let checkpoints = Checkpoints::new(path, &case, clock::now());
            let running = Running::start(&case, options.threads);
            (running, checkpoints, "the start: it has no checkpoint".to_owned())
        }
        Some(loaded) => {
            let checkpoints = Checkpoints::after(path, &case, &loaded);
            let from = format!("step {} of {}", loaded.step(), case.time_plan.last_step);
            let resumed = loaded.resume(&case, options.threads, &Alone);
            let resumed = resumed.map_err(|error| refused(&error, path, &case, previous))?;
            let running = resumed.ok_or_else(|| {
                let sentence = "is not one of a run of its case";
                Failure::input(anyhow::anyhow!(
                    "the checkpoint in {} {sentence}; {ANEW}",
                    path.display()
                ))
            })?;
            (running, checkpoints, from)
        }
    };
    let folder = folder.resume(&case).map_err(Failure::input)?;
    if options.is_verbose() {
        print_message(&report::physics(&case));
        print_message(&format!("goes on from {from}\n"));
    }
    complete(running, folder, checkpoints, options)
}

/// The remedy where no checkpoint can be used.
const ANEW: &str = "remove the checkpoints, and --resume begins from the start";

fn case_to_resume(path: &Path, file: CaseFile, options: &RunOptions) -> Result<Case, Failure> {
    // Results are named after their folder, not after the file in it.
    let folder = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let made = make_case(&options.signals, options.quiet, |watch| {
        Case::to_run(file, &name, path, watch)
    });
    made.map_err(|failure| match failure {
        Failure::Input(error) => {
            let hint =
                "if the run was stopped before all its inputs were copied, begin it again with --force";
            Failure::input(anyhow::anyhow!("{error}\n{hint}"))
        }
        failure => failure,
    })
}

/// Answers for a run in which nothing is left to do.
fn report_complete(run: &Inspection, options: &RunOptions) -> Result<(), Failure> {
    let path = &run.path;
    // A kill may have come before it was removed. On a disk that cannot be written it does no harm.
    let unfinished = Unfinished::of(path);
    if unfinished.is_managed() {
        let _ = unfinished.remove();
    }
    let unchanged = |which: &dyn Fn(&str) -> bool, remedy: &str| {
        expect_as_written(run, which).map_err(|error| match error {
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
    if options.json {
        let is_summary = |name: &str| name == "summary.json";
        unchanged(
            &is_summary,
            "run its case.toml again, to another folder with --out",
        )?;
        let summary = read_summary(path).map_err(Failure::input)?;
        print(&summary_json(&summary))?;
    } else if options.is_verbose() {
        print_message(&format!("the run in {} is complete\n", path.display()));
    }
    Ok(())
}

/// The checkpoint to go on from, if the run has saved one.
fn load(path: &Path, case: &Case, previous: bool) -> Result<Option<LoadedCheckpoint>, Failure> {
    match Checkpoints::load(path, case, previous, &Alone) {
        Ok(None) if previous => {
            let sentence = "holds no checkpoint before the latest one";
            Err(Failure::input(anyhow::anyhow!("{} {sentence}", path.display())))
        }
        Ok(loaded) => Ok(loaded),
        Err(error) => Err(refused(&error, path, case, previous)),
    }
}

/// A checkpoint that cannot be used, with the remedy.
fn refused(error: &CheckpointError, path: &Path, case: &Case, previous: bool) -> Failure {
    let remedy = remedy(error, path, case, previous);
    Failure::input(anyhow::anyhow!("{error}; {remedy}"))
}

/// The remedy when a checkpoint is refused.
fn remedy(error: &CheckpointError, path: &Path, case: &Case, previous: bool) -> String {
    match error {
        CheckpointError::Damaged { .. } | CheckpointError::Unreadable { .. } if !previous => {
            match Checkpoints::load(path, case, true, &Alone) {
                Ok(Some(loaded)) => format!(
                    "the one before it, of step {}, is whole: add --previous to go on from there",
                    loaded.step()
                ),
                _ => format!("no whole one is kept beside it: {ANEW}"),
            }
        }
        CheckpointError::Case { .. } => format!("put back the files with which it was begun, or {ANEW}"),
        CheckpointError::Damaged { .. } | CheckpointError::Unreadable { .. } => ANEW.to_owned(),
        CheckpointError::Layout { .. } | CheckpointError::Program { .. } => format!("or {ANEW}"),
    }
}
