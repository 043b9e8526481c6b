//! Memory and disk space of the pictures of a run.

use std::path::PathBuf;

use slipfront_case::case::{Budget, Case, MAX_MAPS, mapped_field};
use slipfront_plot::{CellMeans, FRICTION_BYTES, MovieSize, STRESS_BYTES, STRESS_FILE_BYTES, front_bytes};

use super::error::RunPictureError;
use super::files::found;
use super::friction::ROW_BYTES;
use super::maps::{CELL_BYTES, MAP_CELL_BYTES};
use super::movie;
use crate::budget::{PictureBytes, RunBudget};
use crate::names::{KYMOGRAPH, SERIES};
use crate::{fields, series};

/// Bytes while the pictures of the friction and of the stress are drawn at once.
const WITH_MAPS_BYTES: f64 = (FRICTION_BYTES + STRESS_BYTES) as f64;

/// The budget of a run of a case, for the rows that this process holds, with its pictures.
pub fn run_budget(case: &Case) -> RunBudget {
    let (lattice, output) = (&case.model.lattice, &case.output);
    let mut budget = RunBudget::without_pictures(case);
    let cells = budget.all_cells.min(CellMeans::MAX_CELLS as f64);
    let maps = if output.fields.contains(&mapped_field(&case.file)) {
        budget.frames.min(MAX_MAPS as f64)
    } else {
        0.0
    };
    let frames = if output.movie { budget.frames } else { 0.0 };
    let with_maps = if maps > 0.0 { WITH_MAPS_BYTES } else { 0.0 };
    budget.pictures = PictureBytes {
        cells: cells * CELL_BYTES,
        // One after the other.
        snapshots: (maps * cells * MAP_CELL_BYTES)
            .max(frames * movie::snapshot_bytes(cells, MovieSize::Usual)),
        row: ROW_BYTES,
        two: (front_bytes(lattice.nx, lattice.ny) as f64).max(with_maps),
        batch: if frames > 0.0 {
            movie::batch_bytes(MovieSize::Usual)
        } else {
            0.0
        },
        files: maps * cells * STRESS_FILE_BYTES as f64 + frames * MovieSize::Usual.file_bytes() as f64,
    };
    budget
}

/// Memory in which the friction curves of these run folders are drawn, or all pictures of a single one, in bytes.
pub fn memory(folders: &[PathBuf]) -> Result<f64, RunPictureError> {
    let (mut rows, mut kymograph) = (0.0, 0);
    for folder in folders {
        rows += series::estimate_rows(&folder.join(SERIES))?;
        kymograph = found(&folder.join(KYMOGRAPH))?
            .map_or(0, |file| file.len())
            .max(kymograph);
    }
    let shares = kymograph as f64 / fields::SHARE_BYTES as f64;
    let maps = CellMeans::MAX_CELLS as f64 * (CELL_BYTES + MAX_MAPS as f64 * MAP_CELL_BYTES);
    Ok(Budget::resident(
        maps + Budget::grown(rows) * ROW_BYTES
            + shares * fields::WORKING_SHARE_BYTES as f64
            + WITH_MAPS_BYTES,
    ))
}
