//! The engine of runs with steps that a device computes: it returns the records of each step.
//!
//! A device computes several steps at once, and values of single blocks are known at the last of them. The
//! device computes a part of these steps again where such values are read before, or energies that were not
//! recorded, so that parts are as long as the steps between two readings. The fused kernel, which gives the
//! same bits, takes the state and reads the values. If the caller of the device records the steps, such
//! values can be read only where it has stopped.

use std::sync::{Arc, OnceLock};

use super::block::{Block, Field};
use super::engine::{Engine, TakeSliding};
use super::fused::Fused;
use crate::checkpoint::{BlockColumn, Checkpoint, MotionBounds};
use crate::clock::Clock;
use crate::device::{Device, DeviceError, DeviceLattice, EnergySteps, StepRecord};
use crate::model::Model;
use crate::position_bins::PositionBins;
use crate::state::State;
use crate::totals::Totals;

/// The steps of a lattice that a device computes.
#[derive(Debug)]
pub(crate) struct Replay {
    /// The lattice after the recorded steps.
    lattice: DeviceLattice,
    /// The device that records further steps; none if the caller does.
    source: Option<Source>,
    /// The present instant, and the record of its step.
    clock: Clock,
    present: StepRecord,
    totals: Totals,
    /// Set when the state at the present step has been read: the lattice at this step, or none if `lattice`
    /// is at this step.
    here: OnceLock<Option<Box<DeviceLattice>>>,
    /// The fused kernel at the present step, if it has read a value of single blocks there.
    blocks: OnceLock<Box<Fused>>,
}

/// A device that records further steps.
#[derive(Debug)]
struct Source {
    device: Arc<dyn Device>,
    /// The lattice before the steps that were computed last.
    before: DeviceLattice,
    /// Number of steps to compute at once.
    steps: u32,
    /// The first failure of the device. The fused kernel computes all steps after it.
    failure: OnceLock<DeviceError>,
}

/// Number of steps that a device computes at once at first, and at most.
const STEPS: [u32; 2] = [16, 1024];

impl Source {
    /// The lattice some steps later.
    fn compute(&self, steps: u32) -> DeviceLattice {
        if self.failure.get().is_none() {
            let mut lattice = self.before.clone();
            match self.device.run(&mut [&mut lattice], steps) {
                Ok(()) => return lattice,
                Err(failure) => {
                    let _ = self.failure.set(failure);
                }
            }
        }
        let mut lattice = self.before.clone();
        lattice.run_on_cpu(steps);
        lattice
    }

    /// Number of steps up to a step, that one included.
    fn steps_to(&self, step: u64) -> u32 {
        (step + 1 - self.before.steps_done) as u32
    }
}

impl Replay {
    /// Replays the recorded steps of a lattice from t = 0 on.
    pub(crate) fn new(lattice: DeviceLattice) -> Self {
        Self {
            clock: Clock::start(lattice.equations.dt_star),
            present: StepRecord::default(),
            totals: Totals {
                velocity_after: lattice.velocity_at_start,
                ..Totals::default()
            },
            lattice,
            source: None,
            here: OnceLock::new(),
            blocks: OnceLock::new(),
        }
    }

    /// Begins a lattice whose steps a device computes; none if the model is computed on the CPU alone.
    pub(crate) fn on_device(
        device: &Arc<dyn Device>,
        model: &Arc<Model>,
        dt_star: f64,
        state: Option<&State>,
    ) -> Option<Self> {
        if device.most_blocks() < model.lattice.n_blocks() || model.rows != (0..model.lattice.ny) {
            return None;
        }
        // Others are added where they are needed.
        let energies = EnergySteps {
            every: u64::MAX,
            last: 0,
        };
        let lattice = DeviceLattice::new(Arc::clone(model), dt_star, state, energies).ok()?;
        let source = Source {
            device: Arc::clone(device),
            before: lattice.clone(),
            steps: STEPS[0],
            failure: OnceLock::new(),
        };
        Some(Self {
            source: Some(source),
            ..Self::new(lattice)
        })
    }

    /// Continues from a checkpoint, with the state of a kernel that has read it.
    pub(crate) fn resumed(mut self, kernel: &Fused, checkpoint: &Checkpoint) -> Self {
        self.clock = checkpoint.clock(self.lattice.equations.dt_star);
        self.totals = checkpoint.totals;
        self.present.stress_square_max = checkpoint.stress_square_max;
        self.lattice.steps_done = checkpoint.step + 1;
        self.lattice.take_state(kernel);
        self
    }

    /// The lattice at the present step.
    ///
    /// # Panics
    /// If the caller records the steps, unless the device has stopped at the present step.
    fn here(&self) -> &DeviceLattice {
        let here = self.here.get_or_init(|| {
            if self.lattice.records.is_empty() {
                return None;
            }
            let source = self.source.as_ref().unwrap_or_else(|| {
                panic!(
                    "numbers of blocks are known at step {}, where the device has stopped, and not at step {}",
                    self.lattice.steps_done - 1,
                    self.clock.step
                )
            });
            let mut lattice = source.compute(source.steps_to(self.clock.step));
            lattice.records.clear();
            Some(Box::new(lattice))
        });
        here.as_deref().unwrap_or(&self.lattice)
    }

