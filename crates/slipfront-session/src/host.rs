//! The interface of a session to its host, which holds the session and connects it with page, folders and
//! threads.

use crate::document::Document;
use crate::event::Event;
use crate::job::Job;
use crate::recorded::RecordedRun;

/// Whoever holds a session: it passes on what the session says, and does what the session may not.
pub trait Host {
    /// Sends the page a reply, which is JSON, behind those before it.
    fn reply(&self, reply: String);

    /// Sends the page a picture of the field, in the place of one that has not been sent yet.
    fn picture(&self, picture: Vec<u8>);

    /// Sends the page a kymograph, in the place of one that has not been sent yet.
    fn kymograph(&self, kymograph: Vec<u8>);

    /// Whether the page is so far behind that it is given no more than answers.
    fn is_full(&self) -> bool;

    /// Whether the page is gone, so that whatever is done for it is to end.
    fn is_gone(&self) -> bool;

    /// Threads of a run and of work beside the session.
    fn threads(&self) -> usize;

    /// How many parts of one computation beside the session go on at a time.
    fn workers(&self) -> usize;

    /// Gives the case with which the page opens unless another one is named.
    ///
    /// # Errors
    /// A sentence, if it cannot be read any more.
    fn opening(&self) -> Result<OpenedCase, String>;

    /// Gives a case to choose by its name.
    ///
    /// # Errors
    /// A sentence, if there is none of that name.
    fn preset(&self, name: &str) -> Result<Document, String>;

    /// Gives a run that was recorded by its name.
    ///
    /// # Errors
    /// A sentence, if there is none of that name, or it cannot be read.
    fn recorded_run(&self, name: &str) -> Result<OpenedCase, String>;

    /// Begins work beside the session.
    ///
    /// # Errors
    /// A sentence, if the system refuses.
    fn begin(&self, job: Job) -> Result<Box<dyn Task>, String>;

    /// Begins to save a run of a case from rest under this name.
    ///
    /// # Errors
    /// A sentence, if the name is taken or none, or too many runs are being saved.
    fn save(&self, document: Document, name: &str) -> Result<(), String>;

    /// Stops saving the run of this name, if it is under way.
    fn stop_saving(&self, name: &str);
}

/// A job that was begun beside the session. Dropping the task ends the job.
pub trait Task {
    /// Gives the next thing that the work tells; none if it has told nothing new.
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
