//! One lattice over many processes, on one machine or many: the command of slipfront on the ranks of MPI.
//!
//! All computation, printing and writing is in the other crates. They know a rank's connection with the
//! others as [`slipfront::Communicator`]; this crate makes it.

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

/// Runs `work` on every rank, and returns the status of the process. The function is called once, on the main
/// thread. A rank that panics takes the others with it, where they would wait for it without an end.
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
    // What went wrong has been printed where it did.
    done.unwrap_or_else(|_| universe.world().abort(PANICKED))
}
