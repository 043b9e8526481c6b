//! [`Record`] -> files, and files -> pictures.
//!
//! Pictures are always drawn from the files, so that those of a run and those of `slipfront plot` are the same.

use std::path::{Path, PathBuf};

use slipfront_case::disk;
use thiserror::Error;

use crate::fields;
use crate::fields::{FieldFrame, FieldsError, FieldsFile, StaticFields};
use crate::manifest::Manifest;
use crate::run_folder::RunFolder;
use crate::run_folder::error::FolderError;
use crate::running::Record;
use crate::series;
use crate::series::{SeriesError, SeriesRow};
use crate::summary::Summary;
use slipfront::observe::Field;
use slipfront_case::case::Case;
use slipfront_case::case_file::CaseError;
use slipfront_case::text;
#[cfg(feature = "plot")]
use slipfront_plot::PictureError;

/// What can go wrong with results.
#[derive(Debug, Error)]
pub enum ResultsError {
    /// The folder.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// `case.toml`.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// `fields.nc`.
    #[error(transparent)]
    Fields(#[from] FieldsError),
    /// `series.csv`.
    #[error(transparent)]
    Series(#[from] SeriesError),
    /// The series could not be put into words.
    #[error("cannot write series.csv: {0}")]
    Csv(#[from] csv::Error),
    /// `summary.json`.
    #[error("{} is not the summary of a slipfront run: {}", path.display(), text::single_line(&source.to_string()))]
    Summary {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: serde_json::Error,
    },
    /// A picture.
    #[cfg(feature = "plot")]
    #[error("cannot draw {name}: {source}")]
    Picture {
        /// Which one.
        name: &'static str,
        /// What is wrong with it.
        source: PictureError,
    },
}

/// Writes the results of a run, whose case stands in the folder already, and draws its pictures; the manifest completes
/// the folder. The fields are taken out of the record: drawing needs the room that they took.
///
/// # Errors
/// When a file cannot be written: the folder is then left without a manifest.
pub fn write(
    case: &Case,
    record: &mut Record,
    mut folder: RunFolder,
    started: jiff::Timestamp,
    threads: usize,
) -> Result<Manifest, ResultsError> {
    folder.write("summary.json", &disk::json(&record.summary))?;
    let rows = record.rows.iter().map(|row| SeriesRow::new(row, &case.scales));
    folder.write("series.csv", &series::to_csv(rows)?)?;
    let fields = folder.claim("fields.nc")?;
    write_fields(case, record, &fields)?;
    #[cfg(feature = "plot")]
    for (name, picture) in crate::pictures::draw(folder.path())? {
        folder.write(&format!("{name}.svg"), picture.svg.as_bytes())?;
        folder.write(&format!("{name}.png"), &picture.png)?;
    }
    Ok(folder.complete(started, threads, &case.model, case.file.friction.seed)?)
}

/// Writes the case and copies of the files that it reads: enough to run it again.
///
/// # Errors
/// When a file cannot be written.
pub fn write_case(case: &Case, folder: &mut RunFolder) -> Result<(), ResultsError> {
    folder.write("case.toml", case.file.to_toml()?.as_bytes())?;
    for input in &case.inputs {
        folder.write(&input.name, &input.bytes)?;
    }
    Ok(folder.sync()?)
}

fn write_fields(case: &Case, record: &mut Record, path: &Path) -> Result<(), FieldsError> {
    let surface = &case.model.surface;
    let names = &case.output.fields;
    let frames: Vec<FieldFrame> = std::mem::take(&mut record.frames)
        .into_iter()
        .map(|(label, frame)| FieldFrame {
            time_star: frame.time_star,
            label,
            step: frame.step,
            values: dimensional(case, record.contact_stress_max, frame.values),
        })
        .collect();
    fields::write_fields(
        path,
        &FieldsFile {
            nx: case.model.lattice.nx,
            ny: case.model.lattice.ny,
            stride: case.output.stride,
            block_size: case.scales.block_size,
            time_unit_s: case.scales.time(),
            names,
            statics: StaticFields {
                textured: &surface.textured,
                mu_static: &surface.mu_static,
                mu_kinetic: &surface.mu_kinetic,
                first_slip_time_star: &record.first_slip_time_star,
            },
            frames: &frames,
        },
    )
}

/// Values of a frame in the units of the fields file.
fn dimensional(case: &Case, contact_stress_max: f64, mut fields: Vec<Vec<f32>>) -> Vec<Vec<f32>> {
    for (field, values) in case.output.fields.iter().zip(&mut fields) {
        let unit = match field {
            // A run in which nothing was ever pulled has no largest stress to divide by.
            Field::ContactStress if contact_stress_max > 0.0 => 1.0 / contact_stress_max,
            Field::ContactStress | Field::Sliding => 1.0,
            Field::Traction => case.scales.stress(),
            Field::DisplacementX | Field::DisplacementY => case.scales.displacement(),
            Field::VelocityX | Field::VelocityY => case.scales.speed(),
        };
        for value in values {
            *value = (f64::from(*value) * unit) as f32;
        }
    }
    fields
}

/// The files that pictures are drawn from.
pub const DRAWN_FROM: [&str; 3] = ["summary.json", "series.csv", "fields.nc"];

/// Reads `summary.json` of a run folder.
///
/// # Errors
/// When it is missing or no summary.
pub fn read_summary(run: &Path) -> Result<Summary, ResultsError> {
    let path = run.join("summary.json");
    let bytes = disk::read_limited(&path, disk::TEXT_MAX_BYTES).map_err(|source| FolderError::Read {
        path: path.clone(),
        source,
    })?;
    serde_json::from_slice(&bytes).map_err(|source| ResultsError::Summary { path, source })
}

/// The summary as it stands in `summary.json`.
pub fn summary_json(summary: &Summary) -> String {
    String::from_utf8_lossy(&disk::json(summary)).into_owned()
}
