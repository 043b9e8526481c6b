//! A list of runs, distributed over several jobs.

use std::vec;

use crate::document::Document;
use crate::event::EventKind;
use crate::host::{Host, Task};
use crate::job::{Job, JobKind};

/// Items that several jobs compute, each of which reports the result of its next item. Dropping it ends the
/// jobs.
pub(super) struct Distributed<T>(Vec<Part<T>>);

/// The items of one job.
struct Part<T> {
    task: Box<dyn Task>,
    /// Items that the job has not reported yet, in order.
    items: vec::IntoIter<T>,
}

impl<T: Clone> Distributed<T> {
    /// Begins the jobs that `kind` makes of their items, as many as the host has workers.
    ///
    /// # Errors
    /// A sentence, if the system refuses a job.
    pub(super) fn begin(
        host: &dyn Host,
        document: &Document,
        items: &[T],
        kind: impl Fn(Vec<T>) -> JobKind,
    ) -> Result<Self, String> {
        let workers = host.workers().clamp(1, items.len().max(1));
        let part = |first| {
            let own: Vec<T> = items.iter().skip(first).step_by(workers).cloned().collect();
            let task = host.begin(Job::new(document.clone(), kind(own.clone())))?;
            let items = own.into_iter();
            Ok(Part { task, items })
        };
        (0..workers).map(part).collect::<Result<_, _>>().map(Self)
    }

    /// Takes the items that were reported since the last call, each with its event.
    pub(super) fn reported(&mut self) -> Vec<(T, EventKind)> {
        let mut reported = Vec::new();
        for Part { task, items } in &mut self.0 {
            while items.len() > 0
                && let Some(event) = task.next_event()
            {
                reported.extend(items.next().map(|item| (item, event.0)));
            }
        }
        self.0.retain(|part| part.items.len() > 0);
        reported
    }

    /// Whether all items were reported.
    pub(super) fn is_done(&self) -> bool {
        self.0.is_empty()
    }
}
