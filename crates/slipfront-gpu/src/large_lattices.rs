//! Launches of the kernels for lattices of any size, `kernels/large_lattices.h`.

#![allow(unsafe_code)] // Kernels are launched, and a struct is passed to the GPU.

use std::mem;
use std::sync::Arc;

use cudarc::driver::sys::CUdeviceptr;
use cudarc::driver::{
    CudaFunction, CudaModule, CudaStream, DevicePtrMut, DeviceRepr, DriverError, LaunchConfig, PushKernelArg,
};

use crate::arrays::{Arrays, Pointers};
use crate::batch::{Lattice, STEP, TOTALS};

/// Blocks of a tile along x and y in `kernels/large_lattices.h`.
const TILE: [usize; 2] = [32, 16];

/// Threads of a group.
const THREADS: u32 = 256;

/// Largest number of tiles that a group takes: a warp adds up at most 2^11 terms.
const MOST_TILES: usize = (1 << 11) * (THREADS as usize / 32) / (TILE[0] * TILE[1]);

/// Number of groups that keeps every GPU busy: beyond it a group takes several tiles.
const MANY_GROUPS: usize = 1024;

/// Kernels for lattices of any size.
#[derive(Debug)]
pub(crate) struct LargeKernels {
    measure: CudaFunction,
    step: CudaFunction,
    /// Kernels that add up weakening energies.
    weakening: [CudaFunction; 2],
    join: CudaFunction,
}

/// The struct `LargeLattices` of `kernels/large_lattices.h`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct LargeLattices {
    arrays: Pointers,
    state_after: CUdeviceptr,
    steps: CUdeviceptr,
    totals: CUdeviceptr,
    groups: u32,
    done: u32,
}

const _: () = assert!(size_of::<LargeLattices>() == 104);

// SAFETY: the struct has no padding, and has the layout of the struct of the kernels, in which pointers have
// 8 bytes.
unsafe impl DeviceRepr for LargeLattices {}

impl LargeKernels {
    /// Finds the kernels in their module.
    pub(crate) fn load(module: &Arc<CudaModule>) -> Result<Self, DriverError> {
        Ok(Self {
            measure: module.load_function("measure_large")?,
            step: module.load_function("step_large")?,
            weakening: [
                module.load_function("largest_weakening_large")?,
                module.load_function("add_weakening_large")?,
            ],
            join: module.load_function("join_large")?,
        })
    }

    /// Runs the steps of lattices, all of which take the same number of them.
    pub(crate) fn launch(
        &self,
        stream: &Arc<CudaStream>,
        arrays: &mut Arrays,
        lattices: &[Lattice],
    ) -> Result<(), DriverError> {
        let count = lattices.len();
        let n_steps = lattices.first().map_or(0, |lattice| lattice.steps);
        let tiles = lattices.iter().map(|lattice| lattice.tiles(TILE)).max();
        let tiles = tiles.unwrap_or(1);
        let groups = tiles.div_ceil((tiles / MANY_GROUPS).clamp(1, MOST_TILES));
        let mut after = stream.alloc_zeros::<f64>(arrays.state.len())?;
        let mut steps = stream.alloc_zeros::<u64>(count * STEP)?;
        let mut totals = stream.alloc_zeros::<u64>(count * groups * TOTALS)?;
        {
            let after = after.device_ptr_mut(stream);
            let steps = steps.device_ptr_mut(stream);
            let totals = totals.device_ptr_mut(stream);
            arrays.launch(stream, |arrays| {
                let argument = LargeLattices {
                    arrays,
                    state_after: after.0,
                    steps: steps.0,
                    totals: totals.0,
                    groups: groups as u32,
                    done: 0,
                };
                self.launch_steps(stream, argument, lattices)
            })?;
        }
        if n_steps % 2 == 1 {
            mem::swap(&mut arrays.state, &mut after);
        }
        Ok(())
    }

    /// Launches the kernels for the steps of some lattices with this first `argument`: two before the first
    /// step, two for each step, and two more where the weakening energy of a lattice is needed.
    fn launch_steps(
        &self,
        stream: &Arc<CudaStream>,
        mut argument: LargeLattices,
        lattices: &[Lattice],
    ) -> Result<(), DriverError> {
        let n_steps = lattices.first().map_or(0, |lattice| lattice.steps);
        let launch = |function, argument: &LargeLattices, groups| {
            let config = LaunchConfig {
                grid_dim: (groups, lattices.len() as u32, 1),
                block_dim: (THREADS, 1, 1),
                shared_mem_bytes: 0,
            };
            // SAFETY: the argument has the type of the kernel's parameter. The batch has checked the lengths
            // of its arrays, and the others have a number for each group.
            unsafe { stream.launch_builder(function).arg(argument).launch(config) }.map(|_| ())
        };
        launch(&self.measure, &argument, argument.groups)?;
        launch(&self.join, &argument, 1)?;
        for done in 0..n_steps {
            launch(&self.step, &argument, argument.groups)?;
            if lattices
                .iter()
                .any(|lattice| lattice.needs_weakening_energy(done))
            {
                for kernel in &self.weakening {
                    launch(kernel, &argument, argument.groups)?;
                }
            }
            argument.done = done + 1;
            launch(&self.join, &argument, 1)?;
            mem::swap(&mut argument.arrays.state, &mut argument.state_after);
        }
        Ok(())
    }
}