    /// The fused kernel at the present step.
    fn blocks(&self) -> &Fused {
        self.blocks
            .get_or_init(|| Box::new(Fused::of_device(self.here())))
    }

    /// Records further steps if there are none, and the energies of a step if they are needed.
    fn record(&mut self, step: u64, energies: bool) {
        let Some(source) = &mut self.source else { return };
        self.blocks = OnceLock::new();
        match self.here.take() {
            // The steps after the present one are computed again from here on.
            Some(Some(here)) => {
                source.steps = source.steps_to(here.steps_done - 1);
                self.lattice = *here;
            }
            // The state was read exactly where the steps ended.
            Some(None) => {}
            None if self.lattice.records.is_empty() => source.steps = STEPS[1].min(2 * source.steps),
            None => {}
        }
        if self.lattice.records.is_empty() {
            std::mem::swap(&mut source.before, &mut self.lattice);
            self.lattice = source.compute(source.steps);
        }
        if energies && !self.lattice.needs_energies(step) {
            let every = &mut source.before.energies.every;
            *every = if *every == u64::MAX {
                step
            } else {
                gcd(*every, step)
            };
            let steps = self.lattice.steps_done - source.before.steps_done;
            self.lattice = source.compute(steps as u32);
            self.lattice
                .records
                .drain(..(step - source.before.steps_done) as usize);
        }
    }
}

/// The greatest common divisor.
fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

impl Engine for Replay {
    /// # Panics
    /// If the caller records the steps, and has not recorded this one, or not its energies.
    fn step(&mut self, _: &Model, clock: &Clock, energies: bool) -> Totals {
        self.record(clock.step, energies);
        let record = self.lattice.records.pop_front();
        self.present = record.unwrap_or_else(|| panic!("step {} was not recorded", clock.step));
        assert!(
            !energies || self.lattice.needs_energies(clock.step),
            "energies of step {} were not recorded",
            clock.step
        );
        self.clock = *clock;
        (self.here, self.blocks) = (OnceLock::new(), OnceLock::new());
        self.totals = self.present.totals(self.totals.velocity_after, energies);
        self.totals
    }

    fn block(&self, model: &Model, clock: &Clock, b: usize) -> Block {
        self.blocks().block(model, clock, b)
    }

    fn read_rows(
        &self,
        model: &Model,
        clock: &Clock,
        field: Field,
        stride: usize,
        write: &mut dyn FnMut(usize, usize, &[f32]),
    ) {
        self.blocks().read_rows(model, clock, field, stride, write);
    }

    fn count_in_contact(&self, _: &Model, bins: &PositionBins, sliding: bool, counts: &mut [i64]) {
        self.here().count_in_contact(bins, sliding, counts);
    }

    fn read_sliding(&self, model: &Model, take: TakeSliding) {
        self.blocks().read_sliding(model, take);
    }

    fn motion(&self, b: usize) -> [[f64; 2]; 2] {
        let State {
            displacement,
            velocity,
        } = &self.here().state;
        [displacement.at(b), velocity.at(b)]
    }

    fn state(&self) -> State {
        self.here().state.clone()
    }

    fn sheets(&self) -> Vec<State> {
        Vec::new()
    }

    fn read_column(&self, column: BlockColumn, first: usize, values: &mut [f64]) {
        if column != BlockColumn::FirstSlip {
            return self.here().read_column(column, first, values);
        }
        self.lattice.read_column(column, first, values);
        for time_star in values {
            *time_star = self.if_past(*time_star);
        }
    }

    fn into_first_slips(self: Box<Self>) -> Vec<f64> {
        let blocks = 0..self.lattice.first_slips.len();
        blocks
            .map(|b| self.if_past(self.lattice.first_slip_time_star(b)))
            .collect()
    }

    fn stress_square_max(&self, _: &Model, _: &Clock) -> f64 {
        self.present.stress_square_max
    }

    fn motion_bounds(&self) -> Option<MotionBounds> {
        Some(MotionBounds::of_numbers(self.here().motion.bounds))
    }

    fn read_memory(&self, _: f64, column: usize, _: usize, _: &mut [f64]) {
        unreachable!("the law of a plain lattice has no column {column}");
    }

    fn device_lattice(&mut self) -> Option<&mut DeviceLattice> {
        Some(&mut self.lattice)
    }

    fn device(&self) -> Option<&dyn Device> {
        Some(&*self.source.as_ref()?.device)
    }

    fn device_failure(&self) -> Option<&DeviceError> {
        self.source.as_ref()?.failure.get()
    }
}

impl Replay {
    /// A time if it is not after the present one, else NaN.
    fn if_past(&self, time_star: f64) -> f64 {
        if time_star > self.clock.time_star() {
            f64::NAN
        } else {
            time_star
        }
    }
}
