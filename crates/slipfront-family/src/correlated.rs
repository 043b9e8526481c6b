//! Spatially correlated coefficients.

use std::f64::consts::PI;

use slipfront::Lattice;
use slipfront::surface::{Coefficients, CorrelatedField, Distribution, deviation_along};

use crate::chapter::Chapter;
use crate::error::FamilyError;

/// Seeds over which correlations are measured.
const SEEDS: u16 = 10_000;
/// Correlation length for the measured correlations, in blocks.
const LENGTH: f64 = 2.0;
/// Number of blocks in a row for the measured correlations.
const BLOCKS: u8 = 6;

/// The field itself, as static coefficients with a mean of 0 and a standard deviation of 1.
fn drawn(lattice: &Lattice, length: f64, seed: u64) -> Vec<f64> {
    let unit = Distribution {
        mean: 0.0,
        deviation: 1.0,
    };
    let field = CorrelatedField::new(lattice, length);
    Coefficients::draw_correlated(&field, &(0..lattice.ny), unit, unit, seed).mu_static
}

/// Covariance along an axis of the means over two blocks that are `n` apart.
fn covariance(n: f64) -> f64 {
    let a = LENGTH;
    let twice = |s: f64| 0.5 * a * (PI.sqrt() * s * libm::erf(s / a) + a * libm::exp(-(s / a).powi(2)));
    twice(n + 1.0) - 2.0 * twice(n) + twice(n - 1.0)
}

/// Largest difference between a block and the mean of its four parts, on a slider of 12 x 10 blocks.
fn largest_difference(length: f64) -> f64 {
    let (nx, ny) = (12, 10);
    let parents = drawn(&Lattice::free(nx, ny), length, 1);
    let children = drawn(&Lattice::free(2 * nx, 2 * ny), 2.0 * length, 1);
    let difference = |(b, parent): (usize, &f64)| {
        let first = 4 * nx * (b / nx) + 2 * (b % nx);
        let parts = [first, first + 1, first + 2 * nx, first + 2 * nx + 1];
        (parts.map(|part| children[part]).iter().sum::<f64>() / 4.0 - parent).abs()
    };
    parents.iter().enumerate().map(difference).fold(0.0, f64::max)
}

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    for length in [0.25, 1.0, 5.0] {
        let field = CorrelatedField::new(&Lattice::free(25, 25), length);
        chapter.add(
            format!("variance of block means, ξ = {length} l"),
            [deviation_along(length).powi(4), field.variance_of_blocks()],
            2e-9,
            "oscillation by 2 exp(-9π²/4) along each axis within the node spacing",
        );
    }
    for length in [0.25, 1.0, 5.0] {
        chapter.add(
            format!("largest difference between a block mean and the mean of its parts, ξ = {length} l"),
            [0.0, largest_difference(length)],
            1e-13,
            "sum of about 700 differences of error functions, each rounded to 1e-16",
        );
    }
    let lattice = Lattice::free(usize::from(BLOCKS), 1);
    let mut products = [0.0; BLOCKS as usize];
    for seed in 0..u64::from(SEEDS) {
        let field = drawn(&lattice, LENGTH, seed);
        for (product, mean) in products.iter_mut().zip(&field) {
            *product += field[0] * mean;
        }
    }
    for (n, product) in (0..BLOCKS).zip(products) {
        let exact = covariance(f64::from(n)) / covariance(0.0);
        let found = product / f64::from(SEEDS) / covariance(0.0).powi(2);
        chapter.add(
            format!("correlation of block means at a distance of {n} l, ξ = {LENGTH} l"),
            [exact, found],
            5.0 * ((1.0 + exact * exact) / f64::from(SEEDS)).sqrt(),
            "five standard errors of a product of normal variates over the seeds 0 to 9999",
        );
    }
    Ok(())
}
