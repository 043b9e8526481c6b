//! The picture of friction curves, on the axes that a user requests or on axes that allow comparing runs of
//! different materials.

use std::path::PathBuf;

use slipfront_base::number_format::{in_print, si_prefix, with_si_prefix};
use slipfront_case::case_file::Motion;
use slipfront_plot::{self as plot, FrictionAxes, FrictionCurve, Instant, KineticLine, Picture, PictureSize};

use super::error::{RecordError, RunPictureError, drawn};
pub use super::record_fit::Misfit;
use super::record_fit::{Points, ends, fitting_shifts, misfit, rival};
use crate::instrument::Instrument;
use crate::measured::{Measure, MeasuredRecord};
use crate::names::{SERIES, SUMMARY};
use crate::run_files::RunFiles;
use crate::series::{self, SeriesRow};
use crate::summary::{SiSummary, Summary, summary_of};

/// Units of the axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AxisUnits {
    /// Dimensionless quantities.
    #[default]
    Star,
    /// Newtons, and seconds or metres.
    Si,
}

/// Abscissa of a friction curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Against {
    /// Time.
    #[default]
    Time,
    /// The path of the drive.
    Displacement,
}

/// A measured record that is laid over curves in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct OverlaidRecord {
    /// Name of the record in the legend.
    pub label: String,
    /// The record: times or displacements, with forces or coefficients.
    pub record: MeasuredRecord,
    /// Shift of the record's times or displacements, in SI units; if none is given, the shift with which it
    /// fits the first run best.
    pub shift: Option<f64>,
    /// The instrument that wrote the record, if the curves are to be drawn as this instrument would write
    /// them.
    pub instrument: Option<Instrument>,
}

/// Fit of a measured record to runs, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// Abscissa of the record, and its quantity.
    pub measures: [Measure; 2],
    /// Shift of the record's times or displacements.
    pub shift: f64,
    /// Number of points of the record.
    pub points: usize,
    /// Distance between the record and each run; none for a run that overlaps the record by less than a tenth
    /// of the shorter of both.
    pub misfits: Vec<Option<Misfit>>,
}

/// Names and size of a picture of friction that differ from the usual ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrictionLook {
    /// Names of the runs in the legend, in their order, and then of a record; if there are none, the folders
    /// are used.
    pub names: Vec<String>,
    /// Title of the horizontal axis.
    pub x_label: Option<String>,
    /// Title of the axis of friction.
    pub y_label: Option<String>,
    /// Size of the picture and of its letters.
    pub size: PictureSize,
}

impl FrictionLook {
    fn draw(&self, scale: Scale, mut curves: Vec<FrictionCurve>) -> Result<Picture, RunPictureError> {
        let Scale { mut axes, .. } = scale;
        for (title, own) in [(&mut axes.x, &self.x_label), (&mut axes.friction, &self.y_label)] {
            if let Some(own) = own {
                own.clone_into(title);
            }
        }
        for (curve, name) in curves.iter_mut().zip(&self.names) {
            name.clone_into(&mut curve.label);
        }
        drawn("friction", plot::friction(&curves, &axes, self.size))
    }
}

/// A picture, and a sentence about its axes if they are not the expected ones.
pub struct Overlay {
    /// Fit of a record that was laid over the curves.
    pub fit: Option<Fit>,
    /// The picture.
    pub picture: Picture,
    /// The sentence about the axes.
    pub note: Option<String>,
}

/// A run and its curve: t*, path of the drive in units of displacement, mu*, N*.
struct DrawnRun {
    folder: PathBuf,
    summary: Summary,
    rows: Vec<[f64; 4]>,
    /// Whether the friction of the rows is the output of an instrument.
    is_recorded: bool,
}

/// Factors of the numbers of a run, and the names of the axes.
struct Scale {
    axes: FrictionAxes,
    against: Against,
    /// Factors for each run: of times or paths, and of friction.
    factors: Vec<[f64; 2]>,
    /// Prefixes of the axes in SI units; 1 without units.
    prefixes: [f64; 2],
}

