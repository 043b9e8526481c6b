//! The loop: evaluate, observe, stop, step.

use crate::kernel::{Forces, reference};
use crate::observe::{CurvePoint, Peak, Scheduled};
use crate::{Model, RunError, State};

/// A run in progress.
pub struct Simulation<'m> {
    model: &'m Model,
    dt_star: f64,
    step: u64,
    state: State,
    forces: Forces,
    point: CurvePoint,
    peak: Peak,
}

/// All that can be seen of a run at one instant t_n. Forces, friction and contact are those of the update that
/// starts at t_n.
pub struct Snapshot<'a> {
    /// What never changes.
    pub model: &'a Model,
    /// n.
    pub step: u64,
    /// `t* = n dt*`.
    pub time_star: f64,
    /// Time step.
    pub dt_star: f64,
    /// Displacements at t_n, velocities half a step earlier.
    pub state: &'a State,
    /// Forces at t_n, velocities half a step later, stick and slip.
    pub forces: &'a Forces,
    /// mu* and N*.
    pub point: CurvePoint,
    /// The first peak of mu*, as far as it can be known by now.
    pub peak: Peak,
    /// Whether the run ends here.
    pub last: bool,
}

/// When a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stop {
    last_step: u64,
    after_onset: bool,
}

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopReason {
    /// The last step is done.
    End,
    /// The fall that ends the first peak of mu* was seen.
    Onset,
}

impl Stop {
    /// After `last_step` steps.
    pub fn at_step(last_step: u64) -> Self {
        Self {
            last_step,
            after_onset: false,
        }
    }

    /// As soon as the fall that ends the first peak is seen, and after `last_step` steps at the latest.
    pub fn after_onset(last_step: u64) -> Self {
        Self {
            last_step,
            after_onset: true,
        }
    }

    fn reached(&self, now: &Snapshot) -> Option<StopReason> {
        if self.after_onset && now.peak.ended {
            Some(StopReason::Onset)
        } else if now.step >= self.last_step {
            Some(StopReason::End)
        } else {
            None
        }
    }
}

impl<'m> Simulation<'m> {
    /// A slider at rest at t = 0. `dt_star` must stay below [`crate::lattice::dt_star_limit`].
    pub fn at_rest(model: &'m Model, dt_star: f64) -> Self {
        Self::from_state(model, dt_star, State::at_rest(model.lattice.n_blocks()))
    }

    /// A slider in a given state at t = 0.
    pub fn from_state(model: &'m Model, dt_star: f64, state: State) -> Self {
        let forces = Forces::zeros(model.lattice.n_blocks());
        let peak = Peak::new(model.steady_level());
        let mut simulation = Self {
            model,
            dt_star,
            step: 0,
            state,
            forces,
            point: CurvePoint::default(),
            peak,
        };
        simulation.evaluate();
        simulation
    }

    /// Steps until `stop`, showing every instant to the observers that are due, the last one included.
    ///
    /// # Errors
    /// [`RunError::NotFinite`] when the run diverges, and whatever an observer fails with.
    pub fn run(&mut self, stop: Stop, observers: &mut [Scheduled]) -> Result<StopReason, RunError> {
        loop {
            let mut now = self.snapshot();
            let reason = stop.reached(&now);
            now.last = reason.is_some();
            for observer in observers.iter_mut().filter(|o| o.due(&now)) {
                observer.observe(&now)?;
            }
            if let Some(reason) = reason {
                return Ok(reason);
            }
            self.step();
            self.check_finite()?;
        }
    }

    /// One time step: from t_n to t_n+1.
    pub fn step(&mut self) {
        reference::advance(&mut self.state, self.dt_star, &mut self.forces);
        self.step += 1;
        self.evaluate();
    }

    /// The present instant.
    pub fn snapshot(&self) -> Snapshot<'_> {
        Snapshot {
            model: self.model,
            step: self.step,
            time_star: self.time_star(),
            dt_star: self.dt_star,
            state: &self.state,
            forces: &self.forces,
            point: self.point,
            peak: self.peak,
            last: false,
        }
    }

    /// Time of the present instant: a product, so that no rounding adds up.
    pub fn time_star(&self) -> f64 {
        self.step as f64 * self.dt_star
    }

    /// Displacements now, velocities half a step ago.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The first peak of mu* as known by now.
    pub fn peak(&self) -> Peak {
        self.peak
    }

    fn evaluate(&mut self) {
        let time_star = self.time_star();
        reference::evaluate(self.model, &self.state, time_star, self.dt_star, &mut self.forces);
        self.point = CurvePoint::measure(self.model, &self.state, &self.forces, time_star);
        self.peak.watch(self.step, time_star, self.point.mu_star);
    }

    /// One sum tells for all blocks: a single displacement that is not finite spoils mu*.
    fn check_finite(&self) -> Result<(), RunError> {
        if self.point.mu_star.is_finite() && self.point.mu_lateral_star.is_finite() {
            return Ok(());
        }
        let u = &self.state.displacement;
        let finite = |b: usize| u.x[b].is_finite() && u.y[b].is_finite();
        let block = (0..u.len()).find(|&b| !finite(b)).unwrap_or(0);
        let value = if u.x[block].is_finite() {
            u.y[block]
        } else {
            u.x[block]
        };
        let (i, j) = self.model.lattice.column_row(block);
        Err(RunError::NotFinite {
            step: self.step,
            time_star: self.time_star(),
            i,
            j,
            value,
        })
    }
}
