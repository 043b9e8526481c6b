//! Two-dimensional lattice spring-block model of the transition from static to kinetic friction.
//!
//! A slider of `nx` x `ny` blocks lies on a rigid plane. Each block is pulled at constant speed by its own
//! spring, and springs between each block and its eight neighbours hold the slider together. Every block
//! obeys Amontons-Coulomb friction with its own coefficients; blocks over a texture (a cavity, a groove) have
//! no contact with the plane. The model is that of Tribology International (2023), doi
//! 10.1016/j.triboint.2023.108866, with the numbered deviations D1... that the project's book explains.
//!
//! This crate is the physics alone: no files, no terminal, no clock. Everything is dimensionless: lengths in
//! blocks, masses in blocks, time in `l sqrt(rho/E)`, displacements in `P mu_s l^2/(E h)`, forces in
//! `P mu_s l^2`; all conversions are in [`scales`].
//!
//! ```
//! use slipfront::{Drive, Execution, FrictionLaw, Lattice, Model, Simulation, Stop, Surface};
//!
//! let lattice = Lattice::free(5, 5);
//! let surface = Surface::uniform(&lattice, 1.0, 0.5);
//! let model = Model::new(lattice, surface, Drive::along_x(0.03), 0.1 * 0.75_f64.sqrt(), 1e-6, FrictionLaw::Projection);
//! let mut simulation = Simulation::new(model, 0.1, None, Execution::default());
//! simulation.run(Stop::at_step(1000), &mut []).unwrap();
//! // A uniform lattice slips as one block, when the force of its drive springs reaches the threshold: t* = (8/3)/V*.
//! assert!((simulation.peak().time_star - 8.0 / 3.0 / 0.03).abs() < 0.2);
//! ```

pub mod block_sets;
pub mod checkpoint;
pub mod device;
pub mod exact_solutions;
pub mod kernel;
pub mod observe;
pub mod parallel;
pub mod scales;
pub mod stability;
pub mod surface;
pub mod testing;

mod body;
mod clock;
mod critical_size;
mod dead_load;
mod drive;
mod elementary;
mod error;
mod forces;
mod friction;
mod measure;
mod model;
mod moduli;
mod onset;
mod position_bins;
mod simulation;
mod slider;
mod snapshot;
mod state;
mod stop;
mod strength;
mod totals;
mod vector_field;

pub use slipfront_kernel::{communicator, lattice};

pub use body::{Body, Face};
pub use checkpoint::Checkpoint;
pub use communicator::Communicator;
pub use dead_load::{DeadLoad, LoadField};
pub use drive::{Drive, Loading, Program, Rotation, Segment};
pub use error::{RunError, SurfaceError};
pub use friction::*;
pub use kernel::{Execution, Kernel, SimdWidthError, limit_simd_width, simd_width};
pub use lattice::{Edge, Edges, Lattice};
pub use model::{Model, ONSET_PATH};
pub use position_bins::PositionBins;
pub use scales::Scales;
pub use simulation::Simulation;
pub use slider::{DriveSprings, Outline, Slider};
pub use slipfront_kernel::next_side;
pub use snapshot::Snapshot;
pub use state::State;
pub use stop::{Stop, StopReason};
pub use strength::{Increments, REFINEMENT, Search, SearchOutcome, speed_of_increments};
pub use surface::Surface;
pub use totals::{StoredEnergy, Totals};
pub use vector_field::VectorField;

/// BLAKE3 hash of the sources of this crate. Programs with the same hash give the same bits.
pub const SOURCE_HASH: &str = env!("SLIPFRONT_SOURCE_HASH");
/// BLAKE3 hash of the sources of the vector kernel.
pub use slipfront_kernel::SOURCE_HASH as KERNEL_SOURCE_HASH;
