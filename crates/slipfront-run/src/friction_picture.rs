//! The picture of friction curves, on the axes that a user asks for or on which runs of different materials can be compared.

use std::path::{Path, PathBuf};

use slipfront_case::case_file::Motion;
use slipfront_case::number_format::si_prefix;
use slipfront_plot::{self as plot, FrictionAxes, FrictionCurve, Instant, Kinetic, Picture};

use crate::error::ResultsError;
use crate::names::SERIES;
use crate::series::{self, SeriesRow};
use crate::summary::{SiSummary, Summary, read_summary};

/// What the axes count in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Units {
    /// Dimensionless quantities.
    #[default]
    Star,
    /// Newtons, and seconds or metres.
    Si,
}

/// What friction is drawn against.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Against {
    /// Time.
    #[default]
    Time,
    /// The path of the drive.
    Displacement,
}

/// A picture, and a sentence that says on which axes if they are not those that were to be expected.
pub struct Overlay {
    /// The picture.
    pub picture: Picture,
    /// The sentence.
    pub note: Option<String>,
}

/// A run and its curve: t*, path of the drive in units of displacement, mu*, N*.
struct Run {
    folder: PathBuf,
    summary: Summary,
    rows: Vec<[f64; 4]>,
}

/// By what the numbers of a run are multiplied, and the names of the axes.
struct Scale {
    axes: FrictionAxes,
    against: Against,
    /// Of each run: of times or paths, and of friction.
    factors: Vec<[f64; 2]>,
}

/// Draws the friction curves of run folders over each other.
///
/// Without units and abscissa of their own, runs of different materials are drawn where they can be compared: if their mean local
/// coefficients differ, as mu; if their units of time do, against the path of the drive.
///
/// # Errors
/// When a folder cannot be read, or its run has not what is asked for.
pub fn overlay(folders: &[PathBuf], units: Units, against: Option<Against>) -> Result<Overlay, ResultsError> {
    let runs: Result<Vec<Run>, _> = folders.iter().map(|folder| Run::read(folder)).collect();
    let runs = runs?;
    let (scale, note) = match units {
        Units::Si => (in_si(&runs, against.unwrap_or_default())?, None),
        Units::Star => dimensionless(&runs, against)?,
    };
    let curves = runs.iter().zip(&scale.factors);
    let curves: Vec<_> = curves
        .map(|(run, factors)| run.curve(scale.against, *factors))
        .collect();
    let picture = plot::friction(&curves, &scale.axes).map_err(|source| ResultsError::Picture {
        name: "friction",
        source,
    })?;
    Ok(Overlay { picture, note })
}

/// Draws the friction curve of a run folder against t*.
pub(crate) fn of_run(folder: &Path) -> Result<Picture, ResultsError> {
    overlay(&[folder.to_owned()], Units::Star, Some(Against::Time)).map(|overlay| overlay.picture)
}

