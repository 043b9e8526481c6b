//! Part of `slipfront run` that new and resumed runs share: from the first step to the manifest.

use std::path::Path;
use std::sync::Arc;

use slipfront_case::case::Case;
use slipfront_run::agree::RankFailure;
use slipfront_run::checkpoint::Checkpoints;
use slipfront_run::manifest::Processors;
use slipfront_run::names::{CASE, FIELDS, KYMOGRAPH, RunPicture, SERIES, STATE, SUMMARY};
use slipfront_run::observers::tables;
use slipfront_run::pictures;
use slipfront_run::pictures::error::RunPictureError;
use slipfront_run::results;
use slipfront_run::run_folder::RunFolder;
use slipfront_run::running::Running;
use slipfront_run::summary::summary_json;

use super::checkpoint_timer::CheckpointTimer;
use super::execution::RunOptions;
use crate::failure::Failure;
use crate::print::{print, print_message};
use crate::progress::run::RunProgress;
use crate::report::summary::summary;

/// Runs to the end and writes the results to the folder of the checkpoints, which the first rank holds.
pub(super) fn complete(
    mut running: Running,
    folder: Option<RunFolder>,
    checkpoints: Checkpoints,
    options: &RunOptions,
) -> Result<(), RankFailure> {
    let (case, ranks) = (Arc::clone(running.case()), &options.ranks);
    let (started, first_step) = (checkpoints.started(), running.snapshot().step);
    let out = checkpoints.folder().to_owned();
    let mut timer = CheckpointTimer::new(checkpoints, options);
    let mut progress = RunProgress::new(&running, options.quiet);
    let mut has_failed = false;
    let reason = loop {
        let reached = running.advance(case.steps_per_poll());
        if let Some(failure) = running.device_failure().filter(|_| !has_failed) {
            has_failed = true;
            progress.note(&format!("warning: {failure}; the CPU computes the other steps"));
        }
        match reached {
            Ok(Some(reason)) => break reason,
            Ok(None) => {}
            Err(error) => {
                // The run would diverge again, so there is nothing to resume. All ranks detect it at the same
                // step, from sums over the lattice.
                if let Some(folder) = folder {
                    folder.discard();
                }
                return ranks.agree(Err(Failure::running(error)));
            }
        }
        progress.show(&running);
        timer.save_if_due(&running, &progress)?;
    };
    progress.finish();
    let steps = running.snapshot().step - first_step;
    let processors = Processors {
        threads: options.threads,
        ..running.processors()
    };
    let mut record = running.record(reason);
    let failed = |error: RunPictureError| Failure::running(format!("{error}; {}", timer.remedy()));
    let mut folder = folder;
    let tables = folder
        .as_mut()
        .map(|folder| results::write_tables(&case, &record, folder));
    ranks.agree(tables.transpose().map_err(|error| failed(error.into())))?;
    let blocks = results::write_blocks(&case, &mut record, &out, &*ranks.communicator());
    let blocks = ranks.agree(blocks.map_err(|error| failed(error.into())))?;
    let finished = folder.map(|mut folder| {
        for (name, file) in blocks {
            folder.place(name, file)?;
        }
        if options.draws {
            pictures::complete(&case, folder, started, processors)
        } else {
            Ok(folder.complete(&case, started, processors)?)
        }
    });
    ranks.agree(finished.transpose().map_err(failed))?;
    if options.json {
        ranks.first(|| print(&summary_json(&record.summary)))?;
    } else if options.is_verbose() {
        print_message(&summary(&case, &record.summary));
        if let Some(traffic) = ranks.traffic(steps) {
            print_message(&format!("{:<18}{traffic}\n", "rank 0 sends"));
        }
        print_message(&files(&case, &out));
    }
    Ok(())
}

fn files(case: &Case, out: &Path) -> String {
    let pictures = RunPicture::ALL.map(|picture| (format!("{}.svg .png", picture.name()), picture.shows()));
    let tables = tables().map(|table| (table.file, table.shows));
    let files = [(SERIES, "the friction curve, one row per time")]
        .into_iter()
        .chain(tables)
        .chain([
            (KYMOGRAPH, "sliding blocks against position and time"),
            (FIELDS, "the fields, for ParaView, Python, MATLAB"),
            (STATE, "the final state, from which another case can start"),
            (SUMMARY, "the numbers above"),
            (CASE, "the case with all defaults"),
        ]);
    let files = files.map(|(name, shows)| (name.to_owned(), shows));
    let mut text = format!("files in {}\n", out.display());
    for (name, what) in pictures.into_iter().chain(files) {
        // A check that fails is no proof that a file is missing.
        let first = name.split(' ').next().unwrap_or(&name);
        if out.join(first).try_exists().unwrap_or(true) {
            text += &format!("  {name:<18} {what}\n");
        }
    }
    if !case.inputs.is_empty() {
        text += &format!("  {:<18} copies of the input files of the case\n", "inputs/");
    }
    text
}
