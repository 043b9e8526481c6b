//! Where figures get their runs: cases with their curves and fields, studies with their records.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use slipfront::Stop;
use slipfront::observe::{CurvePoint, Frame};

use crate::embedded_cases::FILES;
use crate::error::PaperError;
use crate::measurements::Number;
use slipfront::observe::Field;
use slipfront_case::case::{Case, Snapshots};
use slipfront_case::case_file::CaseError;
use slipfront_plot::{FieldMap, FrictionCurve};
use slipfront_run::pictures::marked_curve;
use slipfront_run::running::Record;
use slipfront_run::study::{
    Findings, Plan, Quantity, Records, RetainRuns, Role, RunKey, StudyError, StudyFile,
};
use slipfront_run::{running as run, study};

/// How the time step is chosen where a case does not say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepRule {
    /// `dt* = 0.1`.
    Auto,
    /// The paper's, `dt* = (2/3) V*` (Eq. 13).
    Paper,
}

/// Runs what figures ask for.
pub(super) struct Bench<'a> {
    /// Finished runs of studies.
    pub(super) records: &'a mut Records,
    /// Runs at once.
    pub(super) threads: usize,
    /// Set by a signal: everything ends.
    pub(super) stop: &'a AtomicBool,
    /// The time step.
    pub(super) step: StepRule,
    /// Two surfaces in place of five.
    pub(super) reduced: bool,
    /// Told of every run of a study.
    pub(super) watch: &'a mut dyn FnMut(&study::Progress),
}

impl Bench<'_> {
    /// Number of random surfaces where a figure goes beyond its study.
    pub(super) fn surfaces(&self) -> u64 {
        if self.reduced { 2 } else { 5 }
    }

    /// A case of `cases/paper/`, changed by `overrides`.
    pub(super) fn case(&self, file: &str, overrides: &[&str]) -> Result<Case, PaperError> {
        let text = with_step(text_of(file)?, self.step)?;
        let overrides: Vec<String> = overrides.iter().map(|&key| key.to_owned()).collect();
        Ok(Case::parse(&text, file, &overrides)?)
    }

    /// Runs cases side by side, curves and fields kept; they come back in their order.
    pub(super) fn run(&self, cases: Vec<Case>) -> Result<Vec<Run>, PaperError> {
        let stop = self.stop;
        cases.into_par_iter().map(|case| run_case(case, stop)).collect()
    }

    /// Runs one case.
    pub(super) fn run_one(&self, case: Case) -> Result<Run, PaperError> {
        run_case(case, self.stop)
    }

    /// The points of a study of `cases/paper/`, none of them run.
    pub(super) fn plan(&self, name: &str) -> Result<Sweep, PaperError> {
        let mut file = StudyFile::parse(text_of(name)?, name, name, Path::new(""))?;
        file.base.text = with_step(&file.base.text, self.step)?;
        if self.reduced {
            file.settings.replicates = file.settings.replicates.min(2);
        }
        Ok(Sweep {
            plan: Plan::new(&file, None)?,
            findings: Findings {
                runs: BTreeMap::new(),
                points: Vec::new(),
                strangers: 0,
            },
        })
    }

    /// Runs a study of `cases/paper/`, or takes from the records what has been run.
    pub(super) fn study(&mut self, name: &str) -> Result<Sweep, PaperError> {
        let plan = self.plan(name)?.plan;
        // Nothing is kept of the runs but their records: the folder is not used.
        let findings = study::execute(
            &plan,
            self.records,
            Path::new(""),
            self.threads,
            self.stop,
            self.watch,
        )?;
        if let Some((_, reason)) = findings.failures().next() {
            return Err(PaperError::StudyRun {
                study: name.to_owned(),
                reason: reason.to_owned(),
            });
        }
        Ok(Sweep { plan, findings })
    }
}

fn run_case(case: Case, stop: &AtomicBool) -> Result<Run, PaperError> {
    let record = run::run_unless(&case, &|| stop.load(Ordering::Relaxed)).ok_or(StudyError::Interrupted)?;
    let record = record.map_err(|source| PaperError::Run {
        name: case.name.clone(),
        source,
    })?;
    Ok(Run { case, record })
}

fn text_of(file: &str) -> Result<&'static str, PaperError> {
    let found = FILES.iter().find(|(name, _)| *name == file);
    found.map(|(_, text)| *text).ok_or_else(|| PaperError::Lacks {
        file: "cases/paper".to_owned(),
        what: format!("{file}.toml"),
    })
}

