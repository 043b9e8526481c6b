//! Exact answers and orders of convergence of `physics`, on the general kernel.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.
#![allow(clippy::needless_pass_by_value)] // Values of a test are passed to it as they are written.

#[path = "../common/mod.rs"]
mod common;

use slipfront::Kernel;

/// The kernel of the simulations of this test binary.
const KERNEL: Kernel = Kernel::General;

#[path = "../physics/composite.rs"]
mod composite;
#[path = "../physics/convergence.rs"]
mod convergence;
#[path = "../physics/dead_load.rs"]
mod dead_load;
#[path = "../physics/energy.rs"]
mod energy;
#[path = "../physics/events.rs"]
mod events;
#[path = "../physics/first_slip.rs"]
mod first_slip;
#[path = "../physics/front_speed.rs"]
mod front_speed;
#[path = "../physics/graded.rs"]
mod graded;
#[path = "../physics/held.rs"]
mod held;
#[path = "../physics/lattice_waves.rs"]
mod lattice_waves;
#[path = "../physics/load_and_adhesion.rs"]
mod load_and_adhesion;
#[path = "../physics/observables.rs"]
mod observables;
#[path = "../physics/oracle_sliders.rs"]
mod oracle_sliders;
#[path = "../physics/outline.rs"]
mod outline;
#[path = "../physics/scale_invariance.rs"]
mod scale_invariance;
#[path = "../physics/shapes.rs"]
mod shapes;
#[path = "../physics/slip_cycle.rs"]
mod slip_cycle;
#[path = "../physics/stability.rs"]
mod stability;
#[path = "../physics/steady_sliding.rs"]
mod steady_sliding;
#[path = "../physics/straight_groove.rs"]
mod straight_groove;
#[path = "../physics/symmetry.rs"]
mod symmetry;
#[path = "../physics/texture.rs"]
mod texture;
#[path = "../physics/viscosity.rs"]
mod viscosity;
