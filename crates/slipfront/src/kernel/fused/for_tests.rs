//! The fused kernel on its own, for tests of behaviour that a simulation does not show, and as a device.

use super::layout::VECTORS;
use super::*;
use crate::device::{Device, DeviceError, DeviceLattice, StepRecord};

/// The fused kernel on its own, on one thread of one rank. Tests choose the width of its vectors, and read
/// its bounds and the steps up to which it rests.
#[derive(Debug)]
pub struct FusedKernel {
    model: Model,
    kernel: Fused,
    /// The instant of the latest step.
    latest: Option<Clock>,
}

impl FusedKernel {
    /// Number of vector widths that this processor supports.
    pub fn n_widths() -> usize {
        levels().len()
    }

    /// Begins in a given state, or at rest. Vectors have the largest width unless `width` selects another,
    /// counted from the narrowest on; tiles at rest are skipped if `skips` is set.
    ///
    /// # Panics
    /// If there is no such width.
    pub fn new(model: Model, dt_star: f64, state: Option<&State>, skips: bool, width: Option<usize>) -> Self {
        let mut kernel = Fused::new(&model, dt_star, state, 1, skips, Arc::new(Alone));
        if let Some(width) = width {
            kernel.level = levels()[width];
        }
        Self {
            model,
            kernel,
            latest: None,
        }
    }

    /// The model that is stepped.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Makes the next step, beginning with step 0, under a drive that moves in every step. Returns the sums
    /// over all blocks, with the stored energies if `energies` is set.
    pub fn step(&mut self, energies: bool) -> Totals {
        let start = Clock::start(self.kernel.dt_star);
        let clock = self.latest.map_or(start, |latest| latest.next(true));
        self.latest = Some(clock);
        self.kernel.step(&self.model, &clock, energies)
    }

    /// Displacement and velocity of a block after the latest step.
    pub fn motion(&self, block: usize) -> [[f64; 2]; 2] {
        self.kernel.motion(block)
    }

    /// t* of the first slip of every block; NaN where there was none.
    pub fn first_slip_times_star(&self) -> Vec<f64> {
        let mut times = vec![0.0; self.model.lattice.n_blocks()];
        self.kernel.read_column(BlockColumn::FirstSlip, 0, &mut times);
        times
    }

    /// Largest square of a contact stress at any step so far.
    ///
    /// # Panics
    /// Before the first step.
    pub fn stress_square_max(&self) -> f64 {
        let latest = self.latest.expect("a step was made");
        self.kernel.stress_square_max(&self.model, &latest)
    }

    /// Bounds on the displacements of all blocks along an axis, the lower first.
    pub fn displacement_bounds(&self, axis: usize) -> [f64; 2] {
        self.kernel.motion_bounds.range(axis)
    }

    /// A bound on the differences of displacements, along an axis, of blocks that a spring joins.
    pub fn difference_bound(&self, axis: usize) -> f64 {
        self.kernel.motion_bounds.spring_difference(axis)
    }

    /// Number of vectors that a sweep over all blocks takes.
    pub fn n_vectors(&self) -> usize {
        self.kernel.touched.len() * VECTORS
    }

    /// Number of vectors that the latest step swept.
    pub fn n_swept_vectors(&self) -> usize {
        if self.kernel.swept_step != self.latest.map(|clock| clock.step) {
            return 0;
        }
        let tasks = self.kernel.bands.iter().flat_map(|band| &band.tasks);
        tasks.map(|task| task.active.count_ones() as usize).sum()
    }

    /// The first step at which a block may slip, if nothing moves.
    pub fn active_from_step(&self) -> u64 {
        self.kernel.active_from_step
    }
}

/// The fused kernel on one thread as a device: the reference with which other devices must agree to the last
/// bit.
#[derive(Clone, Copy, Debug)]
pub struct FusedDevice;

impl Device for FusedDevice {
    fn most_blocks(&self) -> usize {
        usize::MAX
    }

