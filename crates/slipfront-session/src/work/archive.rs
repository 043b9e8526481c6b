//! Archive of a run from rest, with the same bytes as `slipfront run`.

use std::sync::Arc;
use std::time::Duration;

use slipfront::Execution;
use slipfront_run::manifest::{Manifest, RunTimes};
use slipfront_run::names::MANIFEST;
use slipfront_run::pictures;
use slipfront_run::results;
use slipfront_run::running::Running;

use crate::document::Document;
use crate::sentence::sentence;
use crate::zip;

/// Share of a run between two progress reports.
const SHARE: f64 = 0.01;

/// Runs a case from rest to its end, and returns an archive of its files: the case and the files that it
/// reads, summary, series, fields, kymograph and pictures, each with the same bytes as `slipfront run`, and
/// the manifest of these files. `now` returns the time of day, UTC as in RFC 3339, and the time of a
/// monotonic clock; `report_progress` gets the completed fraction of the run. If pictures cannot be drawn,
/// the manifest says why.
///
/// # Errors
/// A sentence, if the case cannot be run, or the run diverges.
pub fn run_archive(
    document: &Document,
    now: &dyn Fn() -> (String, Duration),
    report_progress: &dyn Fn(f64),
) -> Result<Vec<u8>, String> {
    let (started, began) = now();
    let case = Arc::new(document.case(&mut |_| true).map_err(sentence)?);
    let mut running = Running::start(&case, None, Execution::default());
    let mut reported = 0.0;
    let reason = loop {
        if let Some(reason) = running.advance(case.steps_per_poll()).map_err(sentence)? {
            break reason;
        }
        let share = running.snapshot().drive_steps as f64 / case.time_plan.last_step as f64;
        if share >= reported + SHARE {
            reported = share;
            report_progress(share);
        }
    };
    let mut record = running.record(reason);
    let mut files = results::in_memory(&case, &mut record).map_err(sentence)?;
    let without_pictures = match pictures::in_memory(&files, case.output.movie) {
        Ok(pictures) => {
            files.extend(pictures);
            None
        }
        Err(error) => Some(error.to_string()),
    };
    let (finished, ended) = now();
    let times = RunTimes {
        started,
        finished,
        wall_time_s: ended.saturating_sub(began).as_secs_f64(),
    };
    let manifest = Manifest::of_run_in_memory(&files, &case, times, without_pictures);
    files.push((MANIFEST.to_owned(), manifest));
    let files = files
        .iter()
        .map(|(name, contents)| (name.as_str(), contents.as_slice()));
    zip::archive(files).map_err(|error| format!("the archive cannot be made: {error}"))
}
