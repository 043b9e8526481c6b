//! A case is run, and its results are written, read and verified.
//!
//! ```text
//! Case -> Record -> files -> pictures
//! ```
//!
//! Each arrow is one function: [`running::run`], [`results::write`], `pictures::draw` (with the feature `plot`).

pub mod agree;
#[cfg(feature = "plot")]
pub mod budget;
pub mod checkpoint;
pub mod checksum;
pub mod clock;
pub mod columns;
pub mod error;
pub mod fields;
#[cfg(feature = "plot")]
pub mod friction_picture;
mod friction_unit;
mod front;
pub mod leg;
pub mod manifest;
#[cfg(feature = "plot")]
pub mod measured;
#[cfg(feature = "plot")]
pub mod movie;
pub mod names;
pub mod pictures;
pub mod precursors;
pub mod program;
pub mod results;
pub mod resume_command;
pub mod run_folder;
pub mod running;
pub mod series;
pub mod summary;
#[cfg(feature = "plot")]
pub mod texture_file;
pub mod verify;
