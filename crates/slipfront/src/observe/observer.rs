//! The interface of all observers, and when they are called.

use crate::clock::Clock;
use crate::error::RunError;
use crate::snapshot::Snapshot;

/// An observer, which measures a run.
pub trait Observer {
    /// Reads one instant of the run.
    ///
    /// # Errors
    /// [`RunError::Observer`] ends the run.
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError>;

    /// Whether the observer needs the stored energies after `drive_steps` steps of the drive, when the drive
    /// has just moved. They are measured only at steps at which an observer needs them.
    fn needs_energies(&self, drive_steps: u64) -> bool {
        let _ = drive_steps;
        false
    }
}

/// Steps at which an observer is called.
#[derive(Clone, Debug, PartialEq)]
pub enum Schedule {
    /// At every n-th step from 0, including steps in which a held drive stands still.
    EveryStep(u64),
    /// At every n-th step of the drive from 0.
    Every(u64),
    /// At these steps of the drive, in ascending order.
    At(Vec<u64>),
}

/// An observer and its schedule.
pub struct Scheduled<'a> {
    schedule: Schedule,
    observer: &'a mut dyn Observer,
}

impl<'a> Scheduled<'a> {
    /// An observer that is called according to `schedule`.
    pub fn new(schedule: Schedule, observer: &'a mut dyn Observer) -> Self {
        Self { schedule, observer }
    }

    /// An observer that is called at every step.
    pub fn always(observer: &'a mut dyn Observer) -> Self {
        Self::new(Schedule::EveryStep(1), observer)
    }

    pub(crate) fn due(&self, clock: &Clock) -> bool {
        match &self.schedule {
            Schedule::EveryStep(n) => clock.step.is_multiple_of(*n),
            Schedule::Every(n) => clock.drive_moved() && clock.drive_steps.is_multiple_of(*n),
            Schedule::At(steps) => clock.drive_moved() && steps.binary_search(&clock.drive_steps).is_ok(),
        }
    }

    pub(crate) fn needs_energies(&self, clock: &Clock) -> bool {
        clock.drive_moved() && self.due(clock) && self.observer.needs_energies(clock.drive_steps)
    }

    pub(crate) fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        self.observer.observe(now)
    }
}
