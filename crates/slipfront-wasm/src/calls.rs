//! Functions of the module that the Worker calls.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use serde::Deserialize;
use slipfront_session::{
    Document, Event, Host, Job, Message, NamedFiles, Presets, Session, Worker, failed, hello, run_archive,
};

use crate::bits::bits_of_run;
use crate::given;
use crate::host::WorkerHost;
use crate::imports::{Saying, tell};
use crate::questions::{clock, drawn_of, duration, time_of_day};

thread_local! {
    static PAGE: RefCell<Option<(Session, Rc<WorkerHost>)>> = const { RefCell::new(None) };
}

/// Reads the bytes that the Worker has given as JSON.
fn read<T: for<'de> Deserialize<'de>>() -> Result<T, String> {
    serde_json::from_slice(&given::take()).map_err(|error| error.to_string())
}

/// Passes on why something cannot be done.
fn refuse(done: Result<(), String>) {
    if let Err(sentence) = done {
        tell(Saying::Refusal, 0, sentence.as_bytes());
    }
}

/// Presets and the case with which the page opens.
#[derive(Deserialize)]
struct Beginning {
    presets: Presets,
    opening: Document,
}

/// Begins a session, given presets and the case with which the page opens, and how many Workers may go on
/// beside it.
pub(crate) fn open(workers: u32) {
    refuse(read().map(|Beginning { presets, opening }| {
        let host = Rc::new(WorkerHost::new(presets, opening, workers));
        host.reply(hello(host.presets(), &[], None));
        let session = Session::new(Rc::clone(&host) as Rc<dyn Host>);
        PAGE.set(Some((session, host)));
    }));
}

/// Handles a message of the page.
pub(crate) fn handle() {
    let text = String::from_utf8(given::take()).unwrap_or_default();
    PAGE.with_borrow_mut(|page| {
        let Some((session, host)) = page else { return };
        let message = Message::parse(&text);
        // It may hold the files of a run.
        drop(text);
        match message {
            Ok(message) => session.handle(message),
            Err(sentence) => host.reply(failed(sentence)),
        }
    });
}

/// Does what is due at a time of the Worker, ms, when the page has so many messages still to read; gives the
/// time at which to call again, ms, which is negative if there is nothing to do before a message.
pub(crate) fn advance(now: f64, unread: u32) -> f64 {
    PAGE.with_borrow_mut(|page| {
        let Some((session, host)) = page else { return -1.0 };
        host.unread.set(unread);
        let due = session.advance(duration(now));
        due.map_or(-1.0, |due| 1000.0 * due.as_secs_f64())
    })
}

/// Hears what work of this number tells.
pub(crate) fn hear(task: u32) {
    refuse(read().map(|event: Event| {
        PAGE.with_borrow(|page| {
            if let Some((_, host)) = page {
                host.hear(task, event);
            }
        });
    }));
}

/// Hears that work of this number has ended by a defect of its own.
pub(crate) fn hear_lost(task: u32) {
    PAGE.with_borrow(|page| {
        if let Some((_, host)) = page {
            host.hear(task, Event::lost());
        }
    });
}

/// A Worker that does work beside a session. It is ended from outside.
struct OtherWorker(AtomicBool);

impl Worker for OtherWorker {
    fn tell(&self, event: Event) {
        if let Ok(event) = serde_json::to_vec(&event) {
            tell(Saying::Event, 0, &event);
        }
    }

    fn stop(&self) -> &AtomicBool {
        &self.0
    }

    fn now(&self) -> Duration {
        clock()
    }
}

/// Does a job beside a session, and reports what it finds.
pub(crate) fn run() {
    refuse(read().map(|job: Job| job.run(&OtherWorker(AtomicBool::new(false)))));
}

/// Draws the pictures of a run of these files by the other module.
///
/// # Errors
/// A sentence, if there is no other module, or it cannot draw them.
fn draw(files: &[(String, Vec<u8>)], with_movie: bool) -> Result<NamedFiles, String> {
    let asked = postcard::to_stdvec(&(files, with_movie)).map_err(|error| error.to_string())?;
    postcard::from_bytes(&drawn_of(&asked)).unwrap_or_else(|_| Err(WITHOUT_PICTURES.to_owned()))
}

/// Why an archive has no pictures where the other module is missing or fails.
const WITHOUT_PICTURES: &str =
    "the part of the page that draws them is missing or has failed: slipfront plot FOLDER draws them";

/// Runs a case from rest, and gives the archive of its files.
pub(crate) fn save() {
    let now = || (time_of_day(), clock());
    let told = |share: f64| tell(Saying::Share, (1e6 * share) as u32, &[]);
    let archive = read().and_then(|document: Document| run_archive(&document, &now, &told, &draw));
    refuse(archive.map(|archive| tell(Saying::Archive, 0, &archive)));
}

/// A case as a text, and the files that it names.
#[derive(Deserialize)]
struct CaseOfFiles {
    toml: String,
    files: BTreeMap<String, Vec<u8>>,
}

/// Gives the bits of a run after so many steps.
pub(crate) fn bits(most_steps: u32) {
    let bits =
        read().and_then(|case: CaseOfFiles| bits_of_run(&case.toml, &case.files, u64::from(most_steps)));
    refuse(bits.map(|bits| tell(Saying::Bits, 0, bits.as_bytes())));
}
