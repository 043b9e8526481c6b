//! Fuzz targets: one for every parser, each defined once.
//!
//! A [`Target`] takes any bytes and panics when a parser does something that it must not: panic itself, give
//! an error message that cannot be read, take more memory or processor time than its limit, or read something
//! that does not survive writing and reading again. `cargo test` runs all targets on seeds, earlier findings
//! and a fixed number of mutations (`tests/replay.rs`); libFuzzer runs one of them for hours (`run.sh`).

// Checks fail by panicking.
#![allow(clippy::unwrap_used)]

mod checks;
pub mod inputs;
mod long;
mod memory;
mod mutate;
mod scratch;
mod target;
mod targets;
mod time;

pub use long::LONG_BYTES;
pub use mutate::Mutator;
pub use target::Target;
pub use targets::{TARGETS, named};
