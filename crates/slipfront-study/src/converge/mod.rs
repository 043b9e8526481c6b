//! The mesh error of a result: one slider on blocks of twice, once and half the size, and so on, as a study
//! with the size of the blocks as its only axis.
//!
//! For values `q_1, q_2, q_3` on three meshes, each with blocks of half the size of the one before, with
//! `d = q_2 - q_1` and `e = q_3 - q_2`:
//!
//! ```text
//! order p = log2(|d|/|e|), at least 1/2 and at most 2;  error of the mesh = max(|e|, max(|e|, |d|/4)/(2^p - 1))
//! ```
//!
//! A last difference that is smaller than for second-order convergence is due to chance in the meshed
//! outlines, and `|d|/4` replaces it. If the differences do not decrease, `|e| >= |d|`, no limit is given.

mod mesh_study;
pub(crate) mod on_meshes;
mod text;

use std::io::Write as _;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use slipfront_base::text::COLUMNS;
use slipfront_run::names::CONVERGENCE;

pub use mesh_study::{MAX_LEVELS, MeshStudy};
pub use on_meshes::{Convergence, MIN_LEVELS, Mesh, MeshVerdict, OnMeshes};
pub use text::text;

use self::on_meshes::is_over_meshes;
use crate::axis::Axis;
use crate::error::StudyError;
use crate::folder::{self, StudyFolder};
use crate::plan::Plan;
use crate::project_folder::{Batch, Others};
use crate::study_results::StudyResults;

/// Whether the folder of a study with these axes holds the results of its meshes.
pub fn is_written(folder: &Path, axes: &[Axis]) -> bool {
    is_over_meshes(axes) && CONVERGENCE.iter().any(|name| folder.join(name).exists())
}

/// Writes the tables and pictures of a study over meshes and the comparison of the meshes to its folder.
///
/// # Errors
/// When a run failed (the tables name it), or when the system refuses to write.
pub fn write(
    plan: &Plan,
    results: &StudyResults,
    folder: &StudyFolder,
    stop: &AtomicBool,
) -> Result<OnMeshes, StudyError> {
    let mut batch = folder.files.begin();
    folder::stage(plan, results, &mut batch, stop)?;
    if let Err(failure) = results.expect_no_failures(plan) {
        batch.place(Others::Go, vec![folder.records.listed()?])?;
        return Err(failure);
    }
    let found = stage(plan, results, &mut batch)?;
    batch.place(Others::Go, vec![folder.records.listed()?])?;
    Ok(found)
}

/// Writes the comparison of the meshes to a batch of files: as `convergence.json`, and as text for a reader.
pub(crate) fn stage(plan: &Plan, results: &StudyResults, batch: &mut Batch) -> Result<OnMeshes, StudyError> {
    let [numbers, words] = CONVERGENCE;
    let found = OnMeshes::new(plan, results)?;
    let text = text(plan, &found, COLUMNS);
    batch.write(numbers, |file| Ok(serde_json::to_writer_pretty(file, &found)?))?;
    batch.write(words, |file| file.write_all(text.as_bytes()))?;
    Ok(found)
}
