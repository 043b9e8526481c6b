//! The interface of a session to its host, which owns the session and connects it to the page, to folders and
//! to threads.

use crate::document::Document;
use crate::event::Event;
use crate::job::Job;
use crate::recorded::RecordedRun;

/// The owner of a session: it passes on the output of the session, and does what the session itself may not
/// do.
pub trait Host {
    /// Sends a reply, which is JSON, to the page, after all previous ones.
    fn reply(&self, reply: String);

    /// Sends a picture of the field to the page, in place of one that has not been sent yet.
    fn picture(&self, picture: Vec<u8>);

    /// Sends a kymograph to the page, in place of one that has not been sent yet.
    fn kymograph(&self, kymograph: Vec<u8>);

    /// Whether the page is so far behind that it gets only answers.
    fn is_full(&self) -> bool;

    /// Whether the page is gone, so all work for it is to end.
    fn is_gone(&self) -> bool;

    /// Number of threads of a run or a job.
    fn threads(&self) -> usize;

    /// Number of parts of one computation that can run at the same time.
    fn workers(&self) -> usize;

    /// Returns the case with which the page opens unless another one is named.
    ///
    /// # Errors
    /// A sentence, if it cannot be read any more.
    fn opening(&self) -> Result<OpenedCase, String>;

    /// Returns a preset by name.
    ///
    /// # Errors
    /// A sentence, if there is no preset of that name.
    fn preset(&self, name: &str) -> Result<Document, String>;

    /// Returns a recorded run by name.
    ///
    /// # Errors
    /// A sentence, if there is no run of that name, or it cannot be read.
    fn recorded_run(&self, name: &str) -> Result<OpenedCase, String>;

    /// Begins a job outside the session.
    ///
    /// # Errors
    /// A sentence, if the system refuses.
    fn begin(&self, job: Job) -> Result<Box<dyn Task>, String>;

    /// Begins to save a run of a case from rest under this name.
    ///
    /// # Errors
    /// A sentence, if the name is taken or invalid, or too many runs are being saved.
    fn save(&self, document: Document, name: &str) -> Result<(), String>;

    /// Stops saving the run of this name, if it is under way.
    fn stop_saving(&self, name: &str);
}

/// A job that was begun outside the session. Dropping the task ends the job.
pub trait Task {
    /// Returns the next event of the job; none if there is nothing new.
    fn next_event(&mut self) -> Option<Event>;
}

/// A case that is opened.
pub struct OpenedCase {
    /// The case as a document.
    pub document: Document,
    /// The recorded run of the case, if there is one.
    pub recorded: Option<RecordedRun>,
}

impl From<Document> for OpenedCase {
    fn from(document: Document) -> Self {
        Self {
            document,
            recorded: None,
        }
    }
}
