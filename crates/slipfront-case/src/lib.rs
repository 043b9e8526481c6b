//! Case files in, results out: everything between a user's text and the physics of [`slipfront`].
//!
//! ```text
//! text -> CaseFile -> Case (valid by construction) -> Record -> files -> pictures
//! ```
//!
//! Each arrow is one function: [`case_file::CaseFile::load`], [`case::Case::new`], [`run::run`],
//! [`results::write`], [`results::draw`].

pub mod arrays;
pub mod budget;
pub mod case;
pub mod case_file;
pub mod checkpoint;
pub mod fields;
pub mod folder;
mod legible;
pub mod manifest;
pub mod paper;
pub mod quantity;
pub mod results;
pub mod run;
pub mod series;
pub mod study;
pub mod summary;
pub mod verify;

pub use slipfront_plot as pictures;
