//! A lattice as the kernels take it.

use std::ptr;

use slipfront::device::{DeviceError, DeviceLattice, Equations, Motion, StepRecord};

/// The struct `Lattice` of `kernels/step.h`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Lattice {
    pub(crate) equations: Equations,
    pub(crate) motion: Motion,
    pub(crate) first_step: u64,
    pub(crate) energies_every: u64,
    pub(crate) energies_last: u64,
    pub(crate) steps: u32,
    pub(crate) nx: u32,
    pub(crate) n: u32,
    pub(crate) unused: u32,
    pub(crate) positions: *const f64,
    pub(crate) static_limit_squares: *const f64,
    pub(crate) kinetic_impulses: *const f64,
    pub(crate) flags: *const u16,
    pub(crate) ux: *mut f64,
    pub(crate) uy: *mut f64,
    pub(crate) vx: *mut f64,
    pub(crate) vy: *mut f64,
    pub(crate) first_slips: *mut u32,
    pub(crate) records: *mut StepRecord,
}

/// Bytes of shared memory that a kernel needs for each block.
pub(crate) const BYTES_PER_BLOCK: usize = 6 * size_of::<f64>() + size_of::<u32>();

/// Most blocks of a lattice that fits into the shared memory of a group of threads, 227 KiB less what the
/// threads share beside the blocks.
pub(crate) const MOST_BLOCKS: usize = (227 * 1024 - 8 * 1024) / BYTES_PER_BLOCK;

impl Lattice {
    /// The numbers of a lattice for so many steps, without its arrays.
    ///
    /// # Errors
    /// For a lattice that is too large, or that has taken too many steps.
    pub(crate) fn without_arrays(lattice: &DeviceLattice, steps: u32) -> Result<Self, DeviceError> {
        let [nx, ny] = lattice.blocks;
        if nx * ny > MOST_BLOCKS {
            let message = format!(
                "a lattice of {nx} x {ny} blocks is larger than the {MOST_BLOCKS} blocks that a GPU takes"
            );
            return Err(DeviceError(message));
        }
        let last = lattice.steps_done + u64::from(steps);
        if last >= u64::from(u32::MAX) {
            return Err(DeviceError(format!(
                "a run ends before step {}, and not at step {last}",
                u32::MAX
            )));
        }
        Ok(Self {
            equations: lattice.equations,
            motion: lattice.motion,
            first_step: lattice.steps_done,
            energies_every: lattice.energies.every,
            energies_last: lattice.energies.last,
            steps,
            nx: nx as u32,
            n: (nx * ny) as u32,
            unused: 0,
            positions: ptr::null(),
            static_limit_squares: ptr::null(),
            kinetic_impulses: ptr::null(),
            flags: ptr::null(),
            ux: ptr::null_mut(),
            uy: ptr::null_mut(),
            vx: ptr::null_mut(),
            vy: ptr::null_mut(),
            first_slips: ptr::null_mut(),
            records: ptr::null_mut(),
        })
    }
}
