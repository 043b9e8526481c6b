//! Runs to the end of the first peak: with each of several seeds, and at two values of a quantity.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use slipfront_run::running::run_unless;
use slipfront_run::summary::Summary;
use toml::Value;

use crate::controls::TwoValues;
use crate::document::Document;
use crate::event::{Event, EventKind, Frictions, Worker};
use crate::protocol::SensitivityReply;
use crate::sentence::sentence;

/// Runs the case, with and without its texture, with each of the seeds to the end of its first peak.
pub(super) fn repeat(document: &Document, seeds: &[u64], worker: &dyn Worker) {
    let twin = document.has_texture().then(|| document.twin()).transpose();
    let twin = match twin {
        Ok(twin) => twin,
        Err(error) => return worker.send(Event(EventKind::Repeated(Err(error)))),
    };
    let documents: Vec<&Document> = [document].into_iter().chain(&twin).collect();
    for &seed in seeds {
        let seed = ("friction.seed", Value::Integer(seed as i64));
        let runs = documents
            .iter()
            .map(|document| static_friction(document, seed.clone(), worker.stop()).transpose());
        let Some(found) = runs.collect::<Option<Result<Frictions, String>>>() else {
            return;
        };
        let goes_on = found.is_ok();
        worker.send(Event(EventKind::Repeated(found)));
        if !goes_on {
            return;
        }
    }
}

/// Returns mu_s* of a case with this value of a key: the outer none if the run was stopped, the inner none if
/// it had no transition.
pub(super) fn static_friction(
    document: &Document,
    (key, value): (&str, Value),
    stop: &AtomicBool,
) -> Result<Option<Option<f64>>, String> {
    let keys = [(key, value), ("time.stop", Value::from("after_onset"))];
    let changed = document.with(keys.map(|(key, value)| (key.to_owned(), Some(value))))?;
    let case = Arc::new(changed.case_unless(stop)?);
    let record = run_unless(&case, &|| stop.load(Ordering::Relaxed));
    let record = record.transpose().map_err(sentence)?;
    let found = |summary: &Summary| summary.transition.then_some(summary.static_friction_star);
    Ok(record.map(|record| found(&record.summary)))
}

/// Computes static friction mu_s* at two values of the quantity of a slider, and the change from the first to
/// the second.
///
/// # Errors
/// A sentence, if the case cannot be run, or the job was stopped.
pub(super) fn sensitivity(
    document: &Document,
    compared: &TwoValues,
    stop: &AtomicBool,
) -> Result<SensitivityReply, String> {
    let run = |value: &serde_json::Value| {
        let value = Value::try_from(value).map_err(sentence)?;
        let found = static_friction(document, (&compared.key, value), stop)?;
        found.ok_or_else(|| "the runs were stopped".to_owned())
    };
    let [first, second] = &compared.set_to;
    let percent = match [run(first)?, run(second)?] {
        [Some(first), Some(second)] => Some(100.0 * (second / first - 1.0)),
        _ => None,
    };
    Ok(SensitivityReply {
        control: compared.control.clone(),
        values: compared.values,
        percent,
    })
}
