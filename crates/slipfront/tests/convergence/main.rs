//! Orders of convergence, on the fused kernel. `convergence_on_general` runs these tests on the general
//! kernel.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

#[path = "../common/mod.rs"]
mod common;

use slipfront::Kernel;

/// The kernel of the simulations of this binary.
const KERNEL: Kernel = Kernel::Fused;

mod orders;
