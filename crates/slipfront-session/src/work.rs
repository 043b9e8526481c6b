//! Work beside a session: what is to be done, wherever its host has it done.

use serde::{Deserialize, Serialize};

use crate::document::Document;
use crate::event::{Event, EventKind, Mask, Worker};
use crate::repeat::repeat;
use crate::search;

/// Work beside a session. It tells what it finds by [`Event`]s, and can be sent as JSON.
#[derive(Debug, Serialize, Deserialize)]
pub struct Work {
    document: Document,
    kind: WorkKind,
}

#[derive(Debug, Serialize, Deserialize)]
enum WorkKind {
    /// A computation of static friction with each of these seeds.
    Repeat(Vec<u64>),
    /// A search for a texture with less static friction than the painted one.
    Search,
    /// A comparison of the best texture of a search with the painted one.
    Compare(Mask),
}

impl Work {
    /// Finds static friction of a case with each of these seeds, in their order.
    pub(crate) fn repeat(document: Document, seeds: Vec<u64>) -> Self {
        let kind = WorkKind::Repeat(seeds);
        Self { document, kind }
    }

    /// Searches for a texture with less static friction than that of a case.
    pub(crate) fn search(document: Document) -> Self {
        let kind = WorkKind::Search;
        Self { document, kind }
    }

    /// Compares a texture with that of a case, on surfaces that a search has not seen.
    pub(crate) fn compare(document: Document, best: Mask) -> Self {
        let kind = WorkKind::Compare(best);
        Self { document, kind }
    }

    /// Does the work, until it is done or the worker is to stop.
    pub fn run(&self, worker: &dyn Worker) {
        let document = &self.document;
        match &self.kind {
            WorkKind::Repeat(seeds) => repeat(document, seeds, worker),
            WorkKind::Search => {
                let searched = search::search(document, worker);
                worker.tell(Event(EventKind::Searched(searched)));
            }
            WorkKind::Compare(best) => {
                let compared = search::compare(document, best, worker.stop());
                worker.tell(Event(EventKind::Compared(compared)));
            }
        }
    }
}
