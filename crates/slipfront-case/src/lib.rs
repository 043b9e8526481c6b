//! Reads the case files of users and makes cases that the physics crate [`slipfront`] can run.
//!
//! ```text
//! text -> CaseFile -> Case (valid by construction)
//! ```
//!
//! Each arrow is one function: [`case_file::CaseFile::load`], [`case::Case::new`].

pub mod arrays;
pub mod case;
pub mod case_file;
pub mod disk;
pub mod field_info;
mod folders;
pub mod machine;
pub mod number_format;
pub mod ordered;
pub mod quantity;
pub mod same;
pub mod text;
pub mod unfinished;

/// BLAKE3 hash of the sources of this crate.
pub const SOURCE_HASH: &str = env!("SLIPFRONT_SOURCE_HASH");
