//! Loops on the threads of rayon's pool.

pub use rayon::prelude::*;
pub use rayon::{current_num_threads, join};

/// Combines all elements, in any order; `identity` returns the neutral element.
pub fn reduce<I: ParallelIterator>(
    elements: I,
    identity: impl Fn() -> I::Item + Sync + Send,
    combine: impl Fn(I::Item, I::Item) -> I::Item + Sync + Send,
) -> I::Item {
    elements.reduce(identity, combine)
}
