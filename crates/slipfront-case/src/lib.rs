//! Reads users' case files and makes cases that the physics crate [`slipfront`] can run.
//!
//! ```text
//! text -> CaseFile -> Case (valid by construction)
//! ```
//!
//! Each arrow is one function: [`case_file::CaseFile::load`], [`case::Case::new`].

pub mod arrays;
pub mod case;
pub mod case_file;
pub mod extremes;
pub mod field_info;
pub mod nearest;
pub mod quantity;
pub mod same_on_ranks;
pub mod table;
pub mod texture_file;
pub mod xml;

/// BLAKE3 hash of the sources of this crate.
pub const SOURCE_HASH: &str = env!("SLIPFRONT_SOURCE_HASH");
