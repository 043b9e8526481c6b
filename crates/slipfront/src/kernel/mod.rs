//! What advances the state of all blocks by one step.
//!
//! `reference.rs` follows the paper, one pass over the blocks per equation; `fused/` computes the same in one fast sweep.
//! `engine.rs` holds whichever of the two a run uses, and the [`Simulation`](crate::Simulation) steps it.

pub(crate) mod block;
pub(crate) mod block_column;
pub(crate) mod engine;
pub(crate) mod execution;
mod fused;
mod reference;
pub(crate) mod strain_bound;
pub(crate) mod totals;

pub use block::Block;
pub use block_column::BlockColumn;
pub use execution::{Execution, Kernel, simd_width};
pub use totals::{StoredEnergy, Totals};
