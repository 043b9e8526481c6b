//! The set-up of a calibration: the case, its unknown keys, and the conditions of each record.

use std::sync::atomic::{AtomicBool, Ordering};

use slipfront::RunError;
use slipfront_case::case::{Case, Ranks};
use slipfront_case::case_file::{CaseError, CaseFile, Override};
use slipfront_run::instrument::{Instrument, InstrumentError, InstrumentKeys};
use slipfront_run::run_curve::{CurveCase, RunCurve, steps_to};

use crate::sample_points::SamplePoints;
use slipfront_study::Base;
use slipfront_study::Unknown;
use slipfront_study::identity::physics;
use slipfront_study::{NoCurve, StudyError, TrainingError};

/// Largest number of halvings of the time step of a case.
pub(crate) const MOST_HALVINGS: u32 = 7;

/// Conditions of one record.
#[derive(Clone, Debug, PartialEq)]
pub struct Conditions {
    /// Keys in which the record differs from the case, such as its speed.
    pub overrides: Vec<Override>,
    /// Places at which friction is known.
    pub grid: SamplePoints,
}

/// The set-up of a training.
#[derive(Clone, Debug)]
pub struct SetUp {
    /// The case.
    pub base: Base,
    /// The unknown keys.
    pub unknowns: Vec<Unknown>,
    /// The records.
    pub conditions: Vec<Conditions>,
    /// The table `[instrument]`, if there is one.
    pub instrument: Option<toml::Table>,
    /// Whether blocks have half the size of those of the case.
    pub is_finer: bool,
    /// Number of halvings of the time step of the case.
    pub halvings: u32,
}

/// The key of the table `[instrument]` that is unknown, and its value at a share of the range; none for a key
/// of the case.
fn of_instrument(unknown: &Unknown, share: f64) -> Option<(&str, toml::Value)> {
    Some((unknown.key().strip_prefix("instrument.")?, unknown.written(share)))
}

/// Friction without noise, for every record.
pub type Curves = Vec<Vec<f64>>;

impl SetUp {
    /// Settings of the unknown keys of the case at these shares of the ranges.
    pub(crate) fn set_to(&self, shares: &[f64]) -> Vec<Override> {
        let values = self.unknowns.iter().zip(shares);
        let of_case = values.filter(|(unknown, share)| of_instrument(unknown, **share).is_none());
        of_case.map(|(unknown, &share)| unknown.set_to(share)).collect()
    }

    /// The instrument at these shares of the ranges, for the record under these conditions; none if the file
    /// has no table `[instrument]`, and no key of it is unknown.
    ///
    /// # Errors
    /// When its keys are not valid there.
    pub(crate) fn instrument(
        &self,
        shares: &[f64],
        conditions: &Conditions,
    ) -> Result<Option<Instrument>, InstrumentError> {
        let values = self.unknowns.iter().zip(shares);
        let unknown: toml::Table = values
            .filter_map(|(unknown, &share)| of_instrument(unknown, share))
            .map(|(key, value)| (key.to_owned(), value))
            .collect();
        if self.instrument.is_none() && unknown.is_empty() {
            return Ok(None);
        }
        let mut table = self.instrument.clone().unwrap_or_default();
        table.extend(unknown);
        InstrumentKeys::from_table(&table)?
            .instrument(conditions.grid.quantity)
            .map(Some)
    }

    /// Whether the instrument has a range beyond which it clips.
    pub(crate) fn has_range(&self) -> bool {
        self.instrument
            .as_ref()
            .is_some_and(|table| table.contains_key("range"))
    }

    /// The grids of the records.
    pub(crate) fn grids(&self) -> Vec<SamplePoints> {
        self.conditions.iter().map(|one| one.grid.clone()).collect()
    }

    /// The middle of all ranges, as shares.
    pub(crate) fn middle(&self) -> Vec<f64> {
        vec![0.5; self.unknowns.len()]
    }

    /// The set-up for the beginning of the records, a share of them.
    pub(crate) fn beginning(&self, share: f64) -> Self {
        let mut part = self.clone();
        for conditions in &mut part.conditions {
            conditions.grid = conditions.grid.beginning(share);
        }
        part
    }

    /// The set-up after this number of halvings of its time step.
    pub(crate) fn halved(&self, times: u32) -> Self {
        Self {
            halvings: self.halvings + times,
            ..self.clone()
        }
    }

    /// The set-up on blocks of half the size.
    ///
    /// # Errors
    /// With the reason why there is none.
    pub(crate) fn finer(&self) -> Result<Self, String> {
        let finer = Self {
            is_finer: true,
            ..self.clone()
        };
        let middle = finer.middle();
        for conditions in &finer.conditions {
            finer
                .case(&middle, 0, conditions)
                .map_err(|error| error.to_string())?;
        }
        Ok(finer)
    }

    /// Values of the unknowns at these shares, for a sentence.
    fn point(&self, shares: &[f64]) -> String {
        let values = self.unknowns.iter().zip(shares);
        let set = values.map(|(unknown, &share)| unknown.set_to(share).to_string());
        set.collect::<Vec<_>>().join(", ")
    }

