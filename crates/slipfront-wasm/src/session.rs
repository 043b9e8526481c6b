//! Functions of the session that the Worker calls.

use std::cell::RefCell;
use std::rc::Rc;

use serde::Deserialize;
use slipfront_session::{Document, Event, Host, Message, Presets, Session, failed, hello};

use crate::host::WorkerHost;
use crate::input_bytes::{self, duration, read, refuse};

thread_local! {
    static PAGE: RefCell<Option<(Session, Rc<WorkerHost>)>> = const { RefCell::new(None) };
}

/// Presets and the case with which the page opens.
#[derive(Deserialize)]
struct Beginning {
    presets: Presets,
    opening: Document,
}

/// Begins a session, given presets, the case with which the page opens, and the number of further Workers
/// that may run.
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
    let text = String::from_utf8(input_bytes::take()).unwrap_or_default();
    PAGE.with_borrow_mut(|page| {
        let Some((session, host)) = page else { return };
        let message = Message::parse(&text);
        // The text may hold the files of a run.
        drop(text);
        match message {
            Ok(message) => session.handle(message),
            Err(sentence) => host.reply(failed(sentence)),
        }
    });
}

/// Does what is due at `now`, a time of the Worker in ms, when the page has `unread` messages still to read.
/// Returns the time of the next call, ms; negative if there is nothing to do before a message arrives.
pub(crate) fn advance(now: f64, unread: u32) -> f64 {
    PAGE.with_borrow_mut(|page| {
        let Some((session, host)) = page else { return -1.0 };
        host.unread.set(unread);
        let due = session.advance(duration(now));
        due.map_or(-1.0, |due| 1000.0 * due.as_secs_f64())
    })
}

/// Takes an event of the task with this number.
pub(crate) fn hear(task: u32) {
    refuse(read().map(|event| pass_on(task, event)));
}

/// Records that the task with this number has crashed.
pub(crate) fn hear_lost(task: u32) {
    pass_on(task, Event::lost());
}

fn pass_on(task: u32, event: Event) {
    PAGE.with_borrow(|page| {
        if let Some((_, host)) = page {
            host.queue_event(task, event);
        }
    });
}
