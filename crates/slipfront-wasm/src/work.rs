//! Functions that the Worker calls for jobs outside the session.

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use serde::Deserialize;
use slipfront_session::{Document, Event, Job, Worker, run_archive};

use crate::bits::bits_of_run;
use crate::imports::{MessageKind, date, now, send_message};
use crate::input_bytes::{self, duration, read, refuse};

/// The Worker of a job outside the session. It is stopped by terminating it from outside.
struct OtherWorker(AtomicBool);

impl Worker for OtherWorker {
    fn send(&self, event: Event) {
        if let Ok(event) = serde_json::to_vec(&event) {
            send_message(MessageKind::Event, 0, &event);
        }
    }

    fn stop(&self) -> &AtomicBool {
        &self.0
    }

    fn now(&self) -> Duration {
        clock()
    }
}

/// The time by the clock of the Worker.
fn clock() -> Duration {
    duration(now())
}

/// The time of day: UTC, as in RFC 3339.
fn time_of_day() -> String {
    date();
    String::from_utf8(input_bytes::take()).unwrap_or_default()
}

/// Runs a job outside the session, and reports its events.
pub(crate) fn run() {
    refuse(read().map(|job: Job| job.run(&OtherWorker(AtomicBool::new(false)))));
}

/// Runs a case from rest, and sends the archive of its files.
pub(crate) fn save() {
    let now = || (time_of_day(), clock());
    let report = |share: f64| send_message(MessageKind::Share, (1e6 * share) as u32, &[]);
    let archive = read().and_then(|document: Document| run_archive(&document, &now, &report));
    refuse(archive.map(|archive| send_message(MessageKind::Archive, 0, &archive)));
}

/// The text of a case, and the files that it names.
#[derive(Deserialize)]
struct CaseOfFiles {
    toml: String,
    files: BTreeMap<String, Vec<u8>>,
}

/// Sends the bits of a run after at most `most_steps` steps.
pub(crate) fn bits(most_steps: u32) {
    let bits =
        read().and_then(|case: CaseOfFiles| bits_of_run(&case.toml, &case.files, u64::from(most_steps)));
    refuse(bits.map(|bits| send_message(MessageKind::Bits, 0, bits.as_bytes())));
}
