//! Jobs that end with one reply: reading a record, computing a sensitivity, drawing a texture.

use super::state::Session;
use crate::controls;
use crate::event::EventKind;
use crate::host::Task;
use crate::job::{Job, JobKind};
use crate::protocol::{DrawingFormat, RecordFile, Reply};

/// Name of the request with a job that does not depend on the case.
const READ_RECORD: &str = "read_record";

/// A job that ends with one reply. Dropping it ends the job.
pub(super) struct Errand {
    /// Name of the request.
    request: &'static str,
    task: Box<dyn Task>,
}

impl Session {
    /// Begins to read a record.
    pub(super) fn read_record(&mut self, record: RecordFile) -> Result<(), String> {
        let document = self.document()?.clone();
        self.begin_errand(READ_RECORD, Job::new(document, JobKind::ReadRecord(record)))
    }

    /// Begins to compute static friction at the present value of the quantity of a slider, and at another
    /// value.
    pub(super) fn sensitivity(&mut self, control: &str) -> Result<(), String> {
        self.apply_edits();
        let document = self.document()?.clone();
        let values = controls::two_values(&*self.case_of(&document)?, control)?;
        self.begin_errand("sensitivity", Job::new(document, JobKind::Sensitivity(values)))
    }

    /// Begins to draw the texture.
    pub(super) fn drawing(&mut self, format: DrawingFormat) -> Result<(), String> {
        self.apply_edits();
        let document = self.document()?.clone();
        self.begin_errand("drawing", Job::new(document, JobKind::Draw(format)))
    }

    /// Begins a job that replaces an earlier job for the same request.
    fn begin_errand(&mut self, request: &'static str, job: Job) -> Result<(), String> {
        self.errands.retain(|errand| errand.request != request);
        let task = self.host.begin(job)?;
        self.errands.push(Errand { request, task });
        Ok(())
    }

    /// Abandons jobs for a case that is no longer the present one.
    pub(super) fn give_up_errands(&mut self) {
        self.errands.retain(|errand| errand.request == READ_RECORD);
    }

    /// Sends the replies of jobs that have ended.
    pub(super) fn follow_errands(&mut self) {
        let host = &self.host;
        self.errands.retain_mut(|Errand { request, task }| {
            let Some(event) = task.next_event() else {
                return true;
            };
            host.reply(match event.0 {
                EventKind::Replied(reply) => reply,
                _ => {
                    let sentence = format!("`{request}` failed by a defect of its own");
                    Reply::Refused {
                        of: request,
                        sentence,
                    }
                    .json()
                }
            });
            false
        });
    }
}
