//! Case files in, results out.

pub mod pictures;
