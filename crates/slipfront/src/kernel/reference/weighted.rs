//! Sums over blocks that do not all count alike.

use crate::fixed_point::RunningSum;

/// Adds `weight term(k)` of `n` blocks; all weights are 1 if there are none.
#[inline(always)]
pub(super) fn add_weighted(
    sum: &mut RunningSum,
    n: usize,
    weights: Option<&[f64]>,
    term: impl Fn(usize) -> f64,
) {
    match weights {
        None => sum.add(n, term),
        Some(weights) => {
            let weights = &weights[..n];
            sum.add(n, |k| weights[k] * term(k));
        }
    }
}
