//! Pictures of a run, drawn from its files, so that those of a run and those of `slipfront plot` are equal.

use std::path::{Path, PathBuf};

use slipfront::observe::Field;
use slipfront_case::case::MAX_MAPS;
use slipfront_plot::{self as plot, FrictionCurve, Instant, Kinetic, Picture, StressMap, StressMaps};

use crate::error::ResultsError;
use crate::fields::{self, FieldFrame};
use crate::names::{FIELDS, SERIES, SUMMARY};
use crate::series;
use crate::summary::{Summary, read_summary};

/// The files that pictures are drawn from.
pub const DRAWN_FROM: [&str; 3] = [SUMMARY, SERIES, FIELDS];

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
    plot::friction(&curves).map_err(|source| ResultsError::Picture {
        name: "friction",
        source,
    })
}

fn friction_curve(folder: &Path) -> Result<FrictionCurve, ResultsError> {
    let summary = read_summary(folder)?;
    let rows = series::read_csv(&folder.join(SERIES))?;
    Ok(FrictionCurve {
        time_star: rows.iter().map(|row| row.time_star).collect(),
        mu_star: rows.iter().map(|row| row.mu_star).collect(),
        sliding_percent: rows.iter().map(|row| row.sliding_percent).collect(),
        ..marked_curve(folder.display().to_string(), &summary)
    })
}

/// All that a summary knows of a curve, without its points.
pub fn marked_curve(label: String, summary: &Summary) -> FrictionCurve {
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

/// Draws the stress maps of a run; none if it kept no contact stress.
fn draw_stress(folder: &Path) -> Result<Option<Picture>, ResultsError> {
    let fields = fields::read_maps(&folder.join(FIELDS), Field::ContactStress, MAX_MAPS)?;
    if fields.names.is_empty() || fields.frames.is_empty() {
        return Ok(None);
    }
    let rows = series::read_csv(&folder.join(SERIES))?;
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
    let picture = plot::stress(&maps).map_err(|source| ResultsError::Picture {
        name: "stress",
        source,
    })?;
    Ok(Some(picture))
}
