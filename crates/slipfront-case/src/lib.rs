//! Case files in, results out.

pub mod arrays;
pub mod fields;