impl Scale {
    fn curves(&self, runs: &[DrawnRun]) -> Vec<FrictionCurve> {
        let curves = runs.iter().zip(&self.factors);
        curves
            .map(|(run, factors)| run.curve(self.against, *factors))
            .collect()
    }
}

/// Draws the friction curves of run folders over each other.
///
/// If units and abscissa are not given, runs of different materials are drawn so that they can be compared:
/// as mu if their mean local coefficients differ, and against the path of the drive if their units of time
/// differ.
///
/// # Errors
/// When a folder cannot be read, or its run lacks the requested data.
pub fn overlay(
    folders: &[PathBuf],
    units: AxisUnits,
    against: Option<Against>,
    look: &FrictionLook,
) -> Result<Overlay, RunPictureError> {
    let runs = DrawnRun::read_all(folders)?;
    let against = against.or(path_of_uneven(&runs));
    let (scale, note) = match units {
        AxisUnits::Si => (in_si(&runs, against.unwrap_or_default(), Measure::Force)?, None),
        AxisUnits::Star => dimensionless(&runs, against)?,
    };
    let curves = scale.curves(&runs);
    Ok(Overlay {
        fit: None,
        picture: look.draw(scale, curves)?,
        note,
    })
}

/// Largest ratio of the lengths of a record and of a run.
const MOST_LENGTHS: f64 = 1e8;

/// Distance of the beginning of a record from 0, over its length, at which its times are those of a calendar
/// and not of a test.
const FAR: f64 = 1e4;

/// Draws the friction curves of run folders and a measured record over each other, in SI units. Curves that
/// are the output of an instrument have no marks, because marks refer to friction itself.
///
/// # Errors
/// As for [`overlay`]; when an instrument needs the time of a drive that is held; when the record overlaps
/// every curve by less than a tenth of the shorter of both; and when no shift is given and the best one is
/// ambiguous.
pub fn overlay_measured(
    folders: &[PathBuf],
    against: Against,
    measured: &OverlaidRecord,
    look: &FrictionLook,
) -> Result<Overlay, RunPictureError> {
    let mut runs = DrawnRun::read_all(folders)?;
    if let Some(instrument) = &measured.instrument {
        for run in &mut runs {
            run.pass(instrument, measured.record.quantity)?;
        }
    }
    let scale = in_si(&runs, against, measured.record.quantity)?;
    let mut curves = scale.curves(&runs);
    let [along, up] = scale.prefixes;
    let MeasuredRecord { x, y, .. } = &measured.record;
    let scaled = (
        x.iter().map(|x| x / along).collect::<Vec<_>>(),
        y.iter().map(|y| y / up).collect::<Vec<_>>(),
    );
    let record = (&scaled.0[..], &scaled.1[..]);
    let in_units = |along_x: f64| with_si_prefix(along * along_x, measured.record.along.unit());
    let [from, to] = ends(record.0);
    let [start, end] = ends(&curves[0].x);
    let lengths = [to - from, end - start];
    if lengths[0] < lengths[1] / MOST_LENGTHS || lengths[0] > lengths[1] * MOST_LENGTHS {
        let [record_length, run_length] = lengths.map(in_units);
        return Err(Box::new(RecordError::OtherLength {
            record: measured.label.clone(),
            record_length,
            run: folders[0].clone(),
            run_length,
        })
        .into());
    }
    let shift = match measured.shift {
        Some(shift) => shift / along,
        None if from.abs() > FAR * lengths[0].max(lengths[1]) => {
            return Err(Box::new(RecordError::FarAway {
                record: measured.label.clone(),
                begin: x.first().copied().unwrap_or_default(),
                unit: measured.record.along.unit(),
            })
            .into());
        }
        None => own_shift(record, &curves).map_err(|Rival { run, own, other }| {
            let (record, [own, other]) = (measured.label.clone(), [own, other].map(in_units));
            Box::new(match run {
                0 => RecordError::UnclearShift {
                    record,
                    one: own,
                    other,
                },
                _ => RecordError::ShiftsOfRuns {
                    record,
                    first: folders[0].clone(),
                    own,
                    other: folders[run].clone(),
                    of_other: other,
                },
            })
        })?,
    };
    let misfits: Vec<Option<Misfit>> = curves
        .iter()
        .map(|curve| {
            let Misfit { rms, points } = misfit(record, (&curve.x, &curve.friction), shift)?;
            Some(Misfit {
                rms: up * rms,
                points,
            })
        })
        .collect();
    if misfits.iter().all(Option::is_none) {
        let [from, to] = ends(record.0).map(|x| in_units(x + shift));
        let [start, end] = ends(&curves[0].x).map(in_units);
        return Err(Box::new(RecordError::LittleInCommon {
            record: measured.label.clone(),
            from,
            to,
            run: folders[0].clone(),
            start,
            end,
        })
        .into());
    }
    let fit = Fit {
        measures: [measured.record.along, measured.record.quantity],
        shift: along * shift,
        points: x.len(),
        misfits,
    };
    curves.push(FrictionCurve {
        label: measured.label.clone(),
        sliding_percent: vec![f64::NAN; x.len()],
        x: scaled.0.iter().map(|x| x + shift).collect(),
        friction: scaled.1,
        is_record: true,
        ..FrictionCurve::default()
    });
    Ok(Overlay {
        fit: Some(fit),
        picture: look.draw(scale, curves)?,
        note: None,
    })
}

