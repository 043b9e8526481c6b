//! Studies: a case is varied along axes and repeated on several random surfaces; the results are tables and
//! pictures with error bars.
//!
//! ```text
//! text -> StudyFile -> Plan (every point a valid case) -> StudyResults -> tables -> pictures
//! ```
//!
//! Every finished run is a line of the journal, from which a stopped study continues.

pub mod adaptive_search;
mod anisotropy;
mod answer;
pub mod axis;
pub mod converge;
pub mod draws;
mod error;
mod estimate_cost;
mod execute;
mod export;
mod finished_run;
mod folder;
mod friction_tensor;
pub mod identity;
mod idle_axes;
mod kept_runs;
mod labels;
mod levels;
pub mod measured_columns;
mod meshed_coverage;
#[cfg(not(target_family = "wasm"))]
mod on_device;
mod picture_plan;
mod pictures;
mod pictures_again;
mod plan;
mod plan_warnings;
pub mod project_file;
pub mod project_folder;
mod run_journal;
mod scheduler;
mod shard;
pub mod slurm;
pub mod statistics;
mod study_file;
mod study_results;
mod summary_values;
mod tables;
pub mod text_table;
pub mod unknown;
pub mod verify;
mod warning_texts;
pub mod work_memory;
mod write;

pub use anisotropy::{Anisotropy, OverDirections, anisotropies};
pub use answer::answer;
pub use axis::{Axis, AxisKeys, Level, Spacing};
pub use error::{NoCurve, StudyError, TrainingError};
pub use estimate_cost::{CostLimits, estimated_time};
pub use execute::{LookAtRun, collect, execute, execute_and_look};
pub use export::exported;
pub use finished_run::{FinishedRun, Outcome, RunResult};
pub use folder::{PAPER, StudyFolder, is_of_figures, is_study, refuse_foreign, study_of};
pub use friction_tensor::Principal;
pub use identity::SOURCE_HASH;
pub use idle_axes::idle_axes;
pub use labels::{AxisLabels, axis_labels, title};
pub use meshed_coverage::MeshedCoverage;
#[cfg(not(target_family = "wasm"))]
pub use on_device::execute_on_device;
pub use picture_plan::{quantities_without_pictures, why_no_pictures};
pub use pictures_again::{PicturesOf, pictures_of};
pub use plan::{Plan, Point, Role, RunKey};
pub use plan_warnings::{Warning, note_on_seeds};
pub use project_file::Base;
pub use run_journal::RunJournal;
pub use shard::Shard;
pub use statistics::Sample;
pub use study_file::{CONFIDENCE, RetainRuns, Settings, StoppingRule, StudyFile};
pub use study_results::{PointResult, Progress, StudyResults};
pub use summary_values::{REDUCTION, RunQuantity, SummaryValues, is_column, known as quantities};
pub use unknown::{Unknown, UnknownError};
pub use warning_texts::warning_texts;
pub use write::write;
