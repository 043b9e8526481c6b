//! Results of a study, written to its folder: tables, pictures, and the comparison of its meshes if there is
//! one.

use std::sync::atomic::AtomicBool;

use crate::converge;
use crate::error::StudyError;
use crate::folder::{StudyFolder, stage};
use crate::plan::Plan;
use crate::project_folder::Others;
use crate::study_results::StudyResults;

/// Writes the tables and pictures of a study to its folder, and removes those of earlier results. If the
/// folder has a comparison of meshes, it is written again, too.
///
/// # Errors
/// When the system refuses to write, when a file in its place was edited, and after a stop.
pub fn write(
    plan: &Plan,
    results: &StudyResults,
    folder: &StudyFolder,
    stop: &AtomicBool,
) -> Result<(), StudyError> {
    let mut batch = folder.files.begin();
    stage(plan, results, &mut batch, stop)?;
    if converge::is_written(folder.path(), &plan.axes) && results.expect_no_failures(plan).is_ok() {
        converge::stage(plan, results, &mut batch)?;
    }
    batch.place(Others::Go, vec![folder.records.listed()?])
}
