//! Kernel ridge regression of an unknown on many numbers, with the residuals of samples that are left out,
//! and distances between points.
//!
//! It stands apart from the calibrations that use it since it solves systems of thousands of equations: it is
//! compiled for speed, and they are not.

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
