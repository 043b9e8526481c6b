//! Sums over blocks that do not all count alike.

use crate::fixed_point;

/// Sum of `weight term` over the blocks; all weights are 1 if there are none.
#[inline(always)]
pub(super) fn weighted_sum(n: usize, weights: Option<&[f64]>, term: impl Fn(usize) -> f64) -> f64 {
    match weights {
        None => fixed_point::sum(n, term),
        Some(weights) => {
            let weights = &weights[..n];
            fixed_point::sum(n, |b| weights[b] * term(b))
        }
    }
}
