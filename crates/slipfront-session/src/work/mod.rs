//! Jobs outside a session, wherever its host runs them: in a thread, or in another Worker.

mod archive;
mod calibrate;
mod drawing;
mod record;
mod repeat;
mod search;

pub use archive::run_archive;

use crate::event::{Event, EventKind, Worker};
use crate::job::{Job, JobKind};
use crate::protocol::Reply;

impl Job {
    /// Runs the job until it is done or the worker is to stop.
    pub fn run(&self, worker: &dyn Worker) {
        let Self { document, kind } = self;
        let send = |kind| worker.send(Event(kind));
        let reply = |of, found: Result<Reply, String>| {
            let found = found.unwrap_or_else(|sentence| Reply::Refused { of, sentence });
            send(EventKind::Replied(found.json()));
        };
        match kind {
            JobKind::Repeat(seeds) => repeat::repeat(document, seeds, worker),
            JobKind::Search => send(EventKind::Searched(search::search(document, worker))),
            JobKind::Compare(best) => {
                send(EventKind::Compared(search::compare(
                    document,
                    best,
                    worker.stop(),
                )));
            }
            JobKind::Sensitivity(values) => {
                let sensed = repeat::sensitivity(document, values, worker.stop());
                reply("sensitivity", sensed.map(Reply::Sensitivity));
            }
            JobKind::ReadRecord(file) => reply("read_record", Ok(Reply::Record(record::read(file)))),
            JobKind::Calibrate {
                request,
                made,
                is_elsewhere,
            } => calibrate::calibrate(document, request, made, *is_elsewhere, worker),
            JobKind::MakeRuns { request, wanted } => {
                calibrate::make_runs(document, request, wanted, worker);
            }
            JobKind::Draw(format) => {
                let drawn = drawing::draw(document, *format, worker.stop());
                reply("drawing", drawn.map(Reply::Drawing));
            }
        }
    }
}
