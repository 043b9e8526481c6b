//! Jobs beside a session: computations that its host runs wherever it can.

use serde::{Deserialize, Serialize};

use crate::document::Document;
use crate::event::{Event, EventKind, Mask, Worker};
use crate::repeat::repeat;
use crate::search;

/// A computation beside a session. It reports what it finds by [`Event`]s, and can be sent as JSON.
#[derive(Debug, Serialize, Deserialize)]
pub struct Job {
    document: Document,
    kind: JobKind,
}

#[derive(Debug, Serialize, Deserialize)]
enum JobKind {
    /// A computation of static friction with each of these seeds.
    Repeat(Vec<u64>),
    /// A search for a texture with less static friction than the painted one.
    Search,
    /// A comparison of the best texture of a search with the painted one.
    Compare(Mask),
}

impl Job {
    /// Finds static friction of a case with each of these seeds, in their order.
    pub(crate) fn repeat(document: Document, seeds: Vec<u64>) -> Self {
        let kind = JobKind::Repeat(seeds);
        Self { document, kind }
    }

    /// Searches for a texture with less static friction than that of a case.
    pub(crate) fn search(document: Document) -> Self {
        let kind = JobKind::Search;
        Self { document, kind }
    }

    /// Compares a texture with that of a case, on surfaces that a search has not seen.
    pub(crate) fn compare(document: Document, best: Mask) -> Self {
        let kind = JobKind::Compare(best);
        Self { document, kind }
    }

    /// Does the job, until it is done or the worker is to stop.
    pub fn run(&self, worker: &dyn Worker) {
        let document = &self.document;
        match &self.kind {
            JobKind::Repeat(seeds) => repeat(document, seeds, worker),
            JobKind::Search => {
                let searched = search::search(document, worker);
                worker.tell(Event(EventKind::Searched(searched)));
            }
            JobKind::Compare(best) => {
                let compared = search::compare(document, best, worker.stop());
                worker.tell(Event(EventKind::Compared(compared)));
            }
        }
    }
}
