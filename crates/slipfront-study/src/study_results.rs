//! Results of a study: of every run, and of every point.

use std::collections::BTreeMap;

use crate::error::StudyError;
use crate::finished_run::RunResult;
use crate::plan::{Plan, Role, RunKey};
use crate::statistics::Sample;
use crate::summary_values::{REDUCTION, RunQuantity, needs_transition, reduction_percent};

/// Progress of a study.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Progress {
    /// Number of runs done, including those of earlier processes.
    pub done: usize,
    /// Number of runs that are known to be needed; it grows while intervals are too wide.
    pub total: usize,
    /// Number of runs that this process has done.
    pub here: usize,
    /// Failed runs.
    pub failed: usize,
    /// The largest half width of an interval so far, for the quantity that decides on replication.
    pub worst: Option<f64>,
}

/// The results of a study.
#[derive(Clone, Debug, Default)]
pub struct StudyResults {
    /// The result of every run in the tables.
    pub runs: BTreeMap<RunKey, RunResult>,
    /// The result of each point of the plan.
    pub points: Vec<PointResult>,
    /// Number of recorded runs that are not part of the present study.
    pub orphaned_runs: usize,
}

/// Replication of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PointResult {
    /// Number of replicates in the tables.
    pub replicates: usize,
    /// Whether the confidence interval is as narrow as the study requires; none without such a requirement.
    pub narrow: Option<bool>,
}

impl StudyResults {
    /// A quantity of a replicate of a point. A reduction is against the reference of the same seed.
    pub fn value(&self, point: usize, replicate: usize, quantity: RunQuantity) -> Option<f64> {
        let values = |role| {
            let run = RunKey {
                point,
                replicate,
                role,
            };
            self.runs.get(&run)?.as_ref().ok()
        };
        match quantity {
            RunQuantity::Number(position) => values(Role::Point)?.get(position),
            RunQuantity::Reduction => reduction_percent(values(Role::Point)?, values(Role::Reference)?),
        }
    }

    /// Statistics of a quantity at the point at `position` of the plan; none if no run has a value.
    pub fn sample(&self, plan: &Plan, position: usize, name: &str) -> Option<Sample> {
        let quantity = RunQuantity::named(name)?;
        let replicates = 0..self.points.get(position)?.replicates;
        let values: Vec<f64> = replicates
            .filter_map(|replicate| self.value(position, replicate, quantity))
            .collect();
        Sample::from_values(&values, plan.settings.confidence())
    }

    /// Runs without a transition, which have no static friction and no reduction.
    pub fn without_transition(&self) -> impl Iterator<Item = RunKey> {
        self.runs
            .keys()
            .copied()
            .filter(|run| self.is_without_transition(*run))
    }

    /// Number of replicates of the point at `position` of the plan for which a quantity is missing because
    /// its run has no transition: the run of the point or, for a reduction, its reference. For quantities
    /// that do not need a transition, it is the number of runs of the point without one.
    pub fn runs_without_transition(&self, position: usize, name: &str) -> usize {
        let replicates = self.points.get(position).map_or(0, |point| point.replicates);
        let roles = if name == REDUCTION {
            &[Role::Point, Role::Reference][..]
        } else {
            &[Role::Point]
        };
        let is_without = |replicate: usize| {
            let run = |role: &Role| RunKey {
                point: position,
                replicate,
                role: *role,
            };
            roles.iter().any(|role| self.is_without_transition(run(role)))
        };
        (0..replicates).filter(|replicate| is_without(*replicate)).count()
    }

    fn is_without_transition(&self, run: RunKey) -> bool {
        let result = self.runs.get(&run);
        result.is_some_and(|result| result.as_ref().is_ok_and(|values| !values.transition))
    }

    /// Failed runs and the reasons.
    pub fn failures(&self) -> impl Iterator<Item = (RunKey, &str)> {
        let runs = self.runs.iter();
        runs.filter_map(|(run, result)| Some((*run, result.as_ref().err()?.as_str())))
    }

    /// Refuses results with failed runs, and names the first.
    ///
    /// # Errors
    /// A sentence with the number of failed runs, and the reason of the first.
    pub fn expect_no_failures(&self, plan: &Plan) -> Result<(), StudyError> {
        let Some((run, reason)) = self.failures().next() else {
            return Ok(());
        };
        Err(StudyError::Failed {
            failed: self.failures().count(),
            runs: self.runs.len(),
            replicate: run.replicate,
            point: plan.describe(&plan.points[run.point]),
            reason: reason.to_owned(),
        })
    }

    /// Refuses results if no run has a value of the main quantity of the study.
    ///
    /// # Errors
    /// A sentence with the quantity.
    pub fn expect_values(&self, plan: &Plan) -> Result<(), StudyError> {
        let quantity = plan.main_quantity();
        if (0..plan.points.len()).any(|position| self.sample(plan, position, quantity).is_some()) {
            return Ok(());
        }
        Err(StudyError::NoValue {
            quantity: quantity.to_owned(),
            needs_transition: needs_transition(quantity),
        })
    }
}
