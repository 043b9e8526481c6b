//! The kernels on thread groups that the CPU emulates.

#![allow(unsafe_code)] // Functions of C++ are called.

use slipfront::device::{Device, DeviceError, DeviceLattice};

use crate::batch::{Batch, Lattice};

/// A device that emulates groups of threads: slow, but exact. The calling thread runs all of them in turn;
/// under `tests/sanitizers.sh` each is a thread of the CPU.
#[derive(Clone, Copy, Debug)]
pub struct Emulated {
    /// Threads of a group: 32, 64, 128, 256, 512 or 1024.
    pub threads: u32,
    /// Distance from a thread that waits to the thread that runs next, if they run in turn: any odd number.
    /// Results do not depend on it.
    pub stride: u32,
    /// Number of groups that share the tiles of each lattice, as on a GPU for lattices that are large; none
    /// for one group with all blocks in its own memory, as for small ones.
    pub groups: Option<u32>,
}

/// The struct `Arrays` of `kernels/step.h`.
#[repr(C)]
struct Arrays {
    lattices: *mut Lattice,
    state: *mut f64,
    given: *mut f64,
    memory: *mut f64,
    flags: *const u16,
    bins: *const u16,
    counts: *mut u32,
    first_slips: *mut u32,
    records: *mut u64,
}

// SAFETY: `kernels/emulated.cpp` defines functions of these names and types, which keep none of the pointers.
unsafe extern "C" {
    /// Takes `count` small lattices through their steps, each on a group of `threads` emulated threads.
    fn slipfront_run_small(arrays: *const Arrays, count: usize, threads: i32, stride: i32);
    /// Takes `count` lattices through their steps, each on `groups` groups of `threads` emulated threads.
    fn slipfront_run_large(arrays: *const Arrays, count: usize, groups: u32, threads: i32, stride: i32);
}

impl Device for Emulated {
    fn name(&self) -> String {
        "emulated GPU".to_owned()
    }

    /// Number of warps times the number of terms that the sum of a warp may have, if tiles were divided
    /// evenly.
    fn most_blocks(&self) -> usize {
        (1 << 11) * (self.threads / 32 * self.groups.unwrap_or(1)) as usize
    }

    fn run(&self, lattices: &mut [&mut DeviceLattice], steps: u32) -> Result<(), DeviceError> {
        let Self {
            threads,
            stride,
            groups,
        } = *self;
        assert!(
            threads.is_power_of_two() && (32..=1024).contains(&threads) && !stride.is_multiple_of(2),
            "no group of {threads} threads goes on in strides of {stride}"
        );
        let mut batch = Batch::new(lattices, steps)?;
        let arrays = Arrays {
            lattices: batch.lattices.as_mut_ptr(),
            state: batch.state.as_mut_ptr(),
            given: batch.given.as_mut_ptr(),
            memory: batch.memory.as_mut_ptr(),
            flags: batch.flags.as_ptr(),
            bins: batch.bins.as_ptr(),
            counts: batch.counts.as_mut_ptr(),
            first_slips: batch.first_slips.as_mut_ptr(),
            records: batch.records.as_mut_ptr(),
        };
        let (count, threads, stride) = (batch.lattices.len(), threads as i32, stride as i32);
        // SAFETY: the pointers lead to arrays of the batch, which has checked their lengths, and nothing else
        // refers to these arrays during the call.
        unsafe {
            match groups {
                None => slipfront_run_small(&raw const arrays, count, threads, stride),
                Some(groups) => slipfront_run_large(&raw const arrays, count, groups, threads, stride),
            }
        }
        batch.return_to(lattices);
        Ok(())
    }
}
