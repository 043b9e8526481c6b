//! Orders of convergence, on the general kernel.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

#[path = "../common/mod.rs"]
mod common;

use slipfront::Kernel;

/// The kernel of the simulations of this binary.
const KERNEL: Kernel = Kernel::General;

#[path = "../convergence/orders.rs"]
mod orders;
