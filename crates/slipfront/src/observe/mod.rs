//! Measurements on a run. Observers read [`Snapshot`](crate::Snapshot)s and change nothing.
//!
//! [`curve`]: mu*, N* and energies against time; [`kinetic_friction`]: its coefficient; [`frames`]:
//! fields at chosen steps; [`instants`]: fields at the instants A-F; [`energy`]: the energy balance;
//! [`events`]: slip events, each with its position and size; [`precursors`]: how far the slip events of a
//! slider driven at an edge reach; [`Largest`]: the largest mu* until the drive has moved by a given path;
//! [`cycles`]: peaks under a program of speeds; [`kymograph`]: sliding against position and time. [`front`]
//! is computed after a run from its first slips: where slip began, and how fast it spread.

pub mod curve;
pub mod cycles;
pub mod energy;
pub mod events;
pub mod frames;
pub mod front;
pub mod instants;
pub mod kinetic_friction;
pub mod kymograph;
mod largest;
pub(crate) mod observer;
pub mod precursors;

pub use crate::kernel::block::Field;
pub use crate::measure::{CurvePoint, Largest, Peak};
pub use curve::{Curve, CurveRow};
pub use cycles::{Cycle, Cycles};
pub use energy::{Energies, Ledger};
pub use events::{Event, Events};
pub use frames::{Frame, Frames};
pub use front::{Front, Quantiles};
pub use instants::Instants;
pub use kinetic_friction::{Kinetic, KineticHistory, KineticStart, NoUncertainty};
pub use kymograph::Kymograph;
pub use observer::{Observer, Schedule, Scheduled};
pub use precursors::{Precursors, SlipEvent};
