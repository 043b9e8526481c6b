//! A study of the paper, its results by the levels of its axes, and the cases of its runs.

use slipfront::Stop;

use crate::error::PaperError;
use crate::number::{MeasuredNumber, values};
use slipfront_case::case::Case;
use slipfront_study::{Plan, RetainRuns, Role, RunKey, RunQuantity, StudyResults};

pub(super) struct ParameterSweep {
    pub(super) plan: Plan,
    pub(super) results: StudyResults,
}

impl ParameterSweep {
    /// Numbers of an axis; on an axis of names, the positions of its levels.
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

    /// Position of the point with these levels.
    pub(super) fn point(&self, levels: &[usize]) -> usize {
        let axes = self.plan.axes.iter().zip(levels);
        axes.fold(0, |index, (axis, level)| index * axis.levels.len() + level)
    }

    /// A quantity at the point with these levels: one value for each surface.
    pub(super) fn values(&self, levels: &[usize], quantity: &str) -> Vec<f64> {
        let (point, quantity) = (self.point(levels), RunQuantity::named(quantity));
        let replicates = 0..self.results.points[point].replicates;
        let values = replicates.map(|replicate| self.results.value(point, replicate, quantity?));
        values.flatten().collect()
    }

    /// Mean and interval of a quantity over the surfaces of a point.
    pub(super) fn number(&self, levels: &[usize], quantity: &str) -> MeasuredNumber {
        MeasuredNumber::from_values(&self.values(levels, quantity))
    }

    /// Mean and interval of a quantity along the first axis, at these levels of the other axes.
    pub(super) fn numbers(&self, others: &[usize], quantity: &str) -> Vec<MeasuredNumber> {
        (0..self.plan.axes[0].levels.len())
            .map(|level| self.number(&[&[level], others].concat(), quantity))
            .collect()
    }

    /// Means of a quantity along the first axis, at these levels of the other axes.
    pub(super) fn means(&self, others: &[usize], quantity: &str) -> Vec<f64> {
        values(&self.numbers(others, quantity))
    }

    /// The level of the first axis with this number; the first if none has it.
    pub(super) fn level(&self, number: f64) -> usize {
        self.axis(0)
            .iter()
            .position(|&other| other == number)
            .unwrap_or(0)
    }

    /// The case of a run of a point, to be run to its end with its curve and fields.
    pub(super) fn case(&self, levels: &[usize], replicate: usize) -> Result<Case, PaperError> {
        self.case_of(RunKey {
            point: self.point(levels),
            replicate,
            role: Role::Point,
        })
    }

    /// The case of a run, to be run to its end with its curve and fields.
    pub(super) fn case_of(&self, run: RunKey) -> Result<Case, PaperError> {
        // A plan that keeps its runs gives their cases with curves and fields.
        let mut plan = self.plan.clone();
        plan.settings.keep = RetainRuns::All;
        let mut case = plan.case(run, &mut |_| true)?;
        case.name = format!("{}, {}", plan.name, plan.describe(&plan.points[run.point]));
        // Maps are scaled by the largest contact stress of the run, which may occur late.
        case.time_plan.stop = Stop::at_step(case.time_plan.last_step);
        Ok(case)
    }

    /// The runs of the first `replicates` of all points, without references, by replicate and then by point.
    pub(super) fn keys(&self, replicates: usize) -> Vec<RunKey> {
        let points = 0..self.plan.points.len();
        let replicates = 0..self.plan.settings.max_replicates().min(replicates);
        let keys = replicates.flat_map(|replicate| {
            let key = move |point| RunKey {
                point,
                replicate,
                role: Role::Point,
            };
            points.clone().map(key)
        });
        keys.collect()
    }

    /// The cases of each level of the only axis, on the first surface.
    pub(super) fn first_cases(&self) -> Result<Vec<Case>, PaperError> {
        (0..self.plan.axes[0].levels.len())
            .map(|level| self.case(&[level], 0))
            .collect()
    }

    pub(super) fn cases(&self, levels: &[usize]) -> Result<Vec<Case>, PaperError> {
        (0..self.plan.settings.max_replicates())
            .map(|replicate| self.case(levels, replicate))
            .collect()
    }
}
