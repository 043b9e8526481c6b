//! Bulk bodies against references that do not use the engine.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

#[allow(dead_code)] // Each program uses its own part of it.
mod dimples;
mod fourier;
mod half_space;
mod layer;
mod reductions;
mod springs;
