//! Runs of the chapters.

use std::sync::Arc;

use slipfront::observe::{Curve, CurveRow, Scheduled};
use slipfront::{Model, Simulation, State, Stop};
use slipfront_case::case::Case;

use crate::error::PaperError;

/// A run that has ended.
pub(super) struct Run {
    /// As it stands at the end.
    pub(super) simulation: Simulation,
    /// Every step.
    pub(super) rows: Vec<CurveRow>,
    pub(super) model: Arc<Model>,
}

impl Run {
    /// Of a case: what a user would write.
    pub(super) fn of_case(name: &str, text: &str) -> Result<Self, PaperError> {
        let case = Case::parse(text, name, &[])?;
        let plan = &case.time_plan;
        Self::of_model(name, Arc::clone(&case.model), plan.dt_star, None, plan.last_step)
    }

    /// Of a slider that no case describes.
    pub(super) fn of_model(
        name: &str,
        model: Arc<Model>,
        dt_star: f64,
        state: Option<State>,
        last_step: u64,
    ) -> Result<Self, PaperError> {
        let execution = slipfront::Execution::default();
        let mut simulation = Simulation::with_execution(Arc::clone(&model), dt_star, state, execution);
        let mut curve = Curve::every(1);
        let done = simulation.run(Stop::at_step(last_step), &mut [Scheduled::always(&mut curve)]);
        done.map_err(|source| PaperError::Run {
            name: name.to_owned(),
            source,
        })?;
        Ok(Self {
            simulation,
            rows: curve.rows,
            model,
        })
    }

    /// When the first block slipped; NaN if none has.
    pub(super) fn first_slip(&self) -> f64 {
        self.simulation
            .snapshot()
            .earliest_first_slip()
            .unwrap_or(f64::NAN)
    }

    /// The largest mu* of the run.
    pub(super) fn largest(&self) -> f64 {
        self.simulation.peak().mu_star_max
    }
}
