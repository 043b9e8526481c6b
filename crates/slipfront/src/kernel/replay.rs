//! The engine of runs with steps that a device computes: it returns the records of each step.
//!
//! A device computes several steps at once, and values of single blocks are known at the last of them. Where
//! such values are read before, or energies that were not recorded, the device computes a part of these steps
//! again. It therefore computes as many steps at once as lie between two readings. Where readings are close
//! together, and after a failure of the device, the fused kernel computes the steps, with the same bits. If
//! the caller of the device records the steps, values of single blocks can be read only where it has stopped.
//!
//! The first counts of blocks by their position are readings. Then the device counts, and records the counts.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use super::block::{Block, Field};
use super::device_lattice::gcd;
use super::engine::{Engine, TakeSliding};
use super::fused::Fused;
use crate::checkpoint::{BlockColumn, Checkpoint};
use crate::clock::{Clock, Rest};
use crate::communicator::Communicator;
use crate::device::{Device, DeviceError, DeviceLattice, EnergySteps, StepRecord};
use crate::model::Model;
use crate::position_bins::PositionBins;
use crate::state::State;
use crate::totals::Totals;
use slipfront_kernel::MotionBounds;

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
    /// Whether values of single blocks have been read at the present step.
    was_read: AtomicBool,
    /// Bins in which blocks were counted at the present step, unless the device has counted them.
    counted: OnceLock<PositionBins>,
    /// The lattice at the present step, if it was read there and `lattice` is at a later step.
    here: OnceLock<Box<DeviceLattice>>,
    /// The fused kernel at the present step, if it has read values there or computes the steps.
    kernel: OnceLock<Box<Fused>>,
}

/// A device that records further steps.
#[derive(Debug)]
struct Source {
    device: Arc<dyn Device>,
    /// Threads for steps that the fused kernel computes.
    threads: usize,
    /// The lattice before the steps that the device computed last.
    before: DeviceLattice,
    /// Number of steps that the device computes at once.
    steps: u64,
    /// The latest step before the present one at which values of single blocks were read.
    last_read: Option<u64>,
    /// Whether the fused kernel computes the steps.
    is_on_cpu: bool,
    /// The first failure of the device. The fused kernel computes all steps after it.
    failure: OnceLock<DeviceError>,
}

/// Number of steps that a device computes at once at first, and at most.
const STEPS: [u64; 2] = [16, 1024];

/// Number of steps between two readings below which the fused kernel computes the steps: it needs about as
/// long for them as for reading the state of a device.
const CLOSE: u64 = 16;

/// Number of steps without a reading after which the device computes again.
const APART: u64 = 4 * CLOSE;

impl Source {
    /// The lattice some steps later; none if the device fails.
    fn compute(&self, steps: u64) -> Option<DeviceLattice> {
        if self.failure.get().is_some() {
            return None;
        }
        let mut lattice = self.before.clone();
        match self.device.run(&mut [&mut lattice], steps as u32) {
            Ok(()) => Some(lattice),
            Err(failure) => {
                let _ = self.failure.set(failure);
                None
            }
        }
    }

    /// The lattice before step `step`, computed with the fused kernel.
    fn compute_on_cpu(&self, step: u64) -> DeviceLattice {
        let mut lattice = self.before.clone();
        let steps = (step - lattice.steps_done) as u32;
        if steps > 0 {
            lattice.run_on_cpu(steps);
        }
        lattice
    }

