//! Static friction with and without texture over several seeds.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use slipfront_case::case::Case;
use slipfront_run::running::run_unless;
use slipfront_run::summary::Summary;
use toml::Value;

use crate::document::Document;
use crate::event::{Event, EventKind, Worker};
use crate::protocol::{Estimate, RepeatedReply};

/// Runs the case, and if it has texture the same without, with the seeds from 1 on, each to the end of its first peak. Runs without a
/// transition have no static friction: they are counted, and neither a mean nor a change has them.
pub(crate) fn repeat(document: &Document, seeds: u64, worker: &dyn Worker) {
    let twin = document.has_texture().then(|| document.without_texture());
    let documents: Vec<&Document> = [document].into_iter().chain(&twin).collect();
    let mut found: Vec<Vec<Option<f64>>> = vec![Vec::new(); documents.len()];
    for seed in 1..=seeds {
        for (document, found) in documents.iter().zip(&mut found) {
            match static_friction(document, seed, worker.stop()) {
                Ok(Some(friction)) => found.push(friction),
                Ok(None) => return,
                Err(sentence) => return worker.tell(Event(EventKind::NotRepeated(sentence))),
            }
        }
        let without = found.get(1).map_or(&[][..], Vec::as_slice);
        let pairs = found[0].iter().zip(without);
        let changes = pairs.map(|(one, other)| Some(100.0 * ((*one)? / (*other)? - 1.0)));
        let changes: Vec<Option<f64>> = changes.collect();
        worker.tell(Event(EventKind::Repeated(RepeatedReply {
            done: seed,
            of: seeds,
            finished: seed == seeds,
            change_percent: estimate(&changes),
            with: estimate(&found[0]),
            without: estimate(without),
            without_transition: found.iter().flatten().filter(|found| found.is_none()).count(),
        })));
    }
}

/// The estimate of the values that there are.
fn estimate(values: &[Option<f64>]) -> Option<Estimate> {
    let values: Vec<f64> = values.iter().copied().flatten().collect();
    Estimate::of(&values)
}

/// mu_s* of a case with this seed, which is none of a run without a transition; none if it was stopped.
fn static_friction(document: &Document, seed: u64, stop: &AtomicBool) -> Result<Option<Option<f64>>, String> {
    let keys = [
        ("friction.seed", Value::Integer(seed as i64)),
        ("time.stop", Value::from("after_onset")),
    ];
    let seeded = document.with(keys.map(|(key, value)| (key.to_owned(), Some(value))))?;
    let case: Arc<Case> = Arc::new(seeded.case_to_show().map_err(|error| error.to_string())?);
    let record = run_unless(&case, &|| stop.load(Ordering::Relaxed));
    let record = record.transpose().map_err(|error| error.to_string())?;
    let found = |summary: &Summary| summary.transition.then_some(summary.static_friction_star);
    Ok(record.map(|record| found(&record.summary)))
}
