//! Kernels, which advance the state of all blocks by one step.
//!
//! `general/` computes every option, one pass over the blocks per equation; `fused/` computes the common ones
//! in one fast sweep. The [`Simulation`](crate::Simulation) steps the one that its [`Execution`] names,
//! through the functions of `engine.rs`.

mod bands;
pub(crate) mod block;
pub(crate) mod engine;
pub(crate) mod execution;
pub(crate) mod fused;
mod general;
mod vectors;

pub use block::Block;
pub use execution::{Execution, Kernel};
pub use vectors::{SimdWidthError, limit_simd_width, simd_width};
