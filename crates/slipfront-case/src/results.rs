//! [`Record`] -> files, and files -> pictures.
//!
//! Pictures are always drawn from the files, so that those of a run and those of `slipfront plot` are the same.

use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::case::Case;
use crate::case_file::CaseError;
use crate::fields::{self, FieldFrame, FieldName, FieldsError, FieldsFile, StaticFields};
use crate::folder::{self, FolderError, RunFolder};
use crate::legible;
use crate::manifest::Manifest;
use crate::pictures::{self, FrictionCurve, Instant, Kinetic, Picture, PictureError, StressMap, StressMaps};
use crate::run::Record;
use crate::series::{self, SeriesError, SeriesRow};
use crate::summary::Summary;

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
    #[error("{} is not the summary of a slipfront run: {}", path.display(), legible::sentence(&source.to_string()))]
    Summary {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: serde_json::Error,
    },
    /// A picture.
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
    folder.write("summary.json", &folder::json(&record.summary))?;
    let rows = record.rows.iter().map(|row| SeriesRow::new(row, &case.scales));
    folder.write("series.csv", &series::to_csv(rows)?)?;
    let fields = folder.claim("fields.nc")?;
    write_fields(case, record, &fields)?;
    for (name, picture) in draw(folder.path())? {
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
            FieldName::ContactStressStar if contact_stress_max > 0.0 => 1.0 / contact_stress_max,
            FieldName::ContactStressStar | FieldName::Sliding => 1.0,
            FieldName::Traction => case.scales.stress(),
            FieldName::DisplacementX | FieldName::DisplacementY => case.scales.displacement(),
            FieldName::VelocityX | FieldName::VelocityY => case.scales.speed(),
        };
        for value in values {
            *value = (f64::from(*value) * unit) as f32;
        }
    }
    fields
}

/// The files that pictures are drawn from.
pub const DRAWN_FROM: [&str; 3] = ["summary.json", "series.csv", "fields.nc"];

/// Draws the pictures of a run folder from its files.
///
/// # Errors
/// When a file is missing or damaged.
pub fn draw(folder: &Path) -> Result<Vec<(&'static str, Picture)>, ResultsError> {
    let (friction, stress) = rayon::join(|| draw_friction(&[folder.to_owned()]), || draw_stress(folder));
    let mut drawn = vec![("friction", friction?)];
    drawn.extend(stress?.map(|picture| ("stress", picture)));
    Ok(drawn)
}

/// Draws the friction curves of several run folders over each other.
///
/// # Errors
/// When a file is missing or damaged.
pub fn draw_friction(folders: &[PathBuf]) -> Result<Picture, ResultsError> {
    let curves = folders
        .iter()
        .map(|folder| friction_curve(folder))
        .collect::<Result<Vec<_>, _>>()?;
    pictures::friction(&curves).map_err(|source| ResultsError::Picture {
        name: "friction",
        source,
    })
}

fn friction_curve(folder: &Path) -> Result<FrictionCurve, ResultsError> {
    let summary = read_summary(folder)?;
    let rows = series::read_csv(&folder.join("series.csv"))?;
    Ok(FrictionCurve {
        time_star: rows.iter().map(|row| row.time_star).collect(),
        mu_star: rows.iter().map(|row| row.mu_star).collect(),
        sliding_percent: rows.iter().map(|row| row.sliding_percent).collect(),
        ..marked_curve(folder.display().to_string(), &summary)
    })
}

/// All that a summary knows of a curve, without its points.
pub(crate) fn marked_curve(label: String, summary: &Summary) -> FrictionCurve {
    let kinetic = summary.kinetic_window_star.zip(summary.kinetic_friction_star);
    let peak = (summary.onset_time_star, summary.static_friction_star);
    let instants = summary.instants.iter().map(|instant| Instant {
        letter: instant.instant,
        time_star: instant.time_star,
        mu_star: instant.mu_star,
    });
    FrictionCurve {
        label,
        first_slip_time_star: summary.first_slip_time_star,
        peak: summary.transition.then_some(peak),
        kinetic: kinetic.map(|([from, to], mean)| Kinetic {
            from,
            to,
            mean,
            uncertainty: summary.kinetic_friction_star_uncertainty,
        }),
        instants: instants.collect(),
        ..FrictionCurve::default()
    }
}
/// Reads `summary.json` of a run folder.
///
/// # Errors
/// When it is missing or no summary.
pub fn read_summary(run: &Path) -> Result<Summary, ResultsError> {
    let path = run.join("summary.json");
    let bytes = folder::read_whole(&path, folder::TEXT_MAX_BYTES).map_err(|source| FolderError::Read {
        path: path.clone(),
        source,
    })?;
    serde_json::from_slice(&bytes).map_err(|source| ResultsError::Summary { path, source })
}

/// Most maps in the picture of the stress: of more snapshots, six spread over the run are shown.
pub(crate) const MOST_MAPS: usize = 6;

/// Draws the stress maps of a run; none if it kept no contact stress.
fn draw_stress(folder: &Path) -> Result<Option<Picture>, ResultsError> {
    let fields = fields::read_maps(&folder.join("fields.nc"), FieldName::ContactStressStar, MOST_MAPS)?;
    if fields.names.is_empty() || fields.frames.is_empty() {
        return Ok(None);
    }
    let rows = series::read_csv(&folder.join("series.csv"))?;
    let instants = read_summary(folder)?.instants;
    // A snapshot between the rows of a thinned series has no mu* of its own, unless it is an instant.
    let mu_star = |frame: &FieldFrame| {
        let instant = instants
            .iter()
            .find(|instant| instant.time_star == frame.time_star);
        let row = || {
            rows.iter()
                .find(|row| row.step == frame.step)
                .map(|row| row.mu_star)
        };
        instant
            .map(|instant| instant.mu_star)
            .or_else(row)
            .unwrap_or(f64::NAN)
    };
    let (nx, ny) = (fields.columns(), fields.rows());
    let maps = fields
        .frames
        .into_iter()
        .map(|frame| StressMap {
            mu_star: mu_star(&frame),
            label: frame.label,
            time_star: frame.time_star,
            values: frame.values.into_iter().next().unwrap_or_default(),
        })
        .collect();
    let maps = StressMaps {
        nx,
        ny,
        block_size: fields.block_size * fields.stride as f64,
        textured: fields.textured,
        maps,
    };
    let picture = pictures::stress(&maps).map_err(|source| ResultsError::Picture {
        name: "stress",
        source,
    })?;
    Ok(Some(picture))
}

/// The summary as it stands in `summary.json`.
pub fn summary_json(summary: &Summary) -> String {
    String::from_utf8_lossy(&folder::json(summary)).into_owned()
}
