//! Case files in, results out.

pub mod case_file;
pub mod quantity;
