//! Connection of a rank to the others through MPI.

use std::thread::{self, ThreadId};

use mpi::Tag;
use mpi::collective::SystemOperation;
use mpi::request;
use mpi::topology::{Process, SimpleCommunicator};
use mpi::traits::{Communicator as _, CommunicatorCollectives, Destination, Source};
use slipfront::Communicator;

/// Tags distinguish messages to the rank below from messages to the rank above: with two ranks, each is both
/// the lower and the upper neighbour of the other.
const DOWN: Tag = 0;
const UP: Tag = 1;

/// The ranks started together with this one.
///
/// The connection belongs to the thread that initialized MPI, and all MPI calls must be made on that thread.
#[derive(Debug)]
pub struct MpiCommunicator {
    owner: ThreadId,
    rank: usize,
    size: usize,
}

impl MpiCommunicator {
    /// All ranks. MPI must be initialized.
    pub(crate) fn world() -> Self {
        let world = SimpleCommunicator::world();
        Self {
            owner: thread::current().id(),
            rank: world.rank() as usize,
            size: world.size() as usize,
        }
    }

    /// The MPI handle. Only the thread that initialized MPI may use it.
    fn handle(&self) -> SimpleCommunicator {
        let here = thread::current().id();
        assert_eq!(
            here, self.owner,
            "only the thread that initialized MPI may call it"
        );
        SimpleCommunicator::world()
    }
}

/// The rank that is `up` ranks above this one on the ring.
fn neighbour(world: &SimpleCommunicator, up: i32) -> Process<'_> {
    world.process_at_rank((world.rank() + up).rem_euclid(world.size()))
}

impl Communicator for MpiCommunicator {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn exchange(&self, to: [&[f64]; 2], from: [&mut [f64]; 2], meanwhile: &mut dyn FnMut()) {
        let world = self.handle();
        let [below, above] = [neighbour(&world, -1), neighbour(&world, 1)];
        let ([to_below, to_above], [from_below, from_above]) = (to, from);
        request::scope(|scope| {
            // Receives are posted before sends, so that MPI needs no buffers for messages that arrive early.
            let receives = [(below, from_below, UP), (above, from_above, DOWN)].map(|(rank, values, tag)| {
                (!values.is_empty()).then(|| rank.immediate_receive_into_with_tag(scope, values, tag))
            });
            let sends = [(below, to_below, DOWN), (above, to_above, UP)].map(|(rank, values, tag)| {
                (!values.is_empty()).then(|| rank.immediate_send_with_tag(scope, values, tag))
            });
            meanwhile();
            for request in receives.into_iter().chain(sends).flatten() {
                request.wait();
            }
        });
    }

    fn largest(&self, values: &mut [f64]) {
        let own = values.to_vec();
        self.handle()
            .all_reduce_into(&own[..], values, SystemOperation::max());
    }

    fn sum(&self, values: &mut [i64]) {
        // C defines sums of unsigned numbers modulo 2^64.
        let own: Vec<u64> = values.iter().map(|value| value.cast_unsigned()).collect();
        let mut sums = vec![0_u64; own.len()];
        self.handle()
            .all_reduce_into(&own[..], &mut sums[..], SystemOperation::sum());
        for (value, sum) in values.iter_mut().zip(sums) {
            *value = sum.cast_signed();
        }
    }
}
