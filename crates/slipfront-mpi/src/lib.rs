//! One lattice over many processes, on one machine or many: the command of slipfront on MPI ranks.
//!
//! The other crates do all computation, printing and writing. They see the connection to other ranks as a
//! [`slipfront::Communicator`], which this crate implements.

mod communicator;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::sync::Arc;

use mpi::Threading;
use mpi::environment::initialize_with_threading;
use mpi::traits::Communicator as _;

pub use self::communicator::MpiCommunicator;

/// The status with which Rust ends a program that panics.
const PANICKED: i32 = 101;

/// Runs `work` on every rank, and returns the exit status of the process. `work` is called once, on the main
/// thread. A rank that panics aborts all ranks, because the others would wait for it for ever.
pub fn on_ranks(work: impl FnOnce(Arc<MpiCommunicator>) -> ExitCode) -> ExitCode {
    let Some((universe, threading)) = initialize_with_threading(Threading::Funneled) else {
        panic!("MPI is initialized already");
    };
    let communicator = Arc::new(MpiCommunicator::world());
    let done = catch_unwind(AssertUnwindSafe(|| {
        assert!(
            threading >= Threading::Funneled,
            "this MPI library has no support of threads (MPI_THREAD_FUNNELED)"
        );
        work(communicator)
    }));
    // The error has already been printed where it occurred.
    done.unwrap_or_else(|_| universe.world().abort(PANICKED))
}
