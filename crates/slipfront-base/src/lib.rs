//! Everything that the crates of slipfront need below a case: files that are complete or absent, numbers and
//! texts for people, and the memory and the disk of the machine.

pub mod disk;
mod folders;
pub mod machine;
pub mod number_format;
pub mod ordered;
pub mod text;
pub mod unfinished;

/// BLAKE3 hash of the sources of this crate.
pub const SOURCE_HASH: &str = env!("SLIPFRONT_SOURCE_HASH");
