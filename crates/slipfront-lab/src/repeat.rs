//! Static friction with and without texture over several seeds, in a thread of its own.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Sender;
use std::thread;

use slipfront_case::case::Case;
use slipfront_run::running::run_unless;
use slipfront_run::study::Sample;
use toml::Value;

use crate::document::Document;
use crate::outbox::Outbox;
use crate::protocol::{Estimate, RepeatedReply, Reply};

/// Confidence of the intervals.
const CONFIDENCE: f64 = 0.95;

/// Work in the background, which ends when this is dropped.
pub(crate) struct Stoppable(Arc<AtomicBool>);

impl Stoppable {
    /// Begins work in a thread, which holds `working` and looks now and then whether it shall stop.
    pub(crate) fn begin(
        working: &Sender<()>,
        work: impl FnOnce(&AtomicBool) + Send + 'static,
    ) -> std::io::Result<Self> {
        let stop = Arc::new(AtomicBool::new(false));
        let (stops, working) = (Arc::clone(&stop), working.clone());
        thread::Builder::new().spawn(move || {
            work(&stops);
            drop(working);
        })?;
        Ok(Self(stop))
    }
}

impl Drop for Stoppable {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Runs the case and the same without texture with the seeds from 1 on, each to the end of its first peak.
pub(crate) fn repeat(document: &Document, seeds: u64, outbox: &Outbox, stop: &AtomicBool) {
    let (mut with, mut without) = (Vec::new(), Vec::new());
    for seed in 1..=seeds {
        let pair = static_friction(document, seed, stop)
            .and_then(|one| Ok((one, static_friction(&document.without_texture(), seed, stop)?)));
        let (one, other) = match pair {
            Ok((Some(one), Some(other))) => (one, other),
            Ok(_) => return,
            Err(sentence) => {
                return outbox.reply(&Reply::Refused {
                    of: "repeat",
                    sentence,
                });
            }
        };
        with.push(one);
        without.push(other);
        let changes: Vec<f64> = with
            .iter()
            .zip(&without)
            .map(|(one, other)| 100.0 * (one / other - 1.0))
            .collect();
        outbox.reply(&Reply::Repeated(RepeatedReply {
            done: seed,
            of: seeds,
            finished: seed == seeds,
            change_percent: estimate(&changes),
            with: estimate(&with),
            without: estimate(&without),
        }));
    }
}

fn estimate(values: &[f64]) -> Option<Estimate> {
    let sample = Sample::of(values, CONFIDENCE)?;
    Some(Estimate {
        mean: sample.mean,
        half_width: sample.half_width,
    })
}

/// mu_s* of a case with this seed; none if it was stopped.
fn static_friction(document: &Document, seed: u64, stop: &AtomicBool) -> Result<Option<f64>, String> {
    let keys = [
        ("friction.seed", Value::Integer(seed as i64)),
        ("time.stop", Value::from("after_onset")),
    ];
    let seeded = document.with(keys.map(|(key, value)| (key.to_owned(), Some(value))))?;
    let case: Arc<Case> = Arc::new(seeded.case_to_show().map_err(|error| error.to_string())?);
    let record = run_unless(&case, &|| stop.load(Ordering::Relaxed));
    let record = record.transpose().map_err(|error| error.to_string())?;
    Ok(record.map(|record| record.summary.static_friction_star))
}