/// The text of a case with the paper's time step, unless it says something itself.
fn with_step(text: &str, step: StepRule) -> Result<String, PaperError> {
    if step == StepRule::Auto {
        return Ok(text.to_owned());
    }
    let mut case: toml::Table = text.parse()?;
    let time = case
        .entry("time")
        .or_insert_with(|| toml::Table::new().into())
        .as_table_mut();
    if let Some(time) = time {
        time.entry("step").or_insert_with(|| "paper".into());
    }
    Ok(toml::to_string(&case).map_err(CaseError::from)?)
}

/// The same case with its fields kept at these times.
pub(super) fn seen_at(mut case: Case, times_star: &[f64]) -> Case {
    let step = |time: &f64| (time / case.time_plan.dt_star).round() as u64;
    let mut steps: Vec<u64> = times_star.iter().map(step).collect();
    steps.dedup();
    case.output.snapshots = Snapshots::At(steps);
    case
}

/// A case and all that its run left.
pub(super) struct Run {
    pub(super) case: Case,
    pub(super) record: Record,
}

impl Run {
    /// The frame of one of the instants A-F.
    pub(super) fn instant(&self, letter: char) -> Result<&Frame, PaperError> {
        let found = self
            .record
            .frames
            .iter()
            .find(|(letters, _)| letters.contains(letter));
        found
            .map(|(_, frame)| frame)
            .ok_or_else(|| self.lacks(&format!("instant {letter}")))
    }

    /// The values of a field in a frame of this run.
    pub(super) fn field<'f>(&self, frame: &'f Frame, field: Field) -> Result<&'f [f32], PaperError> {
        let index = self.case.output.fields.iter().position(|&name| name == field);
        let values = index.and_then(|index| frame.values.get(index));
        values.map(Vec::as_slice).ok_or_else(|| self.lacks("such field"))
    }

    /// A map of tau_c*, blank over a texture.
    pub(super) fn stress_map(&self, frame: &Frame, label: &str) -> Result<FieldMap, PaperError> {
        let largest = self.record.contact_stress_max as f32;
        let values = self.field(frame, Field::ContactStress)?;
        let textured = &self.case.model.surface.textured;
        let scaled = values.iter().zip(textured);
        Ok(FieldMap {
            note: format!(
                "t* = {:.1}, \u{3bc}* = {:.3}",
                frame.time_star, frame.point.mu_star
            ),
            values: scaled
                .map(|(value, &textured)| if textured { f32::NAN } else { value / largest })
                .collect(),
            ..self.blank_map(label)
        })
    }

    /// A map of this lattice without values.
    pub(super) fn blank_map(&self, label: &str) -> FieldMap {
        let lattice = &self.case.model.lattice;
        FieldMap {
            label: label.to_owned(),
            nx: lattice.nx,
            ny: lattice.ny,
            textured: self.case.model.surface.textured.clone(),
            ..FieldMap::default()
        }
    }

    /// The curve with its peak, its kinetic window and the letters of its instants.
    pub(super) fn lettered_curve(&self, label: &str) -> FrictionCurve {
        let rows = &self.record.rows;
        FrictionCurve {
            time_star: rows.iter().map(|row| row.time_star).collect(),
            mu_star: rows.iter().map(|row| row.point.mu_star).collect(),
            sliding_percent: rows.iter().map(|row| row.point.sliding_percent).collect(),
            ..marked_curve(label.to_owned(), &self.record.summary)
        }
    }

    /// The same without letters.
    pub(super) fn curve(&self, label: &str) -> FrictionCurve {
        FrictionCurve {
            instants: Vec::new(),
            ..self.lettered_curve(label)
        }
    }

    /// A quantity of the curve at a time, between two rows on the straight line.
    pub(super) fn at(&self, time_star: f64, value: fn(&CurvePoint) -> f64) -> f64 {
        let rows = &self.record.rows;
        let after = rows
            .partition_point(|row| row.time_star < time_star)
            .min(rows.len() - 1);
        let (a, b) = (&rows[after.saturating_sub(1)], &rows[after]);
        let span = b.time_star - a.time_star;
        let share = if span > 0.0 {
            (time_star - a.time_star) / span
        } else {
            0.0
        };
        value(&a.point) + share.clamp(0.0, 1.0) * (value(&b.point) - value(&a.point))
    }

    /// The largest difference of a quantity to that of another run, over the rows of this one up to `until`.
    pub(super) fn largest_difference(
        &self,
        other: &Run,
        [from, until]: [f64; 2],
        value: fn(&CurvePoint) -> f64,
    ) -> f64 {
        let rows = self.record.rows.iter();
        rows.filter(|row| (from..=until).contains(&row.time_star))
            .map(|row| (value(&row.point) - other.at(row.time_star, value)).abs())
            .fold(0.0, f64::max)
    }

    /// mu* over a stretch of time.
    pub(super) fn friction_between(&self, from: f64, until: f64) -> Vec<f64> {
        let rows = self.record.rows.iter();
        rows.filter(|row| (from..=until).contains(&row.time_star))
            .map(|row| row.point.mu_star)
            .collect()
    }

    /// The window of kinetic friction.
    pub(super) fn kinetic_window(&self) -> Result<[f64; 2], PaperError> {
        let window = self.record.summary.kinetic_window_star;
        window.ok_or_else(|| self.lacks("kinetic window"))
    }

    /// t* of the first slip of all.
    pub(super) fn first_slip(&self) -> Result<f64, PaperError> {
        let time = self.record.summary.first_slip_time_star;
        time.ok_or_else(|| self.lacks("slip"))
    }

    /// Times of the first slip of the blocks in contact, in rising order.
    pub(super) fn slip_times(&self) -> Vec<f64> {
        let times = self.record.first_slip_time_star.iter().copied();
        let mut times: Vec<f64> = times.filter(|time| !time.is_nan()).collect();
        times.sort_by(f64::total_cmp);
        times
    }

    /// When this share of the blocks in contact has slipped.
    pub(super) fn time_of_share(&self, share: f64) -> Result<f64, PaperError> {
        let times = self.slip_times();
        let contact = self.case.model.surface.n_contact() as f64;
        let index = ((share * contact).ceil() as usize).saturating_sub(1);
        times
            .get(index)
            .copied()
            .ok_or_else(|| self.lacks(&format!("slip of {share} of all blocks")))
    }

    fn lacks(&self, what: &str) -> PaperError {
        PaperError::Lacks {
            file: self.case.name.clone(),
            what: what.to_owned(),
        }
    }
}

