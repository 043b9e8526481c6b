//! `slipfront run --resume DIR`: resumes a run that was interrupted.

use std::path::Path;
use std::sync::Arc;

use slipfront::Execution;
use slipfront::communicator::Alone;
use slipfront_case::case::Case;
use slipfront_case::case_file::{CaseError, CaseFile};
use slipfront_run::agree::RankFailure;
use slipfront_run::checkpoint::{CheckpointError, Checkpoints, LoadedCheckpoint};
use slipfront_run::clock;
use slipfront_run::run_folder::inspection::{Contents, Inspection};
use slipfront_run::run_folder::unfinished::Unfinished;
use slipfront_run::run_folder::{OpenedFolder, expect_shared};
use slipfront_run::running::Running;
use slipfront_run::summary::{read_summary, summary_json};
use slipfront_run::verify::{VerifyError, expect_as_written};

use super::complete::complete;
use super::execution::RunOptions;
use crate::failure::Failure;
use crate::make_case::make_case;
use crate::print::{print, print_message};
use crate::ranks::CommandRanks;
use crate::report::physics::physics;

pub(super) fn resume(path: &Path, previous: bool, options: &RunOptions) -> Result<(), RankFailure> {
    let ranks = &options.ranks;
    let folder = ranks.agree(open(path, ranks.is_first()))?;
    let run = &folder.inspection;
    let is_complete = matches!(run.contents, Contents::Complete(_));
    // Ranks may see the folder at slightly different times: the first rank decides.
    if ranks.any(ranks.is_first() && is_complete) {
        return ranks.first(|| report_complete(run, options)).map(|_| ());
    }
    // Ranks must agree before this: a rank without a case would leave the others waiting for it.
    let file = ranks.agree(run.case_to_resume().map_err(Failure::input))?.clone();
    let case = Arc::new(ranks.agree(case_to_resume(run, file, options))?);
    let execution = options.execution(&case)?;
    let loaded = ranks.agree(load(run, &case, previous, ranks))?;
    ranks.first(|| check_disk(run, &case, options))?;
    let (running, checkpoints, from) = ranks.agree(begin(run, &case, loaded, previous, execution, ranks))?;
    let folder = ranks.first(|| folder.resume(&case).map_err(Failure::input))?;
    expect_shared(checkpoints.folder(), &*ranks.communicator())?;
    if options.is_verbose() {
        print_message(&physics(&case));
        print_message(&format!("goes on from {from}\n"));
    }
    complete(running, folder, checkpoints, options)
}

/// Locks and inspects the folder; the first rank locks it for all.
fn open(path: &Path, locks: bool) -> Result<OpenedFolder, Failure> {
    let opened = if locks {
        OpenedFolder::open(path)
    } else {
        OpenedFolder::open_unlocked(path)
    };
    opened.map_err(Failure::input)
}

fn check_disk(run: &Inspection, case: &Case, options: &RunOptions) -> Result<(), Failure> {
    let replaced = run.managed_bytes().map_err(Failure::input)?;
    case.budget
        .check_disk(&case.file, &run.path, replaced, options.interval.saves())
        .map_err(Failure::input)
}

/// Starts from a checkpoint, if there is one, and reports its step.
fn begin(
    run: &Inspection,
    case: &Arc<Case>,
    loaded: Option<LoadedCheckpoint>,
    previous: bool,
    execution: Execution,
    ranks: &CommandRanks,
) -> Result<(Running, Checkpoints, String), Failure> {
    Ok(match loaded {
        None => {
            let checkpoints = Checkpoints::new(&run.path, case, clock::now());
            let running = Running::start(case, None, execution);
            (
                running,
                checkpoints,
                "the start, because it has no checkpoint".to_owned(),
            )
        }
        Some(loaded) => {
            let checkpoints = Checkpoints::after(case, &loaded);
            // The number of steps of a run with held drive is not known in advance.
            let of = if case.model.drive.is_held() {
                String::new()
            } else {
                format!(" of {}", case.time_plan.last_step)
            };
            let from = format!("step {}{of}", loaded.step());
            let resumed = loaded.resume(case, execution);
            let resumed = resumed.map_err(|error| refused(ranks, &error, run, case, previous))?;
            let running = resumed.ok_or_else(|| {
                Failure::input(format!(
                    "the checkpoint in {} does not belong to its case; {ANEW}",
                    run.path.display()
                ))
            })?;
            (running, checkpoints, from)
        }
    })
}

/// The remedy if no checkpoint can be used.
const ANEW: &str = "remove the checkpoints to start again with --resume";

