//! A computation of static friction over several seeds, shared out to tasks.

use std::vec;

use crate::event::EventKind;
use crate::host::Task;
use crate::repeat::SeedsFound;

/// A computation of static friction over several seeds. Dropping it ends its work.
pub(crate) struct Repetition {
    pub(crate) parts: Vec<Part>,
    pub(crate) found: SeedsFound,
}

/// The part of the seeds that one task goes through.
pub(crate) struct Part {
    pub(crate) task: Box<dyn Task>,
    /// Seeds of which the task has told nothing yet, in its order.
    pub(crate) seeds: vec::IntoIter<u64>,
}

impl Part {
    /// Passes on what the task has told since the last look; gives whether there is more to come.
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
