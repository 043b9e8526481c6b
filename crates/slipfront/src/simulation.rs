//! The main loop of a run: evaluate, observe, stop, step.

use std::sync::Arc;

use crate::checkpoint::{BlockColumn, Checkpoint};
use crate::clock::{Clock, Rest};
use crate::communicator::{Alone, Communicator, lowest_rank};
use crate::device::{Device, DeviceError, DeviceLattice};
use crate::error::RunError;
use crate::friction::ContactTotals;
use crate::kernel::engine::Engine;
use crate::kernel::execution::Execution;
use crate::kernel::replay::Replay;
use crate::measure::{CurvePoint, Peak};
use crate::model::Model;
use crate::observe::observer::Scheduled;
use crate::snapshot::Snapshot;
use crate::state::State;
use crate::stop::{Stop, StopReason};
use crate::totals::Totals;
use slipfront_kernel::Integrator;

/// Largest number of steps under a held drive, where the number is not known in advance: the fused kernel
/// stores step numbers in 32 bits.
const MAX_HELD_STEPS: u64 = u32::MAX as u64 - 1;

/// Ratio of force to mean static strength below which blocks count as at rest, if exact rest never comes. It
/// is less than the rise of mu* in one step of a held drive, 3.75e-4 at V* = 0.01 and dt* = 0.1, which limits
/// the accuracy of mu_s*.
const FORCE_AT_REST: f64 = 1e-4;

/// Ratio of the excess of the force on a block over its strength to the largest strength of a block, below
/// which the blocks of a bulk body count as at rest.
const EXCESS_AT_REST: f64 = 3e-4;

/// A run in progress.
pub struct Simulation {
    model: Arc<Model>,
    clock: Clock,
    engine: Box<dyn Engine>,
    communicator: Arc<dyn Communicator>,
    totals: Totals,
    contact: ContactTotals,
    point: CurvePoint,
    peak: Peak,
    /// Largest static threshold of a block.
    largest_strength: f64,
    /// Whether observers have seen the present step.
    observed: bool,
}

impl Simulation {
    /// A slider at t = 0 in a given state, or at rest, computed with the options of `execution`. `dt_star`
    /// must stay below [`crate::lattice::dt_star_limit`]. All ranks that share a lattice must call this and
    /// then the same functions, each with a model of its own rows and the state of their blocks.
    ///
    /// # Panics
    /// If a displacement or velocity of the state is not finite.
    pub fn new(
        model: impl Into<Arc<Model>>,
        dt_star: f64,
        state: Option<State>,
        execution: Execution,
    ) -> Self {
        let model = model.into();
        assert!(
            state.as_ref().is_none_or(State::is_finite),
            "a displacement or velocity of the state to begin with is not finite"
        );
        let communicator = Arc::clone(&execution.communicator);
        let engine = execution.begin(&model, dt_star, state);
        Self::begin(model, dt_star, engine, communicator)
    }

    /// A slider at t = 0 with steps that a [`Device`](crate::device::Device) computes: at least the first
    /// step of the `lattice` must have been recorded. Each further step must be recorded before it is made,
    /// see [`device_lattice`](Self::device_lattice). Values of single blocks, except first-slip times, and
    /// checkpoints are available only at the step at which the device has stopped.
    ///
    /// # Panics
    /// If no step was recorded, or its energies were not.
    pub fn replay(lattice: DeviceLattice) -> Self {
        let (model, dt_star) = (Arc::clone(&lattice.model), lattice.equations.dt_star);
        let engine = Box::new(Replay::new(lattice));
        Self::begin(model, dt_star, engine, Arc::new(Alone))
    }

    /// The lattice that a device advances by further steps, for a run that [replays](Self::replay) them.
    pub fn device_lattice(&mut self) -> Option<&mut DeviceLattice> {
        self.engine.device_lattice()
    }

    /// The [device](Execution::device) that computes the steps, or computed them until it failed.
    pub fn device(&self) -> Option<&dyn Device> {
        self.engine.device()
    }

    /// Whether a held drive has waited for so long that negligible forces count as rest.
    /// A device that records steps in advance does not know this.
    pub fn rests_by_force(&self) -> bool {
        self.clock.rest != Rest::Exact
    }

    /// The failure of the [device](Execution::device) that computed the first steps, if the CPU computes the
    /// others: with the same bits, but more slowly.
    pub fn device_failure(&self) -> Option<&DeviceError> {
        self.engine.device_failure()
    }