/// All that a summary knows of a curve of mu* against t*, without its points.
pub fn marked_curve(label: String, summary: &Summary) -> FrictionCurve {
    let kinetic = summary.kinetic_window_star.zip(summary.kinetic_friction_star);
    let peak = (summary.onset_time_star, summary.static_friction_star);
    let instants = summary.instants.iter().map(|instant| Instant {
        letter: instant.instant,
        x: instant.time_star,
        friction: instant.mu_star,
    });
    FrictionCurve {
        label,
        first_slip: summary.first_slip_time_star,
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

impl Run {
    fn read(folder: &Path) -> Result<Self, ResultsError> {
        let summary = read_summary(folder)?;
        let unit = summary.si.as_ref().map_or(f64::NAN, |si| si.displacement_unit_m);
        let row = |row: SeriesRow| {
            let path = row.drive_displacement_m.map_or(f64::NAN, |path| path / unit);
            [row.time_star, path, row.mu_star, row.sliding_percent]
        };
        Ok(Self {
            rows: series::read_rows(&folder.join(SERIES), SERIES, row)?,
            folder: folder.to_owned(),
            summary,
        })
    }

    fn is_rotation(&self) -> bool {
        self.summary.motion == Some(Motion::Rotation)
    }

    /// Its units, which older versions did not write.
    fn si(&self) -> Result<&SiSummary, ResultsError> {
        let found = self.summary.si.as_ref();
        found.ok_or_else(|| ResultsError::NoUnits(self.folder.clone()))
    }

    /// Path of the drive at a time, between two rows of the series in proportion.
    fn path_at(&self, time_star: f64) -> f64 {
        let after = self.rows.partition_point(|row| row[0] < time_star);
        let after = after.min(self.rows.len() - 1);
        let (before, after) = (self.rows[after.saturating_sub(1)], self.rows[after]);
        let span = after[0] - before[0];
        let share = if span > 0.0 {
            (time_star - before[0]) / span
        } else {
            0.0
        };
        before[1] + share * (after[1] - before[1])
    }

    /// The curve with its marks, on axes of these factors.
    fn curve(&self, against: Against, [along, up]: [f64; 2]) -> FrictionCurve {
        let x = |time_star: f64| match against {
            Against::Time => along * time_star,
            Against::Displacement => along * self.path_at(time_star),
        };
        let column = |k: usize, factor: f64| self.rows.iter().map(|row| factor * row[k]).collect();
        let mut curve = FrictionCurve {
            x: column(against as usize, along),
            friction: column(2, up),
            sliding_percent: column(3, 1.0),
            ..marked_curve(self.folder.display().to_string(), &self.summary)
        };
        curve.first_slip = curve.first_slip.map(x);
        curve.peak = curve.peak.map(|(time, mu)| (x(time), up * mu));
        if let Some(window) = &mut curve.kinetic {
            (window.from, window.to) = (x(window.from), x(window.to));
            window.mean *= up;
            window.uncertainty = window.uncertainty.map(|uncertainty| up * uncertainty);
        }
        for instant in &mut curve.instants {
            (instant.x, instant.friction) = (x(instant.x), up * instant.friction);
        }
        curve
    }
}

/// Axes without units, and why they are not mu* against t*.
fn dimensionless(runs: &[Run], asked: Option<Against>) -> Result<(Scale, Option<String>), ResultsError> {
    let units: Vec<Option<&SiSummary>> = runs.iter().map(|run| run.summary.si.as_ref()).collect();
    let differs = |unit: fn(&SiSummary) -> f64| {
        let mut known = units.iter().flatten().map(|si| unit(si));
        let first = known.next();
        known.any(|other| Some(other) != first)
    };
    let mean_static = |si: &SiSummary| si.stress_unit_pa / si.pressure_pa;
    let all_known = units.iter().all(Option::is_some);
    let other_friction = all_known && differs(mean_static);
    let other_time = all_known && asked.is_none() && differs(|si| si.time_unit_s);
    let against = match asked {
        Some(against) => against,
        None if other_time => Against::Displacement,
        None => Against::Time,
    };
    if against == Against::Displacement {
        runs.iter().try_for_each(|run| run.si().map(|_| ()))?;
    }
    let mut axes = FrictionAxes::default();
    if runs.iter().all(Run::is_rotation) {
        axes.friction = "torque \u{3bc}*".to_owned();
    }
    if other_friction {
        axes.friction = "friction \u{3bc}".to_owned();
        (axes.peak, axes.kinetic) = ("\u{3bc}_s".to_owned(), "\u{3bc}_k".to_owned());
    }
    if against == Against::Displacement {
        axes.x = "drive displacement in units of P\u{27e8}\u{3bc}_s\u{27e9}l/E".to_owned();
    }
    let up = |si: &Option<&SiSummary>| si.filter(|_| other_friction).map_or(1.0, mean_static);
    let factors = units.iter().map(|si| [1.0, up(si)]).collect();
    let note = match [other_friction, other_time] {
        [false, false] => None,
        [true, false] => {
            Some("the mean static coefficients of the runs differ: friction is drawn as mu, not as mu*")
        }
        [false, true] => Some(
            "the units of time of the runs differ: friction is drawn against the displacement of the drive in units of P mu_s l/E",
        ),
        [true, true] => Some(
            "the runs have different materials: friction is drawn as mu against the displacement of the drive in units of P mu_s l/E",
        ),
    };
    let scale = Scale {
        axes,
        against,
        factors,
    };
    Ok((scale, note.map(str::to_owned)))
}

/// Axes of newtons and of seconds or metres, with the prefixes that suit the largest numbers.
fn in_si(runs: &[Run], against: Against) -> Result<Scale, ResultsError> {
    let turns = runs.iter().all(Run::is_rotation);
    if let Some(run) = runs.iter().find(|run| run.is_rotation() != turns) {
        return Err(ResultsError::NotComparable(run.folder.clone()));
    }
    let mut factors = Vec::with_capacity(runs.len());
    for run in runs {
        let si = run.si()?;
        let along = match against {
            Against::Time => si.time_unit_s,
            Against::Displacement => si.displacement_unit_m,
        };
        let up = match si.static_torque_n_m {
            Some(torque) => torque / run.summary.static_friction_star,
            None => si.stress_unit_pa * si.area_m2,
        };
        factors.push([along, up]);
    }
    let largest = |column: usize, axis: usize| {
        let sizes = runs.iter().zip(&factors).flat_map(|(run, factors)| {
            let factor = factors[axis];
            run.rows.iter().map(move |row| (factor * row[column]).abs())
        });
        sizes.filter(|size| size.is_finite()).fold(0.0, f64::max)
    };
    let prefixes = [(against as usize, 0), (2, 1)].map(|(column, axis)| si_prefix(largest(column, axis)));
    for factors in &mut factors {
        for (factor, (unit, _)) in factors.iter_mut().zip(prefixes) {
            *factor /= unit;
        }
    }
    let [along, up] = prefixes.map(|(_, prefix)| if prefix == "u" { "\u{b5}" } else { prefix });
    let (quantity, letter, unit) = if turns {
        ("torque", 'M', format!("{up}N m"))
    } else {
        ("friction force", 'F', format!("{up}N"))
    };
    let axes = FrictionAxes {
        x: match against {
            Against::Time => format!("time ({along}s)"),
            Against::Displacement => format!("drive displacement ({along}m)"),
        },
        friction: format!("{quantity} ({unit})"),
        peak: format!("{letter}_s"),
        kinetic: format!("{letter}_k"),
        unit: format!(" {unit}"),
    };
    Ok(Scale {
        axes,
        against,
        factors,
    })
}
