//! Sums over blocks that do not all count alike.

use crate::communicator::Communicator;
use crate::fixed_point::sum_over;

/// Sum of `weight term` over the blocks of all ranks; all weights are 1 if there are none.
#[inline(always)]
pub(super) fn weighted_sum(
    ranks: &dyn Communicator,
    n: usize,
    weights: Option<&[f64]>,
    term: impl Fn(usize) -> f64,
) -> f64 {
    match weights {
        None => sum_over(ranks, n, term),
        Some(weights) => {
            let weights = &weights[..n];
            sum_over(ranks, n, |b| weights[b] * term(b))
        }
    }
}