    /// Makes the first step.
    fn begin(
        model: Arc<Model>,
        dt_star: f64,
        mut engine: Box<dyn Engine>,
        communicator: Arc<dyn Communicator>,
    ) -> Self {
        let clock = Clock::start(dt_star);
        let totals = engine.step(&model, &clock, true);
        let mut simulation = Self {
            peak: Peak::new(&model, model.steady_level(&*communicator)),
            largest_strength: largest_strength(&model),
            model,
            clock,
            engine,
            communicator,
            totals,
            contact: ContactTotals::default(),
            point: CurvePoint::default(),
            observed: false,
        };
        if simulation.model.rests_by_excess() {
            simulation.clock.rest = simulation.rest(0.0);
        }
        simulation.measure();
        simulation
    }

    /// A run that continues from a checkpoint, with the same bits as an uninterrupted run, computed with the
    /// options of `execution`. `read` receives the number of a column, the first block, and room for the
    /// values from this block on. None if another kernel wrote the checkpoint. All ranks that share a lattice
    /// must call this together, each for the blocks of its rows.
    ///
    /// # Errors
    /// Any error of `read`.
    pub fn resume<E>(
        model: impl Into<Arc<Model>>,
        dt_star: f64,
        checkpoint: &Checkpoint,
        execution: Execution,
        read: impl FnMut(usize, usize, &mut [f64]) -> Result<(), E>,
    ) -> Result<Option<Self>, E> {
        let model = model.into();
        let (clock, totals, peak) = (checkpoint.clock(dt_star), checkpoint.totals, checkpoint.peak);
        let communicator = Arc::clone(&execution.communicator);
        let engine = execution.resume(&model, dt_star, checkpoint, read)?;
        Ok(engine.map(|engine| Self {
            point: CurvePoint::measure(&model, &totals, clock.drive_time_star()),
            largest_strength: largest_strength(&model),
            model,
            clock,
            engine,
            communicator,
            totals,
            contact: checkpoint.contact,
            peak,
            observed: true,
        }))
    }

