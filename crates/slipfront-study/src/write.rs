//! Results of a study, written to its folder: tables, pictures, and the comparison of its meshes if there is
//! one.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use slipfront_plot::PictureLook;
use slipfront_run::names::RUNS;

use crate::converge;
use crate::error::StudyError;
use crate::execute::collect;
use crate::folder::{StudyFolder, stage, study_of};
use crate::kept_runs::verify_kept;
use crate::plan::Plan;
use crate::project_folder::{Others, Project};
use crate::study_file::STUDIES;
use crate::study_results::StudyResults;

/// Folders of studies.
pub(crate) const STUDY_FOLDERS: Project = Project {
    kind: &STUDIES,
    no_pictures: &[],
    beside: &[RUNS],
    verify_beside: Some(verify_kept),
    find_again: Some(find_again),
};

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
    write_like(folder.path(), plan, results, folder, stop)
}

/// Writes a study to its folder, with the comparison of meshes if `other` has one.
fn write_like(
    other: &Path,
    plan: &Plan,
    results: &StudyResults,
    folder: &StudyFolder,
    stop: &AtomicBool,
) -> Result<(), StudyError> {
    let mut batch = folder.files.begin();
    stage(plan, results, &mut batch, stop)?;
    if converge::is_written(other, &plan.axes) && results.expect_no_failures(plan).is_ok() {
        converge::stage(plan, results, &mut batch)?;
    }
    batch.place(Others::Go, vec![folder.records.listed()?])
}

/// Writes the results of a study to another folder from the runs in its journal.
fn find_again(
    folder: &Path,
    other: &Path,
    look: &PictureLook,
    stop: &AtomicBool,
) -> Result<[usize; 2], StudyError> {
    let file = study_of(folder)?;
    let plan = Plan::new(&file, None)?;
    plan.check_memory(0)?;
    let mut again = StudyFolder::open(other, &file, None, false)?;
    again.files = again.files.with_look(look.clone());
    again.records.merge(folder)?;
    write_like(folder, &plan, &collect(&plan, &again.records)?, &again, stop)?;
    Ok([again.records.len(); 2])
}
