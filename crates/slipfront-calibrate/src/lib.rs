//! Calibration: unknown keys of a case from measured records, with intervals that hold what they promise.
//!
//! ```text
//! CalibrationFile, records -> SetUp -> Training (curves of runs over the ranges) -> Calibration (regressions on their features) -> Estimate
//! ```
//!
//! Least squares on the curve fails for stick-slip, since its phases are random. Here, every curve is reduced
//! to `features`, `regression` predicts every unknown from them, and the intervals of its `distribution`
//! contain the true value with the stated probability for runs that the prediction has not used.

mod calibration;
mod clipping;
mod closest;
mod design_point;
mod distribution;
mod doubts;
mod features;
mod file;
mod findings;
mod fit;
mod folder;
mod in_memory;
mod misfit;
#[cfg(not(target_family = "wasm"))]
mod on_device;
mod plan;
mod predicted;
mod progress;
mod record_check;
mod record_noise;
mod report;
mod runs;
mod sample_points;
mod scaling;
mod set_up;
mod synthetic_noise;
mod training;

pub use calibration::{Calibration, Estimate, Pair};
pub use clipping::Clipped;
pub use closest::{Closest, closest};
pub use design_point::design_point;
pub use distribution::Distribution;
pub use file::{CalibrationFile, CalibrationKeys, SampledRecord};
pub use folder::{CALIBRATIONS, CalibrationFolder};
pub use in_memory::{CalibrationInMemory, CalibrationResults, Outcome};
pub use misfit::Misfit;
pub use plan::{ExperimentPlan, PlannedExperiment};
pub use predicted::{Comparison, Predicted};
pub use progress::{CalibrationProgress, CalibrationStage};
pub use record_check::RecordCheck;
pub use record_noise::noise_share;
pub use runs::{RunMaker, WantedRun};
pub use sample_points::SamplePoints;
pub use set_up::{Conditions, Curves, SetUp};
pub use training::Training;
