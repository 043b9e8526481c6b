//! Calibration: unknown keys of a case from measured records, with intervals that hold what they promise.
//!
//! ```text
//! SetUp -> Training (curves of runs over the ranges) -> Calibration (what their summaries tell) -> Fit (of records)
//! ```
//!
//! Least squares on the curve fails where friction sticks and slips, since the phases of that are chance. Here every curve becomes
//! [`summaries`], every unknown is [predicted](regression) from them, and [intervals] are those that hold the truth for runs that the
//! prediction has not seen.

mod dense;
mod fit;
mod grid;
mod intervals;
mod misfit;
mod normals;
mod regression;
mod summaries;
mod training;
mod unknowns;

pub use fit::{Calibration, Fit, Pair};
pub use grid::Grid;
pub use intervals::Distribution;
pub use misfit::Misfit;
pub use training::{Conditions, SetUp, Training, TrainingError};
pub use unknowns::{Unknown, UnknownError, design_point};
