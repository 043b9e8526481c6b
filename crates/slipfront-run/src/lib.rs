//! Runs a case, and writes, reads and verifies its results.
//!
//! ```text
//! Case -> RunData -> files -> pictures
//! ```
//!
//! Each arrow is one function: [`running::run`] ([`run_summary::run_summary`] if only the numbers are
//! wanted), [`results::write`], `pictures::complete` (with the feature `plot`), which also writes the
//! manifest.

pub mod agree;
pub mod checkpoint;
pub mod checksum;
pub mod clock;
pub mod columns;
#[cfg(not(target_family = "wasm"))]
pub mod device;
pub mod error;
pub mod estimate_cost;
pub mod export;
pub mod fields;
mod final_state;
pub mod folder_error;
mod friction_unit;
mod front;
pub mod instrument;
pub mod interpolation;
pub mod leg;
pub mod manifest;
pub mod measured;
pub mod names;
pub mod observers;
#[cfg(feature = "plot")]
pub mod pictures;
pub mod program;
pub mod results;
pub mod resume_command;
pub mod run_copy;
pub mod run_curve;
pub mod run_files;
pub mod run_folder;
pub mod run_summary;
mod run_warnings;
pub mod running;
pub mod series;
mod shared_file;
pub mod summary;
mod summary_observers;
pub mod times;
pub mod verify;
