//! Studies: a case turned into a designed experiment whose answer is a table and a picture with error bars.
//!
//! ```text
//! text -> StudyFile -> Plan (every point a valid case) -> StudyResults -> tables -> pictures
//! ```
//!
//! Every finished run is one line of a record file; a study that was stopped goes on from there.

use std::collections::HashSet;

use crate::names::TABLES;

mod axis;
mod error;
mod figures;
mod folder;
mod input_copies;
mod journal;
mod plan;
mod scheduler;
mod shard;
pub mod slurm;
mod statistics;
mod study_file;
mod summary_values;
mod tables;

pub use axis::{Axis, Level, Spacing};
pub use error::StudyError;
pub(crate) use error::of_others;
pub use folder::{StudyFolder, is_study, refuse_foreign, study_of};
pub use journal::{Outcome, Record, Records, RunResult};
pub use plan::{Plan, Point, Role, RunKey, Warning};
pub use scheduler::{PointResult, Progress, StudyResults, collect, execute};
pub use shard::Shard;
pub use statistics::Sample;
pub use study_file::{Base, RetainRuns, Settings, StoppingRule, StudyFile};
pub use summary_values::{Quantity, REDUCTION, SummaryValues, known as quantities};
pub use tables::sample;

/// The quantity that a study is mostly about: the one that decides on its replicates, else the reduction if it has a reference,
/// else mu_s*.
pub fn main_quantity(plan: &Plan) -> &str {
    if let Some(until) = &plan.settings.until {
        &until.key
    } else if plan.has_reference() {
        REDUCTION
    } else {
        "static_friction_star"
    }
}

/// Writes tables and pictures of a study to its folder, and removes those of its pictures that it no longer has.
///
/// # Errors
/// When a file cannot be written.
pub fn write(plan: &Plan, results: &StudyResults, folder: &StudyFolder) -> Result<(), StudyError> {
    let [runs, points] = TABLES;
    folder.write(runs, &tables::runs(plan, results)?)?;
    folder.write(points, &tables::points(plan, results)?)?;
    let mut drawn = HashSet::new();
    for (name, picture) in figures::draw(plan, results)? {
        folder.write(&format!("{name}.svg"), picture.svg.as_bytes())?;
        folder.write(&format!("{name}.png"), &picture.png)?;
        drawn.insert(name);
    }
    folder.remove_pictures(figures::names(&plan.axes).filter(|name| !drawn.contains(name)));
    Ok(())
}