/// Another shift of a record that may be right, as well as the best one on the first run.
struct Rival {
    /// The run that the other shift fits, which may be the first one.
    run: usize,
    own: f64,
    other: f64,
}

/// The shift with which a record fits the first curve best, if no other shift fits this or another curve
/// about as well.
fn own_shift(record: Points, curves: &[FrictionCurve]) -> Result<f64, Rival> {
    let length = |xs: &[f64]| {
        let [from, to] = ends(xs);
        to - from
    };
    let shorter = length(record.0).min(length(&curves[0].x));
    let fitting = |curve: &FrictionCurve| fitting_shifts(record, (&curve.x, &curve.friction));
    let on_first = fitting(&curves[0]);
    let best = on_first[0];
    let others = curves.iter().enumerate().skip(1);
    let others = others.map(|(run, curve)| (run, fitting(curve)[..1].to_vec()));
    for (run, shifts) in others.chain([(0, on_first[1..].to_vec())]) {
        if let Some(other) = rival(best, &shifts, shorter) {
            return Err(Rival {
                run,
                own: best.shift,
                other: other.shift,
            });
        }
    }
    Ok(best.shift)
}

/// Draws the friction curve of a run against t*.
pub(super) fn of_run(run: RunFiles, size: PictureSize) -> Result<Picture, RunPictureError> {
    let runs = [DrawnRun::read(run)?];
    let against = path_of_uneven(&runs).unwrap_or(Against::Time);
    let (scale, _) = dimensionless(&runs, Some(against))?;
    let curves = scale.curves(&runs);
    let look = FrictionLook {
        size,
        ..FrictionLook::default()
    };
    look.draw(scale, curves)
}

/// The path as abscissa if the increments of a held drive differ: the time of the drive counts them, so that
/// friction against it has kinks where they change.
fn path_of_uneven(runs: &[DrawnRun]) -> Option<Against> {
    let is_uneven = |run: &DrawnRun| {
        let rates = run.rows.iter().filter(|row| row[0] > 0.0);
        let rates = rates.map(|row| row[1] / row[0]);
        let [least, most] = rates.fold([f64::INFINITY, 0.0], |[least, most], rate| {
            [rate.min(least), rate.max(most)]
        });
        // Increments become four times smaller; the quotients of equal ones are rounded.
        run.summary.drive_steps.is_some() && most > least * (1.0 + 1e-6)
    };
    runs.iter().any(is_uneven).then_some(Against::Displacement)
}

/// The curve of mu* against t* with all marks that a summary has, without its points.
pub fn marked_curve(label: String, summary: &Summary) -> FrictionCurve {
    let kinetic = summary.kinetic_window_star.zip(summary.kinetic_friction_star);
    let peak = (summary.onset_time_star, summary.static_friction_star);
    let instants = summary.instants.iter().map(|instant| Instant {
        letter: instant.instant,
        x: instant.drive_time_star.unwrap_or(instant.time_star),
        friction: instant.mu_star,
    });
    FrictionCurve {
        label,
        first_slip: summary.first_slip_time_star,
        peak: summary.transition.then_some(peak),
        kinetic: kinetic.map(|([from, to], mean)| KineticLine {
            from,
            to,
            mean,
            uncertainty: summary.kinetic_friction_star_uncertainty,
        }),
        instants: instants.collect(),
        ..FrictionCurve::default()
    }
}

