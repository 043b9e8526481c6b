//! The kernels on groups of threads that are emulated on the CPU.

#![allow(unsafe_code)] // Functions of C++ are called.

use slipfront::device::{Device, DeviceError, DeviceLattice, StepRecord};

use crate::lattice::Lattice;

/// A device whose groups of threads are emulated on this thread: very slow, and exact.
#[derive(Clone, Copy, Debug)]
pub struct Emulated {
    /// Threads of a group: a multiple of 32, up to 1024.
    pub threads: u32,
}

unsafe extern "C" {
    /// Takes lattices through their steps on groups of `threads` emulated threads.
    fn slipfront_run_emulated(lattices: *mut Lattice, count: usize, threads: i32);
    /// Size of the struct in C++.
    fn slipfront_lattice_bytes() -> usize;
}

impl Device for Emulated {
    fn run(&self, lattices: &mut [&mut DeviceLattice], steps: u32) -> Result<(), DeviceError> {
        assert!(self.threads.is_multiple_of(32) && (32..=1024).contains(&self.threads));
        // SAFETY: the function has no arguments and no state.
        assert_eq!(unsafe { slipfront_lattice_bytes() }, size_of::<Lattice>());
        for lattice in lattices {
            let positions: Vec<[f64; 2]> = lattice.drive_positions(steps).collect();
            let mut records = vec![StepRecord::default(); steps as usize];
            let (u, v) = (&mut lattice.state.displacement, &mut lattice.state.velocity);
            let arrays = [
                &u.x,
                &u.y,
                &v.x,
                &v.y,
                &lattice.static_limit_squares,
                &lattice.kinetic_impulses,
            ];
            let n = lattice.blocks[0] * lattice.blocks[1];
            assert!(arrays.iter().all(|array| array.len() == n));
            assert!(lattice.flags.len() == n && lattice.first_slips.len() == n);
            let mut given = Lattice::without_arrays(lattice, steps)?;
            let (u, v) = (&mut lattice.state.displacement, &mut lattice.state.velocity);
            given.positions = positions.as_ptr().cast();
            given.static_limit_squares = lattice.static_limit_squares.as_ptr();
            given.kinetic_impulses = lattice.kinetic_impulses.as_ptr();
            given.flags = lattice.flags.as_ptr();
            (given.ux, given.uy) = (u.x.as_mut_ptr(), u.y.as_mut_ptr());
            (given.vx, given.vy) = (v.x.as_mut_ptr(), v.y.as_mut_ptr());
            given.first_slips = lattice.first_slips.as_mut_ptr();
            given.records = records.as_mut_ptr();
            // SAFETY: every pointer is to an array that lives until the end of this block and has as many
            // elements as the kernel takes from it: one for each block, record and position of a step. No
            // other thread knows them.
            unsafe { slipfront_run_emulated(&raw mut given, 1, self.threads as i32) };
            lattice.motion = given.motion;
            lattice.steps_done += u64::from(steps);
            lattice.records.extend(records);
        }
        Ok(())
    }
}
