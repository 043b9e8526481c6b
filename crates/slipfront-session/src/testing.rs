//! A session for tests, without threads: its host runs each job at once, and its clock advances only on
//! demand.

use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use serde_json::Value;

use crate::document::Document;
use crate::event::{Event, EventKind, Worker};
use crate::host::{Host, OpenedCase, Task};
use crate::job::Job;
use crate::presets::Presets;
use crate::protocol::Message;
use crate::session::Session;

/// Time that passes for a job between two reads of its clock.
const TICK: Duration = Duration::from_secs(3);

/// A host for tests, which records all output and requests of a session.
#[derive(Default)]
pub(crate) struct TestHost {
    replies: RefCell<Vec<String>>,
    pub(crate) pictures: RefCell<Vec<Vec<u8>>>,
    pub(crate) is_full: Cell<bool>,
    pub(crate) is_gone: Cell<bool>,
    /// Names of the runs to save, and of the runs to stop saving.
    pub(crate) saves: RefCell<Vec<String>>,
    pub(crate) stops: RefCell<Vec<String>>,
    /// Whether searches continue for ever.
    pub(crate) is_endless: Cell<bool>,
}

impl Host for TestHost {
    fn reply(&self, reply: String) {
        self.replies.borrow_mut().push(reply);
    }

    fn picture(&self, picture: Vec<u8>) {
        self.pictures.borrow_mut().push(picture);
    }

    fn kymograph(&self, kymograph: Vec<u8>) {
        self.pictures.borrow_mut().push(kymograph);
    }

    fn is_full(&self) -> bool {
        self.is_full.get()
    }

    fn is_gone(&self) -> bool {
        self.is_gone.get()
    }

    fn threads(&self) -> usize {
        1
    }

    fn workers(&self) -> usize {
        2
    }

    fn opening(&self) -> Result<OpenedCase, String> {
        let document = Document::new("opening", "", |_| Err("there is none".to_owned()));
        document.map(OpenedCase::from).map_err(|error| error.to_string())
    }

    fn preset(&self, name: &str) -> Result<Document, String> {
        Presets::default().document(name)
    }

    fn recorded_run(&self, name: &str) -> Result<OpenedCase, String> {
        Err(format!("{name} is not here"))
    }

    fn begin(&self, job: Job) -> Result<Box<dyn Task>, String> {
        let worker = TestWorker::default();
        job.run(&worker);
        let mut events = worker.events.into_inner();
        if self.is_endless.get() {
            events.retain(|event| !matches!(event.0, EventKind::Searched(_)));
        }
        Ok(Box::new(TestTask {
            events,
            is_next: false,
        }))
    }

    fn save(&self, _document: Document, name: &str) -> Result<(), String> {
        self.saves.borrow_mut().push(name.to_owned());
        Ok(())
    }

    fn stop_saving(&self, name: &str) {
        self.stops.borrow_mut().push(name.to_owned());
    }
}

/// A finished job that gives an event only at every other call.
struct TestTask {
    events: VecDeque<Event>,
    is_next: bool,
}

impl Task for TestTask {
    fn next_event(&mut self) -> Option<Event> {
        self.is_next = !self.is_next;
        self.is_next.then(|| self.events.pop_front()).flatten()
    }
}

#[derive(Default)]
struct TestWorker {
    events: RefCell<VecDeque<Event>>,
    stop: AtomicBool,
    now: Cell<Duration>,
}

impl Worker for TestWorker {
    fn send(&self, event: Event) {
        self.events.borrow_mut().push_back(event);
    }

    fn stop(&self) -> &AtomicBool {
        &self.stop
    }

    fn now(&self) -> Duration {
        self.now.set(self.now.get() + TICK);
        self.now.get()
    }
}

/// A session of a test, and the time on its clock.
pub(crate) struct TestSession {
    pub(crate) session: Session,
    pub(crate) host: Rc<TestHost>,
    pub(crate) now: Duration,
}

impl TestSession {
    /// A session without an open case.
    pub(crate) fn new() -> Self {
        let host = Rc::new(TestHost::default());
        Self {
            session: Session::new(Rc::clone(&host) as Rc<dyn Host>),
            host,
            now: Duration::ZERO,
        }
    }

    /// A session with a paused case.
    pub(crate) fn with(case: &str) -> Self {
        let mut test = Self::new();
        test.ask(serde_json::json!({ "do": "view", "paused": true }));
        test.ask(serde_json::json!({ "do": "open", "source": { "toml": case } }));
        test
    }

    /// Passes a request to the session, and calls it once.
    pub(crate) fn ask(&mut self, request: Value) -> Vec<Value> {
        self.session
            .handle(Message(serde_json::from_value(request).unwrap()));
        self.advance();
        self.replies()
    }

    /// Calls the session once, and returns the time at which there is something to do next.
    pub(crate) fn advance(&mut self) -> Option<Duration> {
        self.session.advance(self.now)
    }

    /// Calls the session until a time; each call takes the time `each`.
    pub(crate) fn advance_until(&mut self, end: Duration, each: Duration) {
        while let Some(due) = self.advance()
            && due <= end
        {
            self.now = if due > self.now { due } else { self.now + each };
            if self.now > end {
                break;
            }
        }
    }

    pub(crate) fn replies(&self) -> Vec<Value> {
        let replies = self.host.replies.take();
        replies
            .iter()
            .map(|text| serde_json::from_str(text).unwrap())
            .collect()
    }
}
