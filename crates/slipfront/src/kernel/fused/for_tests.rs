//! The fused kernel on its own, for tests of behaviour that a simulation does not show, and as a device.

use slipfront_kernel::VECTORS;

use super::*;
use crate::device::{Device, DeviceError, DeviceLattice};

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
        self.kernel
            .read_column(f64::NAN, BlockColumn::FirstSlip, 0, &mut times);
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
    fn name(&self) -> String {
        "fused kernel".to_owned()
    }

    fn most_blocks(&self) -> usize {
        usize::MAX
    }

    fn run(&self, lattices: &mut [&mut DeviceLattice], steps: u32) -> Result<(), DeviceError> {
        for lattice in lattices {
            lattice.run_on_cpu(steps);
        }
        Ok(())
    }
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
