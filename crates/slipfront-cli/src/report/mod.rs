//! Reports of the commands: physics and cost of a case, summary of a run, plan of a design, and plan and
//! results of a study.

mod anisotropy;
pub(crate) mod cost;
pub(crate) mod design;
pub(crate) mod json;
pub(crate) mod lengths;
pub(crate) mod physics;
mod speeds;
pub(crate) mod study;
pub(crate) mod summary;
mod times;