    /// Adds a step to those at which energies are recorded: the multiples of the greatest common divisor of
    /// all such steps.
    fn add_energies(&mut self, step: u64) {
        let every = &mut self.before.energies.every;
        *every = if *every == u64::MAX {
            step
        } else {
            gcd(*every, step)
        };
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
            was_read: AtomicBool::new(false),
            counted: OnceLock::new(),
            here: OnceLock::new(),
            kernel: OnceLock::new(),
        }
    }

    /// Begins a lattice whose steps a device computes, with `threads` threads for the fused kernel; none if
    /// the model is computed on the CPU alone.
    pub(crate) fn on_device(
        device: &Arc<dyn Device>,
        threads: usize,
        model: &Arc<Model>,
        dt_star: f64,
        state: Option<&State>,
    ) -> Option<Self> {
        if device.most_blocks() < model.lattice.n_blocks() || model.rows != (0..model.lattice.ny) {
            return None;
        }
        // Energies at t = 0; `add_energies` adds other steps.
        let energies = EnergySteps {
            every: u64::MAX,
            last: 0,
        };
        let lattice = DeviceLattice::new(Arc::clone(model), dt_star, state, energies).ok()?;
        let source = Source {
            device: Arc::clone(device),
            threads,
            before: lattice.clone(),
            steps: STEPS[0],
            last_read: None,
            is_on_cpu: false,
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
        let moves = self.lattice.model.drive.moves_after(self.totals.n_slipping);
        let next = self.clock.next(moves);
        self.lattice.take_state(kernel, &self.clock, &next);
        self
    }

    /// The lattice at the present step.
    ///
    /// # Panics
    /// If the caller records the steps, unless the device has stopped at the present step.
    fn here(&self) -> &DeviceLattice {
        self.was_read.store(true, Ordering::Relaxed);
        if self.lattice.records.is_empty() {
            return &self.lattice;
        }
        self.here.get_or_init(|| {
            let next = self.clock.step + 1;
            let source = self.source.as_ref().unwrap_or_else(|| {
                panic!(
                    "numbers of blocks are known at step {}, where the device has stopped, and not at step {}",
                    self.lattice.steps_done - 1,
                    self.clock.step
                )
            });
            let lattice = source.compute(next - source.before.steps_done);
            let mut lattice = lattice.unwrap_or_else(|| source.compute_on_cpu(next));
            lattice.clear_records();
            Box::new(lattice)
        })
    }

    /// The fused kernel at the present step.
    fn kernel(&self) -> &Fused {
        self.was_read.store(true, Ordering::Relaxed);
        let threads = self.source.as_ref().map_or(1, |source| source.threads);
        self.kernel
            .get_or_init(|| Box::new(Fused::of_device(self.here(), threads)))
    }

    /// The fused kernel, if it computes the steps.
    fn on_cpu(&self) -> Option<&Fused> {
        let kernel = self.kernel.get().map(|kernel| &**kernel);
        kernel.filter(|_| self.source.as_ref().is_some_and(|source| source.is_on_cpu))
    }

    /// Lets the fused kernel compute the steps from the present one on.
    fn continue_on_cpu(&mut self) {
        self.kernel();
        if let Some(source) = &mut self.source {
            source.is_on_cpu = true;
        }
    }

    /// Lets the device compute the steps after the latest step of the fused kernel.
    fn continue_on_device(&mut self, next: &Clock) {
        if let Some(kernel) = self.kernel.take() {
            self.lattice.take_state(&kernel, &self.clock, next);
            self.lattice.clear_records();
        }
        if let Some(source) = &mut self.source {
            (source.is_on_cpu, source.steps) = (false, STEPS[0]);
        }
    }

    /// Decides whether the device or the fused kernel computes the next step, and records it if the device
    /// does.
    fn prepare(&mut self, next: &Clock, energies: bool) {
        let step = next.step;
        let was_read = std::mem::take(self.was_read.get_mut());
        let counted = self.counted.take().filter(|_| self.clock.step > 0);
        let Some(source) = &mut self.source else {
            self.kernel = OnceLock::new();
            self.lattice.forget_records(0);
            return;
        };
        if let Some(bins) = counted {
            self.lattice.add_counts(self.clock.step, &bins);
            source.before.counts = self.lattice.counts.clone();
            source.before.clear_records();
        }
        let apart = source.last_read.map_or(u64::MAX, |last| self.clock.step - last);
        // A device knows only exact rest.
        let is_for_cpu = source.failure.get().is_some() || next.rest != Rest::Exact;
        if was_read {
            source.last_read = Some(self.clock.step);
        }
        if source.is_on_cpu {
            if was_read || is_for_cpu || apart < APART {
                return;
            }
            self.continue_on_device(next);
        } else if is_for_cpu || (was_read && apart < CLOSE) {
            self.continue_on_cpu();
            self.here = OnceLock::new();
            *self.was_read.get_mut() = false;
            return;
        } else if was_read {
            source.steps = apart.clamp(1, STEPS[1]);
            // The steps after the present one are computed again from there on.
            if let Some(here) = self.here.take() {
                let counts = self.lattice.counts.take();
                self.lattice = DeviceLattice { counts, ..*here };
                self.lattice.clear_records();
            }
        } else if self.lattice.records.is_empty() && step > 0 {
            source.steps = STEPS[1].min(2 * source.steps);
        }
        self.kernel = OnceLock::new();
        if !self.record(step, energies) {
            self.continue_on_cpu();
            *self.was_read.get_mut() = false;
        }
    }

    /// Lets the device record further steps if there are none, and the energies of a step if they are needed.
    /// If it fails, returns false, and leaves the lattice before the step.
    fn record(&mut self, step: u64, energies: bool) -> bool {
        let Some(source) = &mut self.source else {
            return true;
        };
        let mut steps = None;
        if self.lattice.records.is_empty() {
            std::mem::swap(&mut source.before, &mut self.lattice);
            // `add_energies` has changed the lattice that was `before` until now.
            source.before.energies = self.lattice.energies;
            source.before.clear_records();
            steps = Some(source.steps);
        }
        if energies && !source.before.needs_energies(step) {
            source.add_energies(step);
            steps = steps.or_else(|| Some(self.lattice.steps_done - source.before.steps_done));
        }
        let Some(steps) = steps else { return true };
        let done = step - source.before.steps_done;
        if let Some(lattice) = source.compute(steps) {
            self.lattice = lattice;
            self.lattice.forget_records(done as usize);
            return true;
        }
        self.lattice = source.compute_on_cpu(step);
        self.lattice.clear_records();
        false
    }

    /// A time if it is not after the present one, else NaN.
    fn if_past(&self, time_star: f64) -> f64 {
        if time_star > self.clock.time_star() {
            f64::NAN
        } else {
            time_star
        }
    }
}

