//! Training: runs of the model over the ranges of the unknowns, and their curves without noise.

use slipfront_study::StudyError;

use crate::design_point::design_point;
use crate::progress::CalibrationStage;
use crate::runs::{RunMaker, Runs};
use crate::set_up::{Curves, SetUp};

/// Number of the surface of the first run.
const FIRST_SURFACE: u64 = 1;

/// Curves of runs over the ranges of the unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct Training {
    /// Shares of the ranges, for every run.
    pub(crate) points: Vec<Vec<f64>>,
    /// Curves of every run.
    pub(crate) curves: Vec<Curves>,
}

impl Training {
    /// Makes runs at points over the ranges, each on its own surface.
    ///
    /// # Errors
    /// When a run cannot be made or kept, and after a stop.
    pub fn run(
        maker: &mut RunMaker,
        stage: CalibrationStage,
        set_up: &SetUp,
        runs: usize,
    ) -> Result<Self, StudyError> {
        let points: Vec<Vec<f64>> = (0..runs)
            .map(|run| design_point(run, set_up.unknowns.len()))
            .collect();
        let curves = maker.curves(stage, &Runs::new(set_up, &points, FIRST_SURFACE))?;
        Ok(Self { points, curves })
    }

    /// Adds the curves of the same runs under further conditions.
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
    use std::sync::atomic::AtomicBool;

    use slipfront_case::case::Case;
    use slipfront_case::case_file::Override;
    use slipfront_run::measured::{Measure, MeasuredRecord};

    use super::*;
    use crate::sample_points::SamplePoints;
    use crate::set_up::Conditions;
    use slipfront_study::StudyFile;
    use slipfront_study::Unknown;

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
                grid: SamplePoints::from_record(&record).unwrap(),
            }
        });
        SetUp {
            base,
            unknowns,
            conditions: conditions.into(),
            instrument: None,
            is_finer: false,
            halvings: 0,
        }
    }

    /// A training on `threads` threads.
    fn trained(set_up: &SetUp, threads: usize) -> Result<Training, StudyError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let go_on = AtomicBool::new(false);
        pool.install(|| {
            let (mut watch, stage) = (|_: &_| {}, CalibrationStage::Training);
            Training::run(&mut RunMaker::new(&go_on, 6, &mut watch), stage, set_up, 6)
        })
    }

    #[test]
    fn threads_do_not_change_a_bit() {
        let set_up = set_up([0.4, 0.8], 5.0);
        let one = trained(&set_up, 1).unwrap();
        assert_eq!(one, trained(&set_up, 3).unwrap());
        assert_eq!(one.curves[0].len(), 2);
        assert!(one.curves[0] != one.curves[1] && one.curves[0][0] != one.curves[0][1]);
    }

    #[test]
    fn what_cannot_be_run_is_told_with_its_unknowns() {
        let message = |set_up: &SetUp| trained(set_up, 1).unwrap_err().to_string();
        // A program of speeds limits the path of the drive by the duration of its case.
        let mut short = set_up([0.5, 1.0], 50.0);
        for conditions in &mut short.conditions {
            let program = "drive.program=[{ v_star = 0.1, until_star = 50 }, { v_star = 0.2 }]";
            conditions.overrides = vec![Override::parse(program).unwrap()];
        }
        assert!(
            message(&short).contains("the run ends before record 1"),
            "{}",
            message(&short)
        );
        let out_of_bounds = message(&set_up([-3.0, -2.0], 5.0));
        assert!(
            out_of_bounds.starts_with("the unknowns friction.r_star=-2."),
            "{out_of_bounds}"
        );
    }

    #[test]
    fn a_training_is_given_up_when_it_is_told_so() {
        let stop = AtomicBool::new(true);
        let (mut watch, stage) = (|_: &_| {}, CalibrationStage::Training);
        let mut maker = RunMaker::new(&stop, 6, &mut watch);
        let ended = Training::run(&mut maker, stage, &set_up([0.4, 0.8], 5.0), 6);
        assert!(matches!(ended, Err(StudyError::Interrupted)));
    }
}
