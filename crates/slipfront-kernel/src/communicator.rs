//! Communication between the processes that share one lattice. The physics knows nothing else about other
//! processes.
//!
//! Each process, a *rank*, holds consecutive rows of the lattice, rank 0 the lowest. Everything that ranks
//! agree on is a maximum or a sum of integers, so that it does not depend on the number of ranks.

use std::fmt::Debug;

/// The connection of a rank to the other ranks.
pub trait Communicator: Debug + Send + Sync {
    /// Number of this rank, from 0.
    fn rank(&self) -> usize;

    /// Number of ranks.
    fn size(&self) -> usize;

    /// Sends `to[0]` to the rank below and `to[1]` to the rank above, and receives `from[0]` from the rank
    /// below and `from[1]` from the rank above, while `meanwhile` runs. The ranks form a ring: the last is
    /// below the first. Empty slices are neither sent nor received, and both sides must agree on which are
    /// empty.
    fn exchange(&self, to: [&[f64]; 2], from: [&mut [f64]; 2], meanwhile: &mut dyn FnMut());

    /// Replaces every value by the maximum over all ranks of the values at its index.
    fn largest(&self, values: &mut [f64]);

    /// Replaces every value by its sum over all ranks, modulo 2^64.
    fn sum(&self, values: &mut [i64]);

    /// The largest of the values of all ranks.
    fn largest_of(&self, value: f64) -> f64 {
        let mut largest = [value];
        self.largest(&mut largest);
        largest[0]
    }

    /// The least of the values of all ranks.
    fn least_of(&self, value: f64) -> f64 {
        -self.largest_of(-value)
    }

    /// The sum of the numbers of all ranks.
    fn sum_of(&self, number: usize) -> usize {
        let mut sum = [number as i64];
        self.sum(&mut sum);
        sum[0] as usize
    }
}

/// The lowest rank on which `is_so` is true, returned on all ranks; none if it is true on none.
///
/// ```
/// use slipfront_kernel::communicator::{Alone, lowest_rank};
///
/// assert_eq!([true, false].map(|is_so| lowest_rank(&Alone, is_so)), [Some(0), None]);
/// ```
pub fn lowest_rank(communicator: &dyn Communicator, is_so: bool) -> Option<usize> {
    let (rank, size) = (communicator.rank(), communicator.size());
    // Counted from above, so that the lowest rank has the largest number.
    let from_above = communicator.largest_of(if is_so { (size - rank) as f64 } else { 0.0 });
    (from_above > 0.0).then(|| size - from_above as usize)
}

/// Sends the text of one `rank` to all ranks; the texts of the other ranks are ignored.
pub fn text_of(communicator: &dyn Communicator, rank: usize, text: &str) -> String {
    let own = if communicator.rank() == rank { text } else { "" };
    let mut words = vec![0; communicator.sum_of(own.len())];
    for (word, byte) in words.iter_mut().zip(own.bytes()) {
        *word = i64::from(byte);
    }
    communicator.sum(&mut words);
    let bytes: Vec<u8> = words.into_iter().map(|word| word as u8).collect();
    String::from_utf8_lossy(&bytes).into_owned()
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
