//! A computation of static friction over several seeds, distributed over tasks.

use std::vec;

use crate::event::EventKind;
use crate::host::Task;
use crate::repeat::SeedsFound;

/// A computation of static friction over several seeds. Dropping it ends its jobs.
pub(crate) struct Repetition {
    pub(crate) parts: Vec<Part>,
    pub(crate) found: SeedsFound,
}

/// The seeds that one task computes.
pub(crate) struct Part {
    pub(crate) task: Box<dyn Task>,
    /// Seeds that the task has not reported yet, in order.
    pub(crate) seeds: vec::IntoIter<u64>,
}

impl Part {
    /// Passes on the results that the task has reported since the last call; returns whether more will come.
    pub(crate) fn follow(&mut self, found: &mut SeedsFound) -> bool {
        while let Some(seed) = self.seeds.as_slice().first().copied()
            && let Some(event) = self.task.next_event()
        {
            let outcome = match event.0 {
                EventKind::Repeated(outcome) => outcome,
                _ => Err("the runs over seeds failed by a defect of their own".to_owned()),
            };
            let goes_on = outcome.is_ok();
            found.note(seed, outcome);
            self.seeds.next();
            if !goes_on {
                return false;
            }
        }
        self.seeds.len() > 0
    }
}
