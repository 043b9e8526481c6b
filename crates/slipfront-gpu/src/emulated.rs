//! The kernels on thread groups that the CPU emulates.

#![allow(unsafe_code)] // Functions of C++ are called.

use slipfront::device::{Device, DeviceError, DeviceLattice};

use crate::batch::{Batch, Lattice};

/// A device that emulates groups of threads on the calling thread: slow, but exact.
#[derive(Clone, Copy, Debug)]
pub struct Emulated {
    /// Threads of a group: 32, 64, 128, 256, 512 or 1024.
    pub threads: u32,
    /// Distance from a thread that waits to the thread that runs next: any odd number. Results do not depend
    /// on it.
    pub stride: u32,
}

/// The struct `Arrays` of `kernels/step.h`.
#[repr(C)]
struct Arrays {
    lattices: *mut Lattice,
    state: *mut f64,
    given: *const f64,
    flags: *const u16,
    first_slips: *mut u32,
    records: *mut u64,
}

// SAFETY: `kernels/emulated.cpp` defines a function of this name and type, which keeps none of the pointers.
unsafe extern "C" {
    /// Takes `count` lattices through their steps on groups of `threads` emulated threads.
    fn slipfront_run_emulated(arrays: *const Arrays, count: usize, threads: i32, stride: i32);
}

impl Device for Emulated {
    /// Number of warps times the number of terms that the sum of a warp may have.
    fn most_blocks(&self) -> usize {
        (1 << 11) * self.threads as usize / 32
    }

    fn run(&self, lattices: &mut [&mut DeviceLattice], steps: u32) -> Result<(), DeviceError> {
        let Self { threads, stride } = *self;
        assert!(
            threads.is_power_of_two() && (32..=1024).contains(&threads) && !stride.is_multiple_of(2),
            "no group of {threads} threads goes on in strides of {stride}"
        );
        let mut batch = Batch::new(lattices, steps)?;
        let arrays = Arrays {
            lattices: batch.lattices.as_mut_ptr(),
            state: batch.state.as_mut_ptr(),
            given: batch.given.as_ptr(),
            flags: batch.flags.as_ptr(),
            first_slips: batch.first_slips.as_mut_ptr(),
            records: batch.records.as_mut_ptr(),
        };
        // SAFETY: the pointers lead to arrays of the batch, which has checked their lengths, and nothing else
        // refers to these arrays during the call.
        unsafe {
            slipfront_run_emulated(
                &raw const arrays,
                batch.lattices.len(),
                threads as i32,
                stride as i32,
            );
        }
        batch.return_to(lattices);
        Ok(())
    }
}
