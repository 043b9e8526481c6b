//! Training: runs of the model over the ranges of the unknowns, with their curves without noise.

use std::collections::HashMap;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::set_up::{Curves, SetUp};
use crate::unknowns::design_point;
use slipfront_study::{StudyError, TrainingError};

/// Number of runs that are made before they are kept and shown.
pub(crate) const AT_ONCE: usize = 32;

/// A run of a training.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrainingRun {
    /// Number of the run.
    pub run: usize,
    /// Friction of every record.
    pub curves: Curves,
}

/// Function that takes runs that have ended, in their order.
pub type KeepRuns<'a> = dyn FnMut(&[TrainingRun]) -> Result<(), StudyError> + 'a;

/// Curves of runs over the ranges of the unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct Training {
    /// Shares of the ranges, for every run.
    pub(crate) points: Vec<Vec<f64>>,
    /// Curves of every run.
    pub(crate) curves: Vec<Curves>,
}

impl Training {
    /// Runs the points of the ranges that are not `known`, each over a surface of its own, on rayon's
    /// threads; `keep` gets the runs as they end.
    ///
    /// # Errors
    /// The error of the first run that has one, errors of `keep`, and after a stop.
    pub fn run(
        set_up: &SetUp,
        runs: usize,
        mut known: HashMap<usize, Curves>,
        keep: &mut KeepRuns,
        stop: &AtomicBool,
    ) -> Result<Self, StudyError> {
        let points: Vec<Vec<f64>> = (0..runs)
            .map(|run| design_point(run, set_up.unknowns.len()))
            .collect();
        let missing: Vec<usize> = (0..runs).filter(|run| !known.contains_key(run)).collect();
        for some in missing.chunks(AT_ONCE) {
            let made: Vec<Result<Option<TrainingRun>, TrainingError>> = some
                .par_iter()
                .with_max_len(1)
                .map(|&run| {
                    let curves = set_up.curves(&points[run], 1 + run as u64, stop)?;
                    Ok(curves.map(|curves| TrainingRun { run, curves }))
                })
                .collect();
            let made: Option<Vec<TrainingRun>> = made.into_iter().collect::<Result<_, _>>()?;
            let made = made.ok_or(StudyError::Interrupted)?;
            keep(&made)?;
            known.extend(made.into_iter().map(|made| (made.run, made.curves)));
        }
        let curves = (0..runs).filter_map(|run| known.remove(&run)).collect();
        Ok(Self { points, curves })
    }

    /// Adds the curves that the runs of the training have under further conditions.
    pub(crate) fn with(mut self, further: Self) -> Self {
        for (curves, more) in self.curves.iter_mut().zip(further.curves) {
            curves.extend(more);
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use slipfront_case::case::Case;
    use slipfront_case::case_file::Override;
    use slipfront_run::measured::{Measure, MeasuredRecord};

    use super::*;
    use crate::sample_points::SamplePoints;
    use crate::set_up::Conditions;
    use crate::unknowns::Unknown;
    use slipfront_study::StudyFile;

    /// A set-up with two speeds of a small slider, along a path of the drive in units of length.
    fn set_up(range: [f64; 2], path: f64) -> SetUp {
        let text = "base.slider.blocks = [6, 6]\nbase.time.duration_star = 60\nbase.drive.v_star = 0.1";
        let base = StudyFile::parse(text, "base", "base", Path::new(""))
            .unwrap()
            .base;
        let unknowns = vec![Unknown::new("friction.r_star", range[0], range[1], false).unwrap()];
        let unit = Case::parse("", "unit", "", &[]).unwrap().scales.displacement();
        let conditions = [0.1, 0.2].map(|speed| {
            let x: Vec<f64> = (0..50).map(|k| path * unit * f64::from(k) / 49.0).collect();
            let record = MeasuredRecord::new(x.clone(), x, Measure::Displacement, Measure::Force);
            Conditions {
                overrides: vec![Override::new("drive.v_star", &toml::Value::from(speed))],
                grid: SamplePoints::of(&record).unwrap(),
            }
        });
        SetUp {
            base,
            unknowns,
            conditions: conditions.into(),
            instrument: None,
            is_finer: false,
            has_half_step: false,
        }
    }

    /// A training on `threads` threads, of which these runs are known.
    fn trained(
        set_up: &SetUp,
        threads: usize,
        known: HashMap<usize, Curves>,
    ) -> Result<(Training, Vec<TrainingRun>), StudyError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let mut kept = Vec::new();
        let mut keep = |runs: &[TrainingRun]| {
            kept.extend_from_slice(runs);
            Ok(())
        };
        let go_on = AtomicBool::new(false);
        let trained = pool.install(|| Training::run(set_up, 6, known, &mut keep, &go_on));
        Ok((trained?, kept))
    }

    #[test]
    fn threads_and_keeping_do_not_change_a_bit() {
        let set_up = set_up([0.4, 0.8], 5.0);
        let (one, kept) = trained(&set_up, 1, HashMap::new()).unwrap();
        assert_eq!(one, trained(&set_up, 3, HashMap::new()).unwrap().0);
        assert_eq!(one.curves[0].len(), 2);
        assert!(one.curves[0] != one.curves[1] && one.curves[0][0] != one.curves[0][1]);
        // Runs that are known are not made again.
        let some = kept.into_iter().step_by(2).map(|run| (run.run, run.curves));
        let (resumed, made) = trained(&set_up, 3, some.collect()).unwrap();
        assert_eq!(made.iter().map(|run| run.run).collect::<Vec<_>>(), [1, 3, 5]);
        assert_eq!(resumed, one);
    }

    #[test]
    fn what_cannot_be_run_is_told_with_its_unknowns() {
        let told = |set_up: &SetUp| trained(set_up, 1, HashMap::new()).unwrap_err().to_string();
        // A program of speeds moves the drive as far as its case runs.
        let mut short = set_up([0.5, 1.0], 50.0);
        for conditions in &mut short.conditions {
            let program = "drive.program=[{ v_star = 0.1, until_star = 50 }, { v_star = 0.2 }]";
            conditions.overrides = vec![Override::parse(program).unwrap()];
        }
        assert!(
            told(&short).contains("the run ends before record 1 does"),
            "{}",
            told(&short)
        );
        let out_of_bounds = told(&set_up([-3.0, -2.0], 5.0));
        assert!(
            out_of_bounds.starts_with("the unknowns friction.r_star=-2."),
            "{out_of_bounds}"
        );
    }

    #[test]
    fn a_training_is_given_up_when_it_is_told_so() {
        let stop = AtomicBool::new(true);
        let ended = Training::run(
            &set_up([0.4, 0.8], 5.0),
            6,
            HashMap::new(),
            &mut |_| Ok(()),
            &stop,
        );
        assert!(matches!(ended, Err(StudyError::Interrupted)));
    }
}