/// The case of the folder, built by all ranks together.
fn case_to_resume(run: &Inspection, file: CaseFile, options: &RunOptions) -> Result<Case, Failure> {
    let path = &run.path;
    // Results are named after their folder, not after the file in it.
    let folder = path.canonicalize().unwrap_or_else(|_| path.clone());
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let mut ranks_differ = false;
    let made = make_case(&options.ranks, &options.signals, options.quiet, |watch, ranks| {
        let made = Case::to_run(file, &name, path.as_path(), watch, ranks);
        made.inspect_err(|error| ranks_differ = matches!(error, CaseError::Differs(_)))
    });
    let case = made.map_err(|failure| match failure {
        // A difference between ranks is no sign of an interrupted run.
        Failure::Input(error) if !ranks_differ => {
            let hint =
                "if the run was stopped before all its inputs were copied, start it again with --force";
            Failure::input(format!("{error}\n{hint}"))
        }
        failure => failure,
    })?;
    case.budget
        .check_memory(&case.file, true)
        .map_err(Failure::input)?;
    Ok(case)
}

/// Reports that a run is already complete.
fn report_complete(run: &Inspection, options: &RunOptions) -> Result<(), Failure> {
    run.case_to_resume().map_err(Failure::input)?;
    run.manifest().map_err(Failure::input)?;
    let path = &run.path;
    // A kill may have left this folder behind. If the disk is read-only, the folder does no harm.
    let unfinished = Unfinished::in_folder(path);
    if unfinished.is_managed().map_err(Failure::input)? {
        let _ = unfinished.remove();
    }
    let unchanged = |which: &dyn Fn(&str) -> bool, remedy: &str| {
        expect_as_written(run, which).map_err(|error| match error {
            VerifyError::Changed { difference, .. } => Failure::input(format!(
                "{difference}, and the run in {} is complete: {remedy}",
                path.display()
            )),
            error => Failure::input(error),
        })
    };
    // A user who wants a longer run may have changed its case.
    let is_case = |name: &str| name == "case.toml" || name.starts_with("inputs/");
    unchanged(&is_case, "run a changed case in another folder with --out")?;
    if options.json {
        let is_summary = |name: &str| name == "summary.json";
        unchanged(
            &is_summary,
            "run its case.toml again in another folder with --out",
        )?;
        let summary = read_summary(path).map_err(Failure::input)?;
        print(&summary_json(&summary))?;
    } else if options.is_verbose() {
        print_message(&format!("the run in {} is complete\n", path.display()));
    }
    Ok(())
}

/// Loads the checkpoint to resume from, if the run has saved one.
fn load(
    run: &Inspection,
    case: &Case,
    previous: bool,
    ranks: &CommandRanks,
) -> Result<Option<LoadedCheckpoint>, Failure> {
    match Checkpoints::load(&run.path, case, previous, &*ranks.communicator()) {
        Ok(None) if previous => Err(Failure::input(format!(
            "{} has no checkpoint before the latest one",
            run.path.display()
        ))),
        Ok(loaded) => Ok(loaded),
        Err(error) => Err(refused(ranks, &error, run, case, previous)),
    }
}

/// The failure for a checkpoint that cannot be used, with the remedy. All ranks refuse it; the first rank,
/// which prints, finds the remedy.
fn refused(
    ranks: &CommandRanks,
    error: &CheckpointError,
    run: &Inspection,
    case: &Case,
    previous: bool,
) -> Failure {
    let remedy = if ranks.is_first() {
        remedy(error, run, case, previous)
    } else {
        String::new()
    };
    Failure::input(format!("{error}; {remedy}"))
}

/// The remedy when a checkpoint is refused.
fn remedy(error: &CheckpointError, run: &Inspection, case: &Case, previous: bool) -> String {
    match error {
        CheckpointError::Damaged { .. } | CheckpointError::Unreadable { .. } if !previous => {
            match Checkpoints::load(&run.path, case, true, &Alone) {
                Ok(Some(loaded)) => format!(
                    "the earlier checkpoint, of step {}, is intact: add --previous to resume from it",
                    loaded.step()
                ),
                _ => format!("there is no intact checkpoint: {ANEW}"),
            }
        }
        CheckpointError::Differs(_) => "all ranks need the same folder, on a shared disk".to_owned(),
        CheckpointError::Case { .. } => format!("restore the original input files, or {ANEW}"),
        CheckpointError::Damaged { .. } | CheckpointError::Unreadable { .. } => ANEW.to_owned(),
        CheckpointError::Layout { .. } | CheckpointError::Program { .. } => format!("or {ANEW}"),
    }
}
