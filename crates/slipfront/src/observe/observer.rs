//! The interface of all observers, and when they are called.

use crate::error::RunError;
use crate::snapshot::Snapshot;

/// Something that measures a run.
pub trait Observer {
    /// Looks at one instant.
    ///
    /// # Errors
    /// [`RunError::Observer`] ends the run.
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError>;

    /// Whether it needs the stored energies at `step`. They are measured only at steps at which an observer needs them.
    fn needs_energies(&self, step: u64) -> bool {
        let _ = step;
        false
    }
}

/// At which steps an observer is called.
#[derive(Clone, Debug, PartialEq)]
pub enum Schedule {
    /// At every n-th step from 0.
    Every(u64),
    /// At these steps, in rising order.
    At(Vec<u64>),
}

/// An observer and its schedule.
pub struct Scheduled<'a> {
    schedule: Schedule,
    observer: &'a mut dyn Observer,
}

impl<'a> Scheduled<'a> {
    /// Calls `observer` as `schedule` says.
    pub fn new(schedule: Schedule, observer: &'a mut dyn Observer) -> Self {
        Self { schedule, observer }
    }

    /// Calls `observer` at every step.
    pub fn always(observer: &'a mut dyn Observer) -> Self {
        Self::new(Schedule::Every(1), observer)
    }

    pub(crate) fn due(&self, step: u64) -> bool {
        match &self.schedule {
            Schedule::Every(n) => step.is_multiple_of(*n),
            Schedule::At(steps) => steps.binary_search(&step).is_ok(),
        }
    }

    pub(crate) fn needs_energies(&self, step: u64) -> bool {
        self.due(step) && self.observer.needs_energies(step)
    }

    pub(crate) fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        self.observer.observe(now)
    }
}