impl DrawnRun {
    fn read_all(folders: &[PathBuf]) -> Result<Vec<Self>, RunPictureError> {
        folders
            .iter()
            .map(|folder| Self::read(RunFiles::Folder(folder)))
            .collect()
    }

    fn read(run: RunFiles) -> Result<Self, RunPictureError> {
        let summary = summary_of(&run.file(SUMMARY)?)?;
        let unit = summary.si.as_ref().map_or(f64::NAN, |si| si.displacement_unit_m);
        let row = |row: SeriesRow| {
            let path = row.drive_displacement_m.map_or(f64::NAN, |path| path / unit);
            let time_star = row.drive_time_star.unwrap_or(row.time_star);
            [time_star, path, row.mu_star, row.sliding_percent]
        };
        Ok(Self {
            rows: series::read_rows(&run.file(SERIES)?, SERIES, row)?,
            folder: run.path().to_owned(),
            summary,
            is_recorded: false,
        })
    }

    /// Replaces friction by the output of an instrument.
    fn pass(&mut self, instrument: &Instrument, quantity: Measure) -> Result<(), RunPictureError> {
        // The times of a held drive count only while it moves.
        if self.summary.drive_steps.is_some() && instrument.has_memory() {
            return Err(Box::new(RecordError::HeldDrive(self.folder.clone())).into());
        }
        let (time_unit, unit) = (self.si()?.time_unit_s, self.friction_unit(quantity)?);
        let time: Vec<f64> = self.rows.iter().map(|row| time_unit * row[0]).collect();
        let friction: Vec<f64> = self.rows.iter().map(|row| unit * row[2]).collect();
        let written = instrument.record(&time, &friction);
        for (row, written) in self.rows.iter_mut().zip(written) {
            row[2] = written / unit;
        }
        self.is_recorded = true;
        Ok(())
    }

    /// Friction at mu* = 1: N, or N m for a rotation; 1 for a coefficient.
    fn friction_unit(&self, quantity: Measure) -> Result<f64, RunPictureError> {
        let si = self.si()?;
        Ok(match si.static_torque_n_m {
            _ if quantity == Measure::Coefficient => si.stress_unit_pa / si.pressure_pa,
            Some(torque) => torque / self.summary.static_friction_star,
            None => si.stress_unit_pa * si.area_m2,
        })
    }

    fn is_rotation(&self) -> bool {
        self.summary.motion == Some(Motion::Rotation)
    }

    /// Units of the run, which its summary may lack.
    fn si(&self) -> Result<&SiSummary, RunPictureError> {
        let found = self.summary.si.as_ref();
        found.ok_or_else(|| RunPictureError::NoUnits(self.folder.clone()))
    }

