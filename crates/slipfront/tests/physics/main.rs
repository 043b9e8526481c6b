//! Exact answers: every law of the model that has a closed solution, orders of convergence, and claims of the
//! paper, on the fused kernel. `physics_on_general` runs the tests that apply to both kernels on the general
//! kernel.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.
#![allow(clippy::needless_pass_by_value)] // Values of a test are passed to it as they are written.

#[path = "../common/mod.rs"]
mod common;

use slipfront::Kernel;

/// The kernel of the simulations of this test binary.
const KERNEL: Kernel = Kernel::Fused;

mod ageing;
mod composite;
mod contact_springs;
mod convergence;
mod correlated;
mod dead_load;
mod driven_fronts;
mod edge_drive;
mod energy;
mod events;
mod first_slip;
mod front_speed;
mod graded;
mod growth;
mod held;
mod interface;
mod kymograph;
mod lattice_waves;
mod load_and_adhesion;
mod observables;
mod oracle_drive;
mod oracle_friction;
mod oracle_sliders;
mod outline;
mod paper;
mod program;
mod rate_and_state;
mod scale_invariance;
mod screening;
mod shapes;
mod slip_cycle;
mod slip_weakening;
mod springs;
mod stability;
mod steady_sliding;
mod straight_groove;
mod symmetry;
mod texture;
mod torsion;
mod viscosity;
mod weakening;
