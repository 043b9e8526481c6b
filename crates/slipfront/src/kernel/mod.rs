//! Kernels, which advance the state of all blocks by one step.
//!
//! `general/` computes every option, one pass over the blocks per equation; `fused/` computes the common
//! options in one fast sweep. The [`Simulation`](crate::Simulation) uses the kernel of its [`Execution`]
//! through the functions of `engine.rs`, or `replay.rs` for steps that a [`Device`](crate::device::Device)
//! has computed.

mod bands;
pub(crate) mod block;
mod device_lattice;
mod device_test;
pub(crate) mod engine;
pub(crate) mod execution;
pub(crate) mod fused;
mod general;
pub(crate) mod replay;
pub(crate) mod vectors;

pub use block::Block;
pub use execution::{Execution, Kernel};
pub use vectors::{SimdWidthError, limit_simd_width, simd_width};
