//! Functions of the session that the Worker calls.

use std::cell::RefCell;
use std::rc::Rc;

use serde::Deserialize;
use slipfront_session::{Document, Event, Host, Message, Presets, Session, failed, hello};

use crate::given::{self, duration, read, refuse};
use crate::host::WorkerHost;

thread_local! {
    static PAGE: RefCell<Option<(Session, Rc<WorkerHost>)>> = const { RefCell::new(None) };
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