impl Engine for Replay {
    /// # Panics
    /// If the caller records the steps, and has not recorded this one, or not its energies.
    fn step(&mut self, model: &Model, clock: &Clock, energies: bool) -> Totals {
        self.prepare(clock, energies);
        self.clock = *clock;
        let is_on_cpu = self.source.as_ref().is_some_and(|source| source.is_on_cpu);
        if let Some(kernel) = self.kernel.get_mut().filter(|_| is_on_cpu) {
            self.totals = kernel.step(model, clock, energies);
            return self.totals;
        }
        let record = self.lattice.records.pop_front();
        self.present = record.unwrap_or_else(|| panic!("step {} was not recorded", clock.step));
        assert!(
            !energies || self.lattice.needs_energies(clock.step),
            "energies of step {} were not recorded",
            clock.step
        );
        self.totals = self.present.totals(self.totals.velocity_after, energies);
        self.totals
    }

    fn block(&self, model: &Model, clock: &Clock, b: usize) -> Block {
        self.kernel().block(model, clock, b)
    }

    fn read_rows(
        &self,
        model: &Model,
        clock: &Clock,
        field: Field,
        stride: usize,
        write: &mut dyn FnMut(usize, usize, &[f32]),
    ) {
        self.kernel().read_rows(model, clock, field, stride, write);
    }

    fn count_in_contact(&self, model: &Model, bins: &PositionBins, sliding: bool, counts: &mut [i64]) {
        let on_cpu = self.on_cpu();
        if on_cpu.is_none()
            && self
                .lattice
                .recorded_in_contact(self.clock.step, bins, sliding, counts)
        {
            return;
        }
        self.counted.get_or_init(|| *bins);
        match on_cpu {
            // Not a reading, since the device counts where it computes.
            Some(kernel) => kernel.count_in_contact(model, bins, sliding, counts),
            None => self.here().count_in_contact(bins, sliding, counts),
        }
    }

    fn read_sliding(&self, model: &Model, take: TakeSliding) {
        self.kernel().read_sliding(model, take);
    }

    fn motion(&self, b: usize) -> [[f64; 2]; 2] {
        if self.on_cpu().is_some() {
            return self.kernel().motion(b);
        }
        // Where the caller records the steps, a run that diverges reads them beyond the present step.
        let lattice = match self.source {
            Some(_) => self.here(),
            None => &self.lattice,
        };
        let State {
            displacement,
            velocity,
        } = &lattice.state;
        [displacement.at(b), velocity.at(b)]
    }

    fn state(&self, n_blocks: usize) -> State {
        self.kernel().state(n_blocks)
    }

    fn read_column(&self, time_star: f64, column: BlockColumn, first: usize, values: &mut [f64]) {
        match column {
            BlockColumn::FirstSlip if self.on_cpu().is_none() => {
                self.lattice.read_column(column, first, values);
                for time_star in values {
                    *time_star = self.if_past(*time_star);
                }
            }
            BlockColumn::Memory(_) if self.on_cpu().is_none() => {
                self.here().read_column(column, first, values);
            }
            _ => self.kernel().read_column(time_star, column, first, values),
        }
    }

    fn into_first_slips(mut self: Box<Self>) -> Vec<f64> {
        if self.on_cpu().is_some()
            && let Some(kernel) = self.kernel.take()
        {
            return kernel.into_first_slips();
        }
        let blocks = 0..self.lattice.first_slips.len();
        blocks
            .map(|b| self.if_past(self.lattice.first_slip_time_star(b)))
            .collect()
    }

    fn stress_square_max(&self, model: &Model, clock: &Clock) -> f64 {
        let square = self.on_cpu().map(|kernel| kernel.stress_square_max(model, clock));
        square.unwrap_or(self.present.stress_square_max)
    }

    fn motion_bounds(&self) -> Option<MotionBounds> {
        self.kernel().motion_bounds()
    }

    fn weakening_energy(&self, model: &Model, time_star: f64, ranks: &dyn Communicator) -> f64 {
        match self.on_cpu() {
            // Not a reading, since the device records the energy where it computes.
            Some(kernel) => kernel.weakening_energy(model, time_star, ranks),
            None if self.lattice.needs_energies(self.clock.step) => self.present.weakening_energy,
            None => self.kernel().weakening_energy(model, time_star, ranks),
        }
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
