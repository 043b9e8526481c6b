//! Planning of experiments: the expected widths of the intervals of the unknowns, from records that are
//! simulated over the ranges.

use std::sync::atomic::AtomicBool;

use serde::Serialize;
use slipfront_base::text::{COLUMNS, wrapped};
use slipfront_case::case::PROGRAM;
use slipfront_case::case_file::{CaseError, DriveSpeed, Override};
use slipfront_study::text_table::table;
use slipfront_study::work_memory::WorkMemory;
use slipfront_study::{StudyError, Unknown};

use crate::calibration::{Calibration, UNDETERMINED};
use crate::features::MIN_VALUES;
use crate::file::{CalibrationFile, SampledRecord, expect_memory};
use crate::progress::{CalibrationProgress, CalibrationStage};
use crate::runs::RunMaker;
use crate::sample_points::SamplePoints;
use crate::set_up::{Conditions, SetUp};
use crate::training::Training;

/// Number of runs of an experiment.
const RUNS: usize = 200;

/// Factor between the paths of the drive in a longer and in the planned experiment, and between the speeds in
/// a slower or faster one.
const LONGER: usize = 2;
const SPEED: f64 = 3.0;

/// Experiments that may be made, with the intervals that are expected from their records.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExperimentPlan {
    /// The unknown keys.
    pub unknowns: Vec<String>,
    /// Ends of the range of every unknown, with its unit.
    pub ranges: Vec<[String; 2]>,
    /// Number of runs of every experiment.
    pub runs: usize,
    /// The experiments: first the planned one.
    pub experiments: Vec<PlannedExperiment>,
}

/// An experiment that may be made.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlannedExperiment {
    /// Difference from the planned experiment in words.
    pub name: String,
    /// Expected width of the interval of 90 % of every unknown, as a share of its range: the mean over runs,
    /// each estimated by the others. None if the experiment is not possible.
    pub widths: Option<Vec<f64>>,
    /// Reason why it is not possible.
    pub impossible: Option<String>,
}

impl ExperimentPlan {
    /// The widths as a table for a person, and what it shows in sentences.
    pub fn in_words(&self) -> String {
        let shares = |experiment: &PlannedExperiment, unknown: usize| match &experiment.widths {
            Some(widths) => format!("{:.0} %", 100.0 * widths[unknown]),
            None => "-".to_owned(),
        };
        let names = self.experiments.iter().map(|experiment| experiment.name.as_str());
        let head: Vec<&str> = ["key", "range"].into_iter().chain(names).collect();
        let row = |unknown: usize| {
            let [from, to] = &self.ranges[unknown];
            let begin = [self.unknowns[unknown].clone(), format!("{from} to {to}")];
            let widths = self
                .experiments
                .iter()
                .map(|experiment| shares(experiment, unknown));
            begin.into_iter().chain(widths).collect()
        };
        let rows: Vec<Vec<String>> = (0..self.unknowns.len()).map(row).collect();
        let mut text = table(&head, &rows);
        let mut say = |sentence: String| text += &format!("{}\n", wrapped(&sentence, COLUMNS));
        say(format!(
            "Expected widths of the 90 % intervals relative to the ranges, from {} simulated records of each experiment. The \
             calibration has more runs and narrower intervals.",
            self.runs
        ));
        for (number, key) in self.unknowns.iter().enumerate() {
            if let Some(sentence) = self.not_determined(number, key) {
                say(sentence);
            }
        }
        for experiment in &self.experiments {
            if let Some(why) = &experiment.impossible {
                say(format!("\"{}\" is not possible: {why}.", experiment.name));
            }
        }
        text
    }

    /// The sentence on an unknown that the planned record does not determine.
    fn not_determined(&self, unknown: usize, key: &str) -> Option<String> {
        let width = |experiment: &PlannedExperiment| Some(experiment.widths.as_ref()?[unknown]);
        let planned = self.experiments.first().and_then(width)?;
        if planned < UNDETERMINED {
            return None;
        }
        let determine = self.experiments.iter().skip(1);
        let determine =
            determine.filter(|experiment| width(experiment).is_some_and(|found| found < UNDETERMINED));
        let names: Vec<&str> = determine.map(|experiment| experiment.name.as_str()).collect();
        let remedy = match names.as_slice() {
            [] => "nor does any other experiment in the table".to_owned(),
            names => format!("these would: {}", names.join(", ")),
        };
        Some(format!("The planned record does not determine {key}; {remedy}."))
    }
}