    fn run(&self, lattices: &mut [&mut DeviceLattice], steps: u32) -> Result<(), DeviceError> {
        for lattice in lattices {
            run_on_fused(lattice, steps);
        }
        Ok(())
    }
}

/// Advances a lattice by some steps.
fn run_on_fused(lattice: &mut DeviceLattice, steps: u32) {
    let model = &*Arc::clone(&lattice.model);
    let (dt_star, n) = (lattice.equations.dt_star, model.lattice.n_blocks());
    let state = (lattice.steps_done == 0).then_some(&lattice.state);
    let mut kernel = Fused::new(model, dt_star, state, 1, false, Arc::new(Alone));
    if let Some(before) = lattice.steps_done.checked_sub(1) {
        for (column, values) in columns(&lattice.state, &lattice.first_slips, dt_star) {
            kernel.set_column(column, 0, &values);
        }
        kernel = kernel.resumed();
        kernel.swept_step = Some(before);
        kernel.motion_bounds = MotionBounds::of_numbers(lattice.motion.bounds);
        kernel.totals.velocity_after = lattice.motion.velocity_after;
        kernel.stress_square_max = lattice.motion.stress_square_max;
    }
    for _ in 0..steps {
        let clock = Clock {
            step: lattice.steps_done,
            drive_steps: lattice.steps_done,
            ..Clock::start(dt_star)
        };
        let energies = lattice.needs_energies(clock.step);
        let totals = kernel.step(model, &clock, energies);
        let stored = totals.stored_energy.unwrap_or_default();
        lattice.records.push_back(StepRecord {
            displacement: totals.displacement,
            velocity_after: totals.velocity_after,
            velocity_square: totals.velocity_square,
            friction_power: totals.friction_power,
            stress_square_max: kernel.stress_square_max(model, &clock),
            n_sliding: [totals.n_sliding, totals.n_slipping].map(|count| count as u32),
            stored: [stored.kinetic, stored.lattice, stored.drive_springs],
        });
        lattice.steps_done += 1;
    }
    lattice.motion.bounds = kernel.motion_bounds.to_numbers();
    lattice.motion.velocity_after = kernel.totals.velocity_after;
    lattice.motion.stress_square_max = kernel.stress_square_max;
    lattice.state = kernel.state();
    let mut times = vec![0.0; n];
    kernel.read_column(BlockColumn::FirstSlip, 0, &mut times);
    let step = |time: f64| {
        if time.is_nan() {
            NEVER
        } else {
            (time / dt_star).round() as u32
        }
    };
    lattice.first_slips = times.into_iter().map(step).collect();
}

/// Columns of a checkpoint of this state.
fn columns(state: &State, first_slips: &[u32], dt_star: f64) -> [(BlockColumn, Vec<f64>); 5] {
    let State {
        displacement: u,
        velocity: v,
    } = state;
    let time = |&step: &u32| {
        if step == NEVER {
            f64::NAN
        } else {
            f64::from(step) * dt_star
        }
    };
    [
        (BlockColumn::DisplacementX, u.x.clone()),
        (BlockColumn::DisplacementY, u.y.clone()),
        (BlockColumn::VelocityX, v.x.clone()),
        (BlockColumn::VelocityY, v.y.clone()),
        (BlockColumn::FirstSlip, first_slips.iter().map(time).collect()),
    ]
}

/// Every vector width that this processor supports, narrow ones first.
fn levels() -> Vec<Level> {
    let widest = Level::new();
    #[cfg(target_arch = "x86_64")]
    {
        let levels = [
            widest.as_sse2().map(Level::Sse2),
            widest.as_sse4_2().map(Level::Sse4_2),
            widest.as_avx2().map(Level::Avx2),
            widest.as_avx512().map(Level::Avx512),
        ];
        levels.into_iter().flatten().collect()
    }
    #[cfg(not(target_arch = "x86_64"))]
    vec![widest]
}
