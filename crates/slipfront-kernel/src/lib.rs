//! The vector kernel of slipfront: the equations of its model in one sweep over the blocks, and what they are
//! made of: the lattice with its springs, and sums that do not depend on order.
//!
//! Blocks are stored row after row in one array ([`Layout`]), divided into tiles of 256 elements. A sweep
//! advances one tile after the other by a step ([`Band`]): displacements, springs, friction and all sums,
//! eight blocks at a time (`blocks.rs`), each spring once. Spring forces are computed from a series where
//! this is as exact as the square root (`springs.rs`). A tile at rest with nothing moving around it is
//! skipped until one of its blocks can slip (`rest.rs`). Every thread sweeps a band of tiles.
//!
//! A step must read displacement, velocity and two thresholds of every block and write displacement and
//! velocity: 80 bytes. This bounds the speed on a lattice larger than the cache. Spring forces pass through a
//! ring buffer that stays in the cache.
//!
//! The kernel is a crate of its own because its sweep, compiled for each formula of springs and each width of
//! vectors, takes longer to compile than all else of the physics. It knows no law of friction, observer or
//! texture: the crate slipfront gives it arrays ([`Properties`]), and calls it from its `kernel/fused/`.

// Its unit tests leave out what compiles the sweep a second time.
#![cfg_attr(test, allow(dead_code))]

pub mod communicator;
pub mod fixed_point;
pub mod lattice;
pub mod reductions;

mod aligned;
mod band;
mod blocks;
mod integrator;
mod interface;
mod layout;
mod motion_bounds;
mod properties;
mod pull;
mod quanta;
mod response;
mod rest;
mod schedule;
mod scratch;
mod sparse;
mod springs;
mod step;
#[cfg(not(test))]
mod stress;
#[cfg(not(test))]
mod sweep;
mod thresholds;
mod upright_sheet;
mod variations;
mod vector;

pub use aligned::{Aligned, Vectors};
pub use band::{Band, NEVER, TileState, TileTask, halo};
pub use blocks::Sums;
pub use integrator::{Integrator, SMALLEST_VELOCITY};
pub use layout::{Layout, TILE, VECTORS};
pub use motion_bounds::MotionBounds;
pub use properties::{Block, Blocks, Properties};
pub use quanta::Quanta;
pub use response::{Join, SurfaceResponse, Threads, next_side};
pub use schedule::SweepConditions;
pub use springs::series_coefficients;
pub use step::Step;
#[cfg(not(test))]
pub use stress::{OfTile, Stress, StressReader};
#[cfg(not(test))]
pub use sweep::{Springs, measure_displacements, sweep};
pub use thresholds::{ChangingLaw, FallWithSlip, FallWithSpeed, Thresholds};
pub use variations::LargestFactors;
pub use vector::{LANES, vectorized};

/// BLAKE3 hash of the sources of this crate.
pub const SOURCE_HASH: &str = env!("SLIPFRONT_SOURCE_HASH");
