//! Reports of the commands: physics and cost of a case, summary of a run, plan of a design, and plan and
//! results of a study.

mod anisotropy;
mod cost;
mod design;
mod json;
mod lengths;
mod physics;
mod speeds;
mod study;
mod summary;
mod times;

pub(crate) use cost::cost;
pub(crate) use design::design;
pub(crate) use json::{check, text_of};
pub(crate) use lengths::lengths;
pub use physics::physics;
pub(crate) use physics::{smallest, texture};
pub(crate) use study::{plan, study};
pub(crate) use summary::summary;
