//! Case files in, results out.

pub mod arrays;
