//! Kernel ridge regression of an unknown on many numbers, with leave-one-out residuals, and distances between
//! points.
//!
//! This crate is separate from the calibrations that use it because it solves systems of thousands of
//! equations: unlike them, it is compiled for speed.

mod dense;
mod fit;
#[cfg(test)]
mod for_tests;
mod parameters;
mod regression;
mod sample_distance;

pub use dense::{least_squares, squared_distances};
pub use regression::{Prediction, Regression};
pub use sample_distance::{Distance, distance_from};