    /// The state that [`Simulation::resume`] needs in addition to the [columns](Self::write_columns). A
    /// checkpoint taken between two calls of [`Simulation::advance`] matches the recordings of the observers
    /// at that time. All ranks must call this together.
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            step: self.clock.step,
            drive_steps: self.clock.drive_steps,
            standing: self.clock.standing,
            rest: self.clock.rest,
            totals: self.totals,
            contact: self.contact,
            peak: self.peak,
            stress_square_max: self.engine.stress_square_max(&self.model, &self.clock),
            motion_bounds: self.engine.motion_bounds(),
        }
    }

    /// Writes the values of all blocks that [`Simulation::resume`] reads, part by part: `write` receives the
    /// number of the column, the first block, and the values. The columns are [`BlockColumn::ALL`] and those
    /// of the law of friction, in total [`Model::n_columns`].
    ///
    /// # Errors
    /// Errors of `write`.
    pub fn write_columns<E>(
        &self,
        mut write: impl FnMut(usize, usize, &[f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        let engine = &*self.engine;
        BlockColumn::for_each_part(&self.model, |number, column, first, values| {
            engine.read_column(self.time_star(), column, first, values);
            write(number, first, values)
        })
    }

    /// Steps until `stop`, and calls the observers that are due at every instant, including the last. All
    /// ranks must call this together, with observers that need energies at the same steps.
    ///
    /// # Errors
    /// [`RunError::NotFinite`] when the run diverges, and any error of an observer.
    pub fn run(&mut self, stop: Stop, observers: &mut [Scheduled]) -> Result<StopReason, RunError> {
        loop {
            if let Some(reason) = self.advance(stop, u64::MAX, observers)? {
                return Ok(reason);
            }
        }
    }

    /// Makes at most `steps` steps towards `stop`; returns none if it was not reached. Observers see every
    /// instant once, also between two calls. All ranks must call this together, as for [`Simulation::run`].
    ///
    /// # Errors
    /// As for [`Simulation::run`].
    pub fn advance(
        &mut self,
        stop: Stop,
        steps: u64,
        observers: &mut [Scheduled],
    ) -> Result<Option<StopReason>, RunError> {
        let last_step = self.clock.step.saturating_add(steps);
        loop {
            self.check()?;
            let mut now = self.snapshot();
            let reason = stop.reached(&now);
            now.last = reason.is_some();
            if !self.observed {
                for observer in observers.iter_mut().filter(|o| o.due(&now.clock)) {
                    observer.observe(&now)?;
                }
            }
            if reason.is_some() || now.step >= last_step {
                self.observed = true;
                return Ok(reason);
            }
            let next = now.next_clock();
            let energies = stop.may_end(&now) || observers.iter().any(|o| o.needs_energies(&next));
            self.step_with(energies);
        }
    }

    /// Makes one time step, from t_n to t_n+1, which all ranks must take together. Divergence is not checked.
    pub fn step(&mut self) {
        self.step_with(false);
    }

    fn step_with(&mut self, energies: bool) {
        self.clock = self.snapshot().next_clock();
        self.observed = false;
        let speed_square_before = self.totals.velocity_square;
        self.totals = self.engine.step(&self.model, &self.clock, energies);
        self.clock.rest = self.rest(speed_square_before);
        self.measure();
    }

    /// Criterion of rest for a held drive from this step on: by force, once the drive has stood still for so
    /// long that it would wait forever for blocks that hardly move, and in all later steps.
    fn rest(&self, speed_square_before: f64) -> Rest {
        if self.model.rests_by_excess() {
            let at_rest = self.engine.speed_square_max() <= self.rest_speed().powi(2);
            return Rest::ByForce { at_rest };
        }
        if self.clock.rest == Rest::Exact && !self.stands_too_long() {
            return Rest::Exact;
        }
        let at_rest = self.force_of_motion(speed_square_before.sqrt())
            < FORCE_AT_REST * self.model.surface.mean_static_force();
        match self.clock.rest {
            Rest::Exact if !at_rest => Rest::Exact,
            _ => Rest::ByForce { at_rest },
        }
    }

    /// Speed that the largest excess of force over strength at rest gives a block in a step.
    fn rest_speed(&self) -> f64 {
        let integrator = Integrator::new(self.model.damping, self.clock.dt_star);
        EXCESS_AT_REST * self.largest_strength * integrator.force_to_velocity
    }

    /// The residual force that keeps the blocks moving, springs less friction, from the balance of power: the
    /// force that changes their speed and balances the drag of damping and dampers, plus the force that would
    /// stop them. For one block that creeps with strong damping this is `|F| - f`; for many blocks it is the
    /// root of the sum of squares.
    ///
    /// ```text
    /// |dv/dt| + Omega v + P_viscous/v + max(1, k_s^(1/2)) v,   v = (sum m v_i^2)^(1/2)
    /// ```
    ///
    /// The last term is for blocks that oscillate and pass the middle, where no net force acts: it is the
    /// largest force of their springs, of stiffness 1 and k_s, in the oscillation with this speed at the
    /// middle.
    fn force_of_motion(&self, speed_before: f64) -> f64 {
        let (model, speed) = (&self.model, self.totals.velocity_square.sqrt());
        if speed == 0.0 {
            return 0.0;
        }
        let rate = model.damping + model.drive.k_drive.sqrt().max(1.0);
        let change = (speed - speed_before).abs() / self.clock.dt_star;
        change + rate * speed + self.engine.viscous_power() / speed
    }

    /// Whether the drive has stood still for longer than any slip lasts.
    fn stands_too_long(&self) -> bool {
        let standing = self.clock.standing;
        // Other drives never stand still, and their steps need no limit.
        standing > 0 && standing as f64 * self.clock.dt_star > self.model.longest_stop()
    }

    fn measure(&mut self) {
        self.contact = self.engine.contact_totals(&self.model);
        self.point = CurvePoint::measure(&self.model, &self.totals, self.clock.drive_time_star());
        let counts = !self.model.rests_by_excess() || self.is_at_rest();
        self.peak.update(&self.clock, &self.point, counts);
        if self.totals.n_slipping > 0 {
            let drive_time_star = self.clock.drive_time_star();
            self.peak
                .first_slip_drive_time_star
                .get_or_insert(drive_time_star);
        }
    }

    /// Whether a held drive takes the blocks for at rest at the present instant.
    pub(crate) fn is_at_rest(&self) -> bool {
        self.snapshot().next_clock().drive_moved()
    }

    /// The present instant.
    pub fn snapshot(&self) -> Snapshot<'_> {
        Snapshot {
            model: &self.model,
            step: self.clock.step,
            drive_steps: self.clock.drive_steps,
            time_star: self.time_star(),
            drive_time_star: self.clock.drive_time_star(),
            dt_star: self.clock.dt_star,
            clock: self.clock,
            totals: self.totals,
            contact: self.contact,
            point: self.point,
            peak: self.peak,
            last: false,
            engine: &*self.engine,
            communicator: &*self.communicator,
        }
    }

    /// Time of the present instant: step times time step, so that no rounding errors add up.
    pub fn time_star(&self) -> f64 {
        self.clock.time_star()
    }

    /// Displacements now, velocities half a step later.
    pub fn state(&self) -> State {
        self.engine.state(self.model.surface.n_blocks())
    }

    /// The first peak of mu* found so far.
    pub fn peak(&self) -> Peak {
        self.peak
    }

    /// The largest contact stress (Eq. 10) over blocks in contact and all steps so far, in units of `P mu_s`:
    /// the scale of tau_c*. All ranks must call this together.
    pub fn contact_stress_max(&self) -> f64 {
        self.engine.stress_square_max(&self.model, &self.clock).sqrt()
    }

    /// First-slip times t* of the blocks of this rank while in contact; NaN for blocks that have not slipped.
    /// Ends the run and reuses its memory for the times.
    pub fn into_first_slip_time_star(self) -> Vec<f64> {
        self.engine.into_first_slips()
    }

    /// Checks that the run can go on.
    pub(crate) fn check(&self) -> Result<(), RunError> {
        self.check_finite()?;
        self.check_standing()
    }

    /// Checks that the run does not diverge. Sums of squares of speeds show divergence first, because they
    /// overflow long before displacements do.
    fn check_finite(&self) -> Result<(), RunError> {
        let (point, totals) = (&self.point, &self.totals);
        let stored = totals.stored_energy.unwrap_or_default().total();
        let sums = [
            point.mu_star,
            point.mu_lateral_star,
            totals.velocity_square,
            totals.friction_power,
            stored,
        ];
        if sums.into_iter().all(f64::is_finite) {
            return Ok(());
        }
        let (block, value) = self.largest_displacement();
        let (i, j) = self.model.lattice.column_row(block);
        Err(RunError::NotFinite {
            step: self.clock.step,
            time_star: self.time_star(),
            i,
            j,
            value,
        })
    }

    /// Checks that the slider comes to rest, since otherwise a held drive would stand still forever.
    fn check_standing(&self) -> Result<(), RunError> {
        let Clock { step, standing, .. } = self.clock;
        if self.stands_too_long() && !self.snapshot().next_clock().drive_moved() {
            return Err(RunError::NoRest {
                step,
                time_star: self.time_star(),
                standing,
                n_slipping: self.totals.n_slipping,
            });
        }
        if standing > 0 && step >= MAX_HELD_STEPS {
            return Err(RunError::TooManySteps {
                step,
                drive_steps: self.clock.drive_steps,
            });
        }
        Ok(())
    }

    /// The block of all ranks with the largest displacement along an axis, the first such block, and this
    /// displacement. A NaN displacement counts as infinite.
    fn largest_displacement(&self) -> (usize, f64) {
        let size = |u: f64| if u.is_nan() { f64::INFINITY } else { u.abs() };
        let first = self.model.first_block();
        let (mut block, mut value) = (first, 0.0);
        for b in 0..self.model.surface.n_blocks() {
            for u in self.engine.motion(b)[0] {
                if size(u) > size(value) {
                    (block, value) = (first + b, u);
                }
            }
        }
        // The lowest rank with this value has the first such block, and sends it to the others.
        let largest = self.communicator.largest_of(size(value));
        let lowest = lowest_rank(&*self.communicator, size(value) == largest);
        let mut found = [0; 2];
        if lowest == Some(self.communicator.rank()) {
            found = [block as i64, value.to_bits() as i64];
        }
        self.communicator.sum(&mut found);
        (found[0] as usize, f64::from_bits(found[1] as u64))
    }
}

/// Largest static threshold of a block of this rank.
fn largest_strength(model: &Model) -> f64 {
    let limits = (0..model.surface.n_blocks()).map(|b| model.surface.static_limit(b));
    limits.filter(|limit| limit.is_finite()).fold(0.0, f64::max)
}