/// A study and what it found.
pub(super) struct Sweep {
    pub(super) plan: Plan,
    pub(super) findings: Findings,
}

impl Sweep {
    /// Numbers of an axis, or their places on one of names.
    pub(super) fn axis(&self, axis: usize) -> Vec<f64> {
        let levels = self.plan.axes[axis].levels.iter().enumerate();
        levels
            .map(|(place, level)| level.number.unwrap_or(place as f64))
            .collect()
    }

    /// Names of the levels of an axis.
    pub(super) fn names(&self, axis: usize) -> Vec<String> {
        let levels = self.plan.axes[axis].levels.iter();
        levels.map(|level| level.labels.join(" ")).collect()
    }

    /// The point with these levels.
    pub(super) fn point(&self, levels: &[usize]) -> usize {
        self.plan
            .axes
            .iter()
            .zip(levels)
            .fold(0, |index, (axis, level)| index * axis.levels.len() + level)
    }

    /// A quantity of the runs of a point, one value a surface.
    pub(super) fn values(&self, levels: &[usize], quantity: &str) -> Vec<f64> {
        let point = self.point(levels);
        let (replicates, quantity) = (
            0..self.findings.points[point].replicates,
            Quantity::named(quantity),
        );
        replicates
            .filter_map(|replicate| self.findings.value(point, replicate, quantity?))
            .collect()
    }

    /// Its mean and interval.
    pub(super) fn number(&self, levels: &[usize], quantity: &str) -> Number {
        Number::of(&self.values(levels, quantity))
    }

    /// The case of a run of a point, to be run to its end with its curve and fields.
    pub(super) fn case(&self, levels: &[usize], replicate: usize) -> Result<Case, PaperError> {
        let run = RunKey {
            point: self.point(levels),
            replicate,
            role: Role::Point,
        };
        // A plan that keeps its runs gives their cases with curves and fields.
        let mut plan = self.plan.clone();
        plan.settings.keep = RetainRuns::All;
        let mut case = plan.case(run)?;
        case.name = format!("{}, {}", plan.name, plan.describe(&plan.points[run.point]));
        // The largest contact stress of all, which maps are scaled by, may come late.
        case.time_plan.stop = Stop::at_step(case.time_plan.last_step);
        Ok(case)
    }

    /// Cases of all surfaces of a point.
    pub(super) fn cases(&self, levels: &[usize]) -> Result<Vec<Case>, PaperError> {
        (0..self.plan.settings.max_replicates())
            .map(|replicate| self.case(levels, replicate))
            .collect()
    }
}

/// mu* of a point of a curve.
pub(super) fn mu_star(point: &CurvePoint) -> f64 {
    point.mu_star
}

/// N* of a point of a curve.
pub(super) fn sliding_percent(point: &CurvePoint) -> f64 {
    point.sliding_percent
}