    /// The case of a record at these shares of the ranges, on the surface of this `friction.seed`.
    ///
    /// # Errors
    /// When the case is not valid, or cannot be put on blocks of half the size if the set-up asks for them.
    pub fn case(&self, shares: &[f64], seed: u64, conditions: &Conditions) -> Result<Case, CaseError> {
        let mut changes = self.set_to(shares);
        changes.push(Override::new("friction.seed", &toml::Value::from(seed as i64)));
        let all: Vec<&Override> = conditions.overrides.iter().chain(&changes).collect();
        let made =
            |file: CaseFile| Case::new(file, "training", self.base.files(), &mut |_| true, Ranks::ALONE);
        let mut case = made(self.base.parse()?.with(&all)?)?;
        if self.halvings > 0 {
            let step = 0.5_f64.powi(self.halvings as i32) * case.time_plan.dt_star;
            let finer = Override::new("time.step", &toml::Value::from(step));
            let all: Vec<&Override> = all.into_iter().chain([&finer]).collect();
            case = made(self.base.parse()?.with(&all)?)?;
        }
        if !self.is_finer {
            return Ok(case);
        }
        let finer = case.on_other_blocks(2.0)?;
        let set: Vec<String> = finer.iter().map(ToString::to_string).collect();
        made(CaseFile::parse(&case.file.to_toml()?, "training", &set)?)
    }

    /// Whether random coefficients make curves of the same unknowns differ.
    pub(crate) fn is_random(&self) -> Result<bool, CaseError> {
        let middle = self.middle();
        let coefficients = |seed: u64| {
            let case = self.case(&middle, seed, &self.conditions[0])?;
            let surface = &case.model.surface;
            Ok::<_, CaseError>([
                surface.mean_static_coefficient(),
                surface.mean_kinetic_coefficient(),
            ])
        };
        Ok(coefficients(1)? != coefficients(2)?)
    }

    /// Memory of the largest run, in bytes, after this number of halvings of the time step.
    pub(crate) fn bytes_of_run(&self, halvings: u32) -> Result<f64, CaseError> {
        // Time, path and friction of every step, and a fourth number as a reserve.
        const STEP: f64 = 4.0 * size_of::<f64>() as f64;
        let middle = self.middle();
        let mut largest = 0.0_f64;
        for conditions in &self.conditions {
            let case = self.case(&middle, 0, conditions)?;
            let steps = steps_to(&case, conditions.grid.along, conditions.grid.end()) << halvings;
            largest = largest.max(case.budget.stepping() + STEP * steps as f64);
        }
        Ok(largest)
    }

    /// The curves of all records at these shares of the ranges, on the surface of this `friction.seed`; none
    /// after a stop.
    ///
    /// # Errors
    /// When the case is not valid there, the run diverges, or it ends before a record.
    pub fn curves(
        &self,
        shares: &[f64],
        seed: u64,
        stop: &AtomicBool,
    ) -> Result<Option<Curves>, TrainingError> {
        let mut curves = Vec::new();
        for (number, conditions) in self.conditions.iter().enumerate() {
            let case = self.curve_case(shares, seed, conditions)?;
            let Some(curve) = case.curve_unless(&|| stop.load(Ordering::Relaxed)) else {
                return Ok(None);
            };
            curves.push(self.recorded(shares, number, curve)?);
        }
        Ok(Some(curves))
    }

    /// The case of a record up to the end of the record, with an error that names the point of the ranges.
    pub(crate) fn curve_case(
        &self,
        shares: &[f64],
        seed: u64,
        conditions: &Conditions,
    ) -> Result<CurveCase, TrainingError> {
        let case = self.case(shares, seed, conditions);
        Ok(CurveCase {
            case: case.map_err(|error| self.error_at(shares, error))?,
            along: conditions.grid.along,
            end: conditions.grid.end(),
        })
    }

    /// Friction at the places of a record, as its instrument shows the curve of a run.
    pub(crate) fn recorded(
        &self,
        shares: &[f64],
        record: usize,
        curve: Result<RunCurve, RunError>,
    ) -> Result<Vec<f64>, TrainingError> {
        let conditions = &self.conditions[record];
        let curve = curve.map_err(|error| self.error_at(shares, error))?;
        let instrument = self.instrument(shares, conditions);
        let instrument = instrument.map_err(|error| self.error_at(shares, error))?;
        let recorded = conditions.grid.curve(&curve, instrument.as_ref());
        recorded.ok_or_else(|| self.error_at(shares, NoCurve::Short { record: record + 1 }))
    }

    /// The error of a run at these shares of the ranges.
    pub(crate) fn error_at(&self, shares: &[f64], reason: impl Into<NoCurve>) -> TrainingError {
        TrainingError {
            point: self.point(shares),
            reason: Box::new(reason.into()),
        }
    }

    /// A hash of everything that determines the curves, except the number of runs.
    pub(crate) fn identity(&self) -> Result<String, StudyError> {
        let mut hasher = blake3::Hasher::new();
        // This crate converts the output of a run to recorded curves, so its sources count, too.
        hasher.update(env!("SLIPFRONT_SOURCE_HASH").as_bytes());
        let middle = self.middle();
        for conditions in &self.conditions {
            hasher.update(physics(&self.case(&middle, 0, conditions)?)?.as_bytes());
            conditions.grid.add_to(&mut hasher);
        }
        hasher.update(format!("{:?}{:?}", self.unknowns, self.instrument).as_bytes());
        Ok(hasher.finalize().to_hex()[..16].to_owned())
    }
}
