//! Case files in, results out.
