//! The loop: evaluate, observe, stop, step.

use serde::{Deserialize, Serialize};

use crate::checkpoint::{Checkpoint, Numbers};
use crate::kernel::{Block, Engine, Execution, Held, Totals};
use crate::observe::{CurvePoint, Peak, Scheduled};
use crate::{Model, RunError, State, VectorField};

/// A run in progress.
pub struct Simulation<'m> {
    model: &'m Model,
    dt_star: f64,
    step: u64,
    engine: Engine,
    totals: Totals,
    point: CurvePoint,
    peak: Peak,
    /// Whether observers have seen the present step.
    shown: bool,
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
    /// Sums over all blocks.
    pub totals: Totals,
    /// mu* and N*.
    pub point: CurvePoint,
    /// The first peak of mu*, as far as it can be known by now.
    pub peak: Peak,
    /// Whether the run ends here.
    pub last: bool,
    engine: &'a Engine,
}

/// Differences of mu* that rounding cannot make: a prediction closer than this is none.
const CLEARLY: f64 = 1e-9;

impl Snapshot<'_> {
    /// Displacement, velocity and forces of block `b`. Forces are found anew: to be asked for now and then, not at every
    /// step.
    pub fn block(&self, b: usize) -> Block {
        let mut block = [Block::default()];
        self.look(b, &mut block);
        block[0]
    }

    /// The same of blocks `first`, `first + 1`, ..., as many as there is room for: of many together it takes a tenth of the
    /// time that it takes of one by one.
    ///
    /// # Panics
    /// If the lattice has fewer.
    pub fn look(&self, first: usize, blocks: &mut [Block]) {
        self.engine
            .look(self.model, self.step, self.dt_star, first, blocks);
    }

    /// Energies held now.
    ///
    /// # Panics
    /// If nobody wanted them: see [`Observer::wants_energies`](crate::observe::Observer::wants_energies).
    pub fn held(&self) -> Held {
        self.totals
            .held
            .expect("energies are measured where an observer wants them")
    }

    /// mu* one step on, which the velocities of the blocks tell already, to rounding.
    pub(crate) fn mu_star_next(&self) -> f64 {
        let mut totals = self.totals;
        for axis in 0..2 {
            totals.displacement[axis] += self.dt_star * totals.velocity_after[axis];
        }
        let time_star = (self.step + 1) as f64 * self.dt_star;
        CurvePoint::measure(self.model, &totals, time_star).mu_star
    }

    /// Whether mu* will be higher one step on.
    pub(crate) fn rises(&self) -> bool {
        self.mu_star_next() > self.point.mu_star + CLEARLY
    }

    /// Whether mu* will be lower one step on.
    pub(crate) fn falls(&self) -> bool {
        self.mu_star_next() < self.point.mu_star - CLEARLY
    }
}

