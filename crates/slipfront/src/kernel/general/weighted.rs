//! Sums over blocks with a weight for each block.

use crate::vector_field::VectorField;
use slipfront_kernel::fixed_point::RunningSum;

/// Room for values of the blocks of a part.
#[derive(Debug)]
pub(super) struct WeightedScratch {
    /// Velocities at t_n.
    pub(super) velocity: VectorField,
    pub(super) terms: Vec<f64>,
    pub(super) products: Vec<f64>,
}

impl WeightedScratch {
    pub(super) fn new(n_blocks: usize) -> Self {
        Self {
            velocity: VectorField::zeros(n_blocks),
            terms: vec![0.0; n_blocks],
            products: vec![0.0; n_blocks],
        }
    }
}

/// Adds a term for each of some blocks times its weight; without weights all are 1. The sum has room for the
/// products.
#[inline(always)]
pub(super) fn add_weighted(
    sum: &mut RunningSum,
    terms: &[f64],
    weights: Option<&[f64]>,
    products: &mut [f64],
) {
    match weights {
        None => sum.add(terms),
        Some(weights) => {
            let n = terms.len();
            let (weights, products) = (&weights[..n], &mut products[..n]);
            for k in 0..n {
                products[k] = weights[k] * terms[k];
            }
            sum.add(products);
        }
    }
}

/// Products of vectors of some blocks, `a_x b_x + a_y b_y`.
#[inline(always)]
pub(super) fn dot_products(a: [&[f64]; 2], b: [&[f64]; 2], products: &mut [f64]) {
    let n = products.len();
    let ([ax, ay], [bx, by]) = (a.map(|a| &a[..n]), b.map(|b| &b[..n]));
    for k in 0..n {
        products[k] = ax[k] * bx[k] + ay[k] * by[k];
    }
}