/// An experiment with its set-up, or the reason why it is not possible.
type Planned = (&'static str, Result<SetUp, String>);

impl CalibrationFile {
    /// Sample points of planned records at equal steps from the start of the drive to `until`, such as
    /// `20 s`, for one record per record in the file.
    ///
    /// # Errors
    /// When `until` has another unit than records of the file, or there are too few values.
    pub fn planned(&self, until: &str, values: usize) -> Result<Vec<SamplePoints>, StudyError> {
        let along = self.keys.along();
        let refuse =
            |sentence: String| CaseError::invalid(None, format!("the end of the planned record: {sentence}"));
        let end = along.parse(until).map_err(refuse)?;
        let grid = SamplePoints::planned(along, end, values).ok_or_else(|| {
            refuse(format!(
                "a planned record until {until:?} with {values} values: it needs at least {MIN_VALUES} values, and an end after 0"
            ))
        })?;
        Ok(vec![grid; self.keys.n_records()])
    }

    /// Simulates records at `grids` and of other experiments, and estimates every one from the others. No
    /// file is written.
    ///
    /// # Errors
    /// When the ranges leave the bounds of the case, a run cannot be made, and after a stop.
    pub fn plan(
        &self,
        grids: Vec<SamplePoints>,
        stop: &AtomicBool,
        watch: &mut dyn FnMut(&CalibrationProgress),
    ) -> Result<ExperimentPlan, StudyError> {
        let planned = self.set_up_at(grids)?;
        let noise = self.keys.noise;
        let mut experiments: Vec<Planned> = vec![("as planned", Ok(planned.clone()))];
        experiments.extend(self.others(&planned)?);
        let further = self.further(&planned)?;
        let possible = experiments.iter().filter(|(_, set_up)| set_up.is_ok()).count();
        let mut run = 0.0_f64;
        for set_up in experiments
            .iter()
            .flat_map(|(_, set_up)| set_up)
            .chain(further.iter().map(|(_, set_up)| set_up))
        {
            run = run.max(set_up.bytes_of_run(0)?);
        }
        let memory = WorkMemory {
            beside: PROGRAM,
            pieces: vec![(run, usize::MAX)],
        };
        expect_memory(&memory, rayon::current_num_threads())?;
        let mut maker = RunMaker::new(stop, RUNS * (possible + further.len()), watch);
        let mut train = |set_up: &SetUp| Training::run(&mut maker, CalibrationStage::Planning, set_up, RUNS);
        let mut found = Vec::new();
        let mut first = None;
        for (name, set_up) in experiments {
            let (widths, impossible) = match set_up {
                Ok(set_up) => {
                    let training = train(&set_up)?;
                    let calibration = Calibration::new(&training, &set_up.grids(), noise);
                    first.get_or_insert(training);
                    (Some(calibration.mean_widths()), None)
                }
                Err(why) => (None, Some(why)),
            };
            found.push(PlannedExperiment {
                name: name.to_owned(),
                widths,
                impossible,
            });
        }
        for (set, further) in further {
            let more = train(&further)?;
            let grids = [planned.grids(), further.grids()].concat();
            if let Some(first) = &first {
                let both = Calibration::new(&first.clone().with(more), &grids, noise);
                found.push(PlannedExperiment {
                    name: format!("with {set}"),
                    widths: Some(both.mean_widths()),
                    impossible: None,
                });
            }
        }
        Ok(ExperimentPlan {
            ranges: planned.unknowns.iter().map(Unknown::range_in_words).collect(),
            unknowns: planned
                .unknowns
                .iter()
                .map(|unknown| unknown.key().to_owned())
                .collect(),
            runs: RUNS,
            experiments: found,
        })
    }

    /// Longer, slower and faster experiments than the planned one. Slower and faster ones have the same path
    /// and number of values.
    fn others(&self, planned: &SetUp) -> Result<Vec<Planned>, StudyError> {
        let possible = |conditions: Vec<Conditions>| {
            let set_up = self.set_up_under(conditions);
            set_up.map_err(|error| error.to_string())
        };
        let at = |factor: f64| {
            let conditions = planned.conditions.iter();
            let at_speed = conditions.map(|conditions| at_speed(planned, conditions, factor));
            at_speed.collect::<Result<Option<Vec<Conditions>>, CaseError>>()
        };
        let (Some(slower), Some(faster)) = (at(1.0 / SPEED)?, at(SPEED)?) else {
            let why = "`drive.program` has its speeds and its end";
            return Ok(vec![("other speed or duration", Err(why.to_owned()))]);
        };
        let longer = planned.conditions.iter().map(|conditions| Conditions {
            grid: conditions.grid.longer(LONGER),
            ..conditions.clone()
        });
        let mut others = vec![("twice as long", possible(longer.collect()))];
        if planned.unknowns.iter().any(|unknown| is_speed(unknown.key())) {
            others.push(("another speed", Err("the speed is unknown".to_owned())));
        } else {
            others.push(("a third of the speed", possible(slower)));
            others.push(("three times the speed", possible(faster)));
        }
        Ok(others)
    }
}

/// Whether a key is the speed of the drive.
fn is_speed(key: &str) -> bool {
    ["drive.v_star", "drive.speed"].contains(&key)
}

/// The conditions at another speed, over the same path; none if the drive has a program.
fn at_speed(set_up: &SetUp, conditions: &Conditions, factor: f64) -> Result<Option<Conditions>, CaseError> {
    let case = set_up.case(&set_up.middle(), 0, conditions)?;
    let set = match &case.file.drive.speed {
        DriveSpeed::VStar(v_star) => Override::new("drive.v_star", &toml::Value::from(factor * v_star)),
        DriveSpeed::Speed(speed) => {
            let value = format!("{} m/s", factor * speed.si());
            Override::new("drive.speed", &toml::Value::from(value))
        }
        DriveSpeed::Program(_) => return Ok(None),
    };
    let mut overrides = conditions.overrides.clone();
    overrides.push(set);
    Ok(Some(Conditions {
        overrides,
        grid: conditions.grid.slower(1.0 / factor),
    }))
}

impl SampledRecord {
    /// Places at which friction is known.
    pub fn places(&self) -> SamplePoints {
        self.grid.clone()
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn plan(of: &str, until: &str) -> Result<ExperimentPlan, StudyError> {
        let text = format!(
            "[base]\nslider.blocks = [1, 1]\n{of}\n[calibrate]\nx = 't'\ny = 'mu'\nnoise = 0.01\n{UNKNOWNS}"
        );
        let file = CalibrationFile::parse(&text, "fit.toml", "fit", Path::new(""))?;
        file.plan(file.planned(until, 100)?, &AtomicBool::new(false), &mut |_| {})
    }

    /// The speed V* is relative to the static coefficient, which the slope of loading determines; the ratio
    /// of the coefficients has no effect before the first slip.
    const UNKNOWNS: &str =
        "unknowns = { 'friction.mu_static' = [0.3, 0.9], 'friction.r_star' = [0.5, 0.98] }\n";
    const NO_SCATTER: &str = "friction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\n";

    fn width(plan: &ExperimentPlan, experiment: usize, unknown: usize) -> f64 {
        plan.experiments[experiment].widths.as_ref().unwrap()[unknown]
    }

    #[test]
    fn a_record_of_slips_determines_what_one_that_ends_before_does_not() {
        let case = format!("{NO_SCATTER}drive.v_star = 0.1");
        let unit = slipfront_case::case::Case::parse("", "unit", "", &[])
            .unwrap()
            .scales
            .time();
        let slips = plan(&case, &format!("{} s", 100.0 * unit)).unwrap();
        assert_eq!(slips.experiments.len(), 4);
        assert!(
            width(&slips, 0, 0) < 0.1 && width(&slips, 0, 1) < 0.3,
            "{slips:?}"
        );
        assert!(!slips.in_words().contains("does not determine"));
        // The spring force 0.53 V* t reaches the static friction, 1, at 18.9.
        let rest = plan(&case, &format!("{} s", 5.0 * unit)).unwrap();
        assert!(
            width(&rest, 0, 0) < 0.1 && width(&rest, 0, 1) > UNDETERMINED,
            "{rest:?}"
        );
        let text = rest.in_words();
        assert!(text.contains("does not determine friction.r_star"), "{text}");
    }

    #[test]
    fn a_program_has_its_speeds() {
        let program = format!(
            "{NO_SCATTER}drive.program = [{{ v_star = 0.1, until_star = 60 }}, {{ v_star = 0.2 }}]\ntime.duration_star = 100"
        );
        let unit = slipfront_case::case::Case::parse("", "unit", "", &[])
            .unwrap()
            .scales
            .time();
        let found = plan(&program, &format!("{} s", 90.0 * unit)).unwrap();
        assert_eq!(found.experiments.len(), 2);
        assert!(found.in_words().contains("is not possible: `drive.program`"));
    }

    #[test]
    fn a_planned_record_has_an_end_and_values() {
        let case = format!("{NO_SCATTER}drive.v_star = 0.1");
        assert!(
            plan(&case, "0 s")
                .unwrap_err()
                .to_string()
                .contains("an end after 0")
        );
        assert!(
            plan(&case, "2 um")
                .unwrap_err()
                .to_string()
                .contains("give a time")
        );
    }
}