/// When a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stop {
    last_step: u64,
    after_onset: bool,
}

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StopReason {
    /// The last step is done.
    End,
    /// The fall that ends the first peak of mu* was seen.
    #[serde(rename = "after_onset")]
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

    /// Whether the next step may be the last. That mu* will have fallen can be told before.
    fn may_end(&self, now: &Snapshot) -> bool {
        now.step + 1 >= self.last_step || (self.after_onset && now.peak.ends_at(now.mu_star_next() - CLEARLY))
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
        Self::executed(model, dt_star, None, Execution::default())
    }

    /// A slider in a given state at t = 0.
    pub fn from_state(model: &'m Model, dt_star: f64, state: State) -> Self {
        Self::executed(model, dt_star, Some(state), Execution::default())
    }

    /// A slider in a given state, or at rest, computed as `execution` says.
    pub fn executed(model: &'m Model, dt_star: f64, state: Option<State>, execution: Execution) -> Self {
        let mut engine = Engine::new(model, dt_star, state, execution);
        let totals = engine.step(model, 0, true);
        let mut simulation = Self {
            model,
            dt_star,
            step: 0,
            engine,
            totals,
            point: CurvePoint::default(),
            peak: Peak::new(model.steady_level()),
            shown: false,
        };
        simulation.measure();
        simulation
    }

    /// A run that goes on from a checkpoint as if it had never been stopped, with the same bits, computed as `execution`
    /// says. None if the checkpoint is that of another lattice or another kernel.
    pub fn resume(
        model: &'m Model,
        dt_star: f64,
        checkpoint: Checkpoint,
        execution: Execution,
    ) -> Option<Self> {
        let (step, totals, peak) = (checkpoint.step, checkpoint.totals, checkpoint.peak);
        let engine = Engine::resume(model, dt_star, checkpoint, execution)?;
        Some(Self {
            model,
            dt_star,
            step,
            engine,
            totals,
            point: CurvePoint::measure(model, &totals, step as f64 * dt_star),
            peak,
            shown: true,
        })
    }

    /// What [`Simulation::resume`] needs, to be written down. Taken between two calls of [`Simulation::advance`], it goes
    /// with what the observers have seen.
    pub fn checkpoint(&self) -> Checkpoint<Numbers<'_>> {
        self.engine
            .checkpoint(self.model, self.step, self.totals, self.peak)
    }

    /// Steps until `stop`, showing every instant to the observers that are due, the last one included.
    ///
    /// # Errors
    /// [`RunError::NotFinite`] when the run diverges, and whatever an observer fails with.
    pub fn run(&mut self, stop: Stop, observers: &mut [Scheduled]) -> Result<StopReason, RunError> {
        loop {
            if let Some(reason) = self.advance(stop, u64::MAX, observers)? {
                return Ok(reason);
            }
        }
    }

    /// At most `steps` steps towards `stop`; none if it was not reached. Observers see every instant once, also where one
    /// call ends and the next begins.
    ///
    /// # Errors
    /// As for [`Simulation::run`].
    pub fn advance(
        &mut self,
        stop: Stop,
        steps: u64,
        observers: &mut [Scheduled],
    ) -> Result<Option<StopReason>, RunError> {
        let last_step = self.step.saturating_add(steps);
        loop {
            let mut now = self.snapshot();
            let reason = stop.reached(&now);
            now.last = reason.is_some();
            if !self.shown {
                for observer in observers.iter_mut().filter(|o| o.due(now.step)) {
                    observer.observe(&now)?;
                }
            }
            if reason.is_some() || now.step >= last_step {
                self.shown = true;
                return Ok(reason);
            }
            let next = now.step + 1;
            let energies = stop.may_end(&now) || observers.iter().any(|o| o.wants_energies(next));
            self.step_with(energies);
            self.check_finite()?;
        }
    }

    /// One time step: from t_n to t_n+1.
    pub fn step(&mut self) {
        self.step_with(false);
    }

    fn step_with(&mut self, energies: bool) {
        self.step += 1;
        self.shown = false;
        self.totals = self.engine.step(self.model, self.step, energies);
        self.measure();
    }

    fn measure(&mut self) {
        let time_star = self.time_star();
        self.point = CurvePoint::measure(self.model, &self.totals, time_star);
        self.peak.watch(self.step, time_star, self.point.mu_star);
    }

    /// The present instant.
    pub fn snapshot(&self) -> Snapshot<'_> {
        Snapshot {
            model: self.model,
            step: self.step,
            time_star: self.time_star(),
            dt_star: self.dt_star,
            totals: self.totals,
            point: self.point,
            peak: self.peak,
            last: false,
            engine: &self.engine,
        }
    }

    /// Time of the present instant: a product, so that no rounding adds up.
    pub fn time_star(&self) -> f64 {
        self.step as f64 * self.dt_star
    }

    /// Displacements now, velocities half a step later.
    pub fn state(&self) -> State {
        let n = self.model.lattice.n_blocks();
        let mut state = State::at_rest(n);
        let State {
            displacement,
            velocity,
        } = &mut state;
        for b in 0..n {
            let [u, v] = self.engine.motion(b);
            let set = |field: &mut VectorField, [x, y]: [f64; 2]| (field.x[b], field.y[b]) = (x, y);
            set(displacement, u);
            set(velocity, v);
        }
        state
    }

    /// The first peak of mu* as known by now.
    pub fn peak(&self) -> Peak {
        self.peak
    }

    /// t* at which each block first slid while in contact; not a number where none has.
    pub fn first_slip_time_star(&self) -> Vec<f64> {
        (0..self.model.lattice.n_blocks())
            .map(|b| self.engine.first_slip(b))
            .collect()
    }

    /// The largest contact stress (Eq. 10) over blocks in contact and all steps so far, in units of `P mu_s`: the scale of
    /// tau_c*.
    pub fn contact_stress_max(&self) -> f64 {
        self.engine.contact_stress_max(self.model, self.step)
    }

    /// One sum tells for all blocks: a single displacement that is not finite spoils mu*.
    fn check_finite(&self) -> Result<(), RunError> {
        if self.point.mu_star.is_finite() && self.point.mu_lateral_star.is_finite() {
            return Ok(());
        }
        let bad = (0..self.model.lattice.n_blocks()).find_map(|b| {
            let [u, _] = self.engine.motion(b);
            let value = u.into_iter().find(|u| !u.is_finite())?;
            Some((b, value))
        });
        let (block, value) = bad.unwrap_or((0, self.point.mu_star));
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
