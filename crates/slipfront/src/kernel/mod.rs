//! What advances the state of all blocks by one step.
//!
//! `reference/` follows the paper, one pass over the blocks per equation; `fused/` computes the same in one fast sweep.
//! The [`Simulation`](crate::Simulation) steps whichever of the two its [`Execution`] says, through the functions of `engine.rs`.

mod bands;
pub(crate) mod block;
pub(crate) mod engine;
pub(crate) mod execution;
mod fused;
mod reference;
pub(crate) mod totals;

pub use block::Block;
pub use execution::{Execution, Kernel, simd_width};
pub use totals::{ContactTotals, StoredEnergy, Totals};
