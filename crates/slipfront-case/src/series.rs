//! `series.csv`: the curve of a run, one row per recorded step, names with units in the header.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use slipfront::Scales;
use slipfront::observe::CurveRow;
use thiserror::Error;

use crate::folder::open_regular;
use crate::legible;

/// One row of `series.csv`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SeriesRow {
    /// Step.
    pub step: u64,
    /// t*.
    pub time_star: f64,
    /// Time, s.
    pub time_s: f64,
    /// mu* (Eq. 9 over mu_s).
    pub mu_star: f64,
    /// mu (Eq. 9).
    pub friction_coefficient: f64,
    /// The component of mu* across the drive.
    pub mu_lateral_star: f64,
    /// N*, %.
    pub sliding_percent: f64,
    /// Work of the drive since the start, J.
    pub work_j: f64,
    /// Kinetic energy, J.
    pub kinetic_energy_j: f64,
    /// Energy of the springs between blocks, J.
    pub lattice_energy_j: f64,
    /// Energy of the drive springs, J.
    pub drive_spring_energy_j: f64,
    /// Lost to friction since the start, J.
    pub friction_loss_j: f64,
    /// Lost to damping since the start, J.
    pub damping_loss_j: f64,
}

/// A series that cannot be read.
#[derive(Debug, Error)]
#[error("cannot read {}: {}; it should be the series.csv of a slipfront run", path.display(), legible::sentence(&source.to_string()))]
pub struct SeriesError {
    path: PathBuf,
    source: csv::Error,
}

impl SeriesRow {
    /// A recorded row with its units.
    pub fn new(row: &CurveRow, scales: &Scales) -> Self {
        let energy = scales.energy();
        Self {
            step: row.step,
            time_star: row.time_star,
            time_s: row.time_star * scales.time(),
            mu_star: row.point.mu_star,
            friction_coefficient: row.point.mu_star * scales.mu_static_mean,
            mu_lateral_star: row.point.mu_lateral_star,
            sliding_percent: row.point.sliding_percent,
            work_j: row.energies.work * energy,
            kinetic_energy_j: row.energies.kinetic * energy,
            lattice_energy_j: row.energies.lattice * energy,
            drive_spring_energy_j: row.energies.drive_springs * energy,
            friction_loss_j: row.energies.friction_loss * energy,
            damping_loss_j: row.energies.damping_loss * energy,
        }
    }
}

/// The rows as CSV. Numbers are the shortest that read back as the same bits.
pub fn to_csv(rows: impl Iterator<Item = SeriesRow>) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row)?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

/// Reads a series back.
///
/// # Errors
/// When the file is missing or is no series.
pub fn read_csv(path: &Path) -> Result<Vec<SeriesRow>, SeriesError> {
    let read = || -> Result<_, csv::Error> {
        let file = open_regular(path)?;
        csv::Reader::from_reader(file).deserialize().collect()
    };
    read().map_err(|source| SeriesError {
        path: path.to_owned(),
        source,
    })
}
