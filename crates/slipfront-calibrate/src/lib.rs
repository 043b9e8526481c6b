//! Calibration: unknown keys of a case from measured records, with intervals that hold what they promise.
//!
//! ```text
//! CalibrationFile, records -> SetUp -> Training (curves of runs over the ranges) -> Calibration (regressions on their summaries) -> Estimate
//! ```
//!
//! Least squares on the curve fails for stick-slip, since its phases are random. Here, every curve is reduced
//! to `summaries`, `regression` predicts every unknown from them, and `intervals` contain the true value with
//! the stated probability for runs that the prediction has not used.

mod bandwidth;
mod calibration;
mod clipping;
mod closest;
mod design_point;
#[cfg(not(target_family = "wasm"))]
mod device_training;
mod doubts;
mod file;
mod findings;
mod fit;
mod folder;
mod in_memory;
mod intervals;
mod misfit;
mod normals;
mod plan;
mod predicted;
mod progress;
mod record_check;
mod report;
mod runs;
mod sample_points;
mod scaling;
mod set_up;
mod summaries;
mod training;

pub use bandwidth::noise_share;
pub use calibration::{Calibration, Estimate, Pair};
pub use clipping::Clipped;
pub use closest::{Closest, closest};
pub use design_point::design_point;
pub use file::{CalibrationFile, CalibrationKeys, SampledRecord};
pub use folder::{CALIBRATIONS, CalibrationFolder};
pub use in_memory::{CalibrationInMemory, CalibrationResults, Outcome};
pub use intervals::Distribution;
pub use misfit::Misfit;
pub use plan::{ExperimentPlan, PlannedExperiment};
pub use predicted::{Comparison, Predicted};
pub use progress::{CalibrationProgress, CalibrationStage};
pub use record_check::RecordCheck;
pub use runs::{RunMaker, WantedRun};
pub use sample_points::SamplePoints;
pub use set_up::{Conditions, Curves, SetUp};
pub use training::Training;
