//! Host of a session in a Worker: it passes all output to the Worker.

use std::cell::{Cell, RefCell};
use std::collections::{HashMap, VecDeque};
use std::rc::Rc;

use serde::Serialize;
use slipfront_session::{Document, Event, Host, Job, OpenedCase, Presets, Task};

use crate::imports::{MessageKind, send_message};

/// Unread replies from which on the page gets only answers.
const MAX_UNREAD: u32 = 64;

/// Events that the session has not read yet, by the number of the task that sent them.
type EventQueues = Rc<RefCell<HashMap<u32, VecDeque<Event>>>>;

/// The host of a session in a Worker.
pub(crate) struct WorkerHost {
    presets: Presets,
    opening: Document,
    events: EventQueues,
    /// Number of Workers, besides the session's own, that share the parts of one computation.
    workers: u32,
    n_tasks: Cell<u32>,
    /// Messages that the page has not read yet.
    pub(crate) unread: Cell<u32>,
}

/// A run to be saved.
#[derive(Serialize)]
struct Saved<'a> {
    name: &'a str,
    document: &'a Document,
}

impl WorkerHost {
    pub(crate) fn new(presets: Presets, opening: Document, workers: u32) -> Self {
        Self {
            presets,
            opening,
            events: EventQueues::default(),
            workers,
            n_tasks: Cell::new(0),
            unread: Cell::new(0),
        }
    }

    pub(crate) fn presets(&self) -> &Presets {
        &self.presets
    }

    /// Queues an event of a task, unless the session has dropped the task.
    pub(crate) fn queue_event(&self, task: u32, event: Event) {
        if let Some(events) = self.events.borrow_mut().get_mut(&task) {
            events.push_back(event);
        }
    }
}

/// Serialises a value as JSON.
fn json(value: &impl Serialize) -> Vec<u8> {
    // These structs hold only texts and numbers, so serialisation cannot fail.
    serde_json::to_vec(value).expect("what is said is JSON")
}

impl Host for WorkerHost {
    fn reply(&self, reply: String) {
        send_message(MessageKind::Reply, 0, reply.as_bytes());
    }

    fn picture(&self, picture: Vec<u8>) {
        send_message(MessageKind::Picture, 0, &picture);
    }

    fn kymograph(&self, kymograph: Vec<u8>) {
        send_message(MessageKind::Kymograph, 0, &kymograph);
    }

    fn is_full(&self) -> bool {
        self.unread.get() >= MAX_UNREAD
    }

    /// Always false: a Worker ends with its page.
    fn is_gone(&self) -> bool {
        false
    }

    fn threads(&self) -> usize {
        1
    }

    fn workers(&self) -> usize {
        self.workers as usize
    }

    fn opening(&self) -> Result<OpenedCase, String> {
        Ok(self.opening.clone().into())
    }

    fn preset(&self, name: &str) -> Result<Document, String> {
        self.presets.document(name)
    }

    fn recorded_run(&self, _name: &str) -> Result<OpenedCase, String> {
        Err("this page has no folder of results".to_owned())
    }

    fn begin(&self, job: Job) -> Result<Box<dyn Task>, String> {
        let number = self.n_tasks.get() + 1;
        self.n_tasks.set(number);
        self.events.borrow_mut().insert(number, VecDeque::new());
        send_message(MessageKind::Job, number, &json(&job));
        let events = Rc::clone(&self.events);
        Ok(Box::new(WorkerTask { number, events }))
    }

    fn save(&self, document: Document, name: &str) -> Result<(), String> {
        if !slipfront_session::is_plain_name(name) {
            return Err(format!(
                "{name:?} is no name for a file: take up to 100 letters, digits, blanks and -_.+(), and no dot at the start"
            ));
        }
        let document = &document;
        send_message(MessageKind::Save, 0, &json(&Saved { name, document }));
        Ok(())
    }

    fn stop_saving(&self, name: &str) {
        send_message(MessageKind::StopSaving, 0, name.as_bytes());
    }
}

/// A task that another Worker does.
struct WorkerTask {
    number: u32,
    events: EventQueues,
}

impl Task for WorkerTask {
    fn next_event(&mut self) -> Option<Event> {
        self.events.borrow_mut().get_mut(&self.number)?.pop_front()
    }
}

impl Drop for WorkerTask {
    fn drop(&mut self) {
        self.events.borrow_mut().remove(&self.number);
        send_message(MessageKind::End, self.number, &[]);
    }
}
