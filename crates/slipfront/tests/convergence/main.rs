//! Orders of convergence, on the fused kernel. The same on the reference kernel: `convergence_on_reference`.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

#[path = "../common/mod.rs"]
mod common;

use slipfront::Kernel;

/// What steps the simulations of this binary.
const KERNEL: Kernel = Kernel::Fused;

mod orders;