    /// Path of the drive at a time, by linear interpolation between two rows of the series.
    fn path_at(&self, time_star: f64) -> f64 {
        let after = self.rows.partition_point(|row| row[0] < time_star);
        let after = after.min(self.rows.len().saturating_sub(1));
        let row = |k: usize| self.rows.get(k).copied().unwrap_or([f64::NAN; 4]);
        let (before, after) = (row(after.saturating_sub(1)), row(after));
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
        let label = self.folder.display().to_string();
        let marked = if self.is_recorded {
            FrictionCurve {
                label,
                ..FrictionCurve::default()
            }
        } else {
            marked_curve(label, &self.summary)
        };
        let mut curve = FrictionCurve {
            x: column(against as usize, along),
            friction: column(2, up),
            sliding_percent: column(3, 1.0),
            ..marked
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

/// Axes of mu* against t*, for a slider that is pulled or rotated.
pub fn dimensionless_axes(is_rotation: bool) -> FrictionAxes {
    let mut axes = FrictionAxes::default();
    if is_rotation {
        axes.friction = "torque \u{3bc}*".to_owned();
    }
    axes
}

/// Dimensionless axes, with a note if they are not mu* against t*.
fn dimensionless(
    runs: &[DrawnRun],
    asked: Option<Against>,
) -> Result<(Scale, Option<String>), RunPictureError> {
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
    let mut axes = dimensionless_axes(runs.iter().all(DrawnRun::is_rotation));
    if other_friction {
        axes.friction = "friction \u{3bc}".to_owned();
        (axes.peak, axes.kinetic) = ("\u{3bc}_s".to_owned(), "\u{3bc}_k".to_owned());
    }
    if against == Against::Displacement {
        axes.x = "drive displacement in units of P\u{27e8}\u{3bc}_s\u{27e9}l\u{b2}/(E h)".to_owned();
    }
    let up = |si: &Option<&SiSummary>| si.filter(|_| other_friction).map_or(1.0, mean_static);
    let factors = units.iter().map(|si| [1.0, up(si)]).collect();
    let note = match [other_friction, other_time] {
        [false, false] => None,
        [true, false] => {
            Some("the mean static coefficients of the runs differ: friction is drawn as mu, not as mu*")
        }
        [false, true] => Some(
            "the units of time of the runs differ: friction is drawn against the displacement of the drive in units of P mu_s l^2/(E h)",
        ),
        [true, true] => Some(
            "the runs have different materials: friction is drawn as mu against the displacement of the drive in units of P mu_s l^2/(E h)",
        ),
    };
    let scale = Scale {
        axes,
        against,
        factors,
        prefixes: [1.0; 2],
    };
    Ok((scale, note.map(str::to_owned)))
}

/// Axes of newtons, or of coefficients, and of seconds or metres, with the prefixes that suit the largest
/// numbers.
fn in_si(runs: &[DrawnRun], against: Against, measure: Measure) -> Result<Scale, RunPictureError> {
    let turns = runs.iter().all(DrawnRun::is_rotation);
    if let Some(run) = runs.iter().find(|run| run.is_rotation() != turns) {
        return Err(RunPictureError::NotComparable(run.folder.clone()));
    }
    let mut factors = Vec::with_capacity(runs.len());
    for run in runs {
        let si = run.si()?;
        let along = match against {
            Against::Time => si.time_unit_s,
            Against::Displacement => si.displacement_unit_m,
        };
        factors.push([along, run.friction_unit(measure)?]);
    }
    let largest = |column: usize, axis: usize| {
        let sizes = runs.iter().zip(&factors).flat_map(|(run, factors)| {
            let factor = factors[axis];
            run.rows.iter().map(move |row| (factor * row[column]).abs())
        });
        sizes.filter(|size| size.is_finite()).fold(0.0, f64::max)
    };
    let mut prefixes = [(against as usize, 0), (2, 1)].map(|(column, axis)| si_prefix(largest(column, axis)));
    if measure == Measure::Coefficient {
        prefixes[1] = (1.0, "");
    }
    for factors in &mut factors {
        for (factor, (unit, _)) in factors.iter_mut().zip(prefixes) {
            *factor /= unit;
        }
    }
    let [along, up] = prefixes.map(|(_, prefix)| in_print(prefix));
    let (quantity, letter, unit) = match turns {
        _ if measure == Measure::Coefficient => ("friction coefficient \u{3bc}", '\u{3bc}', String::new()),
        true => ("torque", 'M', format!("{up}N m")),
        false => ("friction force", 'F', format!("{up}N")),
    };
    let in_unit = |before: &str, after: &str| match unit.as_str() {
        "" => String::new(),
        unit => format!("{before}{unit}{after}"),
    };
    let axes = FrictionAxes {
        x: match against {
            Against::Time => format!("time ({along}s)"),
            Against::Displacement => format!("drive displacement ({along}m)"),
        },
        friction: format!("{quantity}{}", in_unit(" (", ")")),
        peak: format!("{letter}_s"),
        kinetic: format!("{letter}_k"),
        unit: format!(" {unit}"),
    };
    Ok(Scale {
        axes,
        against,
        factors,
        prefixes: prefixes.map(|(unit, _)| unit),
    })
}
