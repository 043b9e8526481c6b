//! Exact answers: every law of the model that has a closed solution, on the reference kernel.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

#[path = "../common/mod.rs"]
mod common;

mod energy;
mod first_slip;
mod front_speed;
mod lattice_waves;
mod observables;
mod scale_invariance;
mod shapes;
mod slip_cycle;
mod springs;
mod steady_sliding;
mod straight_groove;
mod symmetry;
mod texture;
