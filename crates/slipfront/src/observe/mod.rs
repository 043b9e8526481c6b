//! What is measured on a run. Observers look at [`Snapshot`]s and change nothing.
//!
//! [`curve`] mu* and N* against time, and the first peak; [`summary`] the kinetic level; [`stress`] Eq. 10 and
//! the true traction; [`frames`] fields to keep; [`instants`] A-F; [`fronts`] first slip block by block;
//! [`energy`] the ledger.

pub mod curve;
pub mod energy;
pub mod frames;
pub mod fronts;
pub mod instants;
pub mod stress;
pub mod summary;

pub use curve::{Curve, CurvePoint, CurveRow, Peak};
pub use energy::{Energies, Ledger};
pub use frames::{Field, Frame, Frames};
pub use fronts::FirstSlip;
pub use instants::Instants;
pub use summary::{Kinetic, KineticHistory, KineticStart, NoUncertainty};

use crate::{RunError, Snapshot};

/// Something that watches a run.
pub trait Observer {
    /// Looks at one instant.
    ///
    /// # Errors
    /// [`RunError::Observer`] ends the run.
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError>;

    /// Whether it needs the energies held at `step`, which are not measured unasked.
    fn needs_energies(&self, step: u64) -> bool {
        let _ = step;
        false
    }
}

/// At which steps an observer is called.
#[derive(Clone, Debug, PartialEq)]
pub enum Schedule {
    /// At every step.
    Always,
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

    /// At every step.
    pub fn always(observer: &'a mut dyn Observer) -> Self {
        Self::new(Schedule::Always, observer)
    }

    pub(crate) fn due(&self, step: u64) -> bool {
        match &self.schedule {
            Schedule::Always => true,
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
