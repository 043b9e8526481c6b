//! How the processes that share one lattice talk to each other. The physics knows no more of them than this.
//!
//! Each process, a *rank*, holds consecutive rows of the lattice: rank 0 the lowest. Everything that ranks agree on is a
//! maximum or a sum of integers, so that it does not depend on how many they are.

/// The connection of a rank with the others.
pub trait Communicator: Send + Sync {
    /// Number of this rank, from 0.
    fn rank(&self) -> usize;

    /// Number of ranks.
    fn size(&self) -> usize;

    /// Sends `to[0]` to the rank below and `to[1]` to the rank above, and receives `from[0]` from the rank below and `from[1]`
    /// from the rank above, while `meanwhile` runs. The ranks form a ring: the last is below the first. What is empty is neither
    /// sent nor received, and both sides must agree on that.
    fn exchange(&self, to: [&[f64]; 2], from: [&mut [f64]; 2], meanwhile: &mut dyn FnMut());

    /// Replaces every value by the largest that any rank has in its place.
    fn largest(&self, values: &mut [f64]);

    /// Replaces every value by the sum of those that the ranks have in its place, modulo 2^64.
    fn sum(&self, values: &mut [i64]);
}

/// The one rank of a lattice that is not divided.
#[derive(Clone, Copy, Debug, Default)]
pub struct Alone;

impl Communicator for Alone {
    fn rank(&self) -> usize {
        0
    }

    fn size(&self) -> usize {
        1
    }

    fn exchange(&self, to: [&[f64]; 2], [below, above]: [&mut [f64]; 2], meanwhile: &mut dyn FnMut()) {
        below.copy_from_slice(to[1]);
        above.copy_from_slice(to[0]);
        meanwhile();
    }

    fn largest(&self, _: &mut [f64]) {}

    fn sum(&self, _: &mut [i64]) {}
}
