//! Errors of the physics, each a sentence.

use thiserror::Error;

/// Why a run ended early.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RunError {
    /// Displacements or speeds have become infinite or too large to compute with.
    #[error(
        "the displacement of block ({i}, {j}) is {value:.3e} at step {step}, t* = {time_star:.4}: the run has diverged; \
         lower the load's strain epsilon or the time step"
    )]
    NotFinite {
        /// Step at which the run was found to diverge.
        step: u64,
        /// Dimensionless time of that step.
        time_star: f64,
        /// Column of the block that is displaced farthest along an axis, the first of equal ones.
        i: usize,
        /// Row of the block that is displaced farthest.
        j: usize,
        /// Displacement of this block along this axis, finite or not.
        value: f64,
    },
    /// Under a drive that is held some block has slid for too long.
    #[error(
        "{n_slipping} blocks in contact still slide at step {step}, t* = {time_star:.1}, after the drive has stood still for {standing} steps: \
         friction takes too little for the slider to come to rest; raise its kinetic friction or damping, or take constant loading"
    )]
    NoRest {
        /// Step at which the limit on sliding was passed.
        step: u64,
        /// Dimensionless time of that step.
        time_star: f64,
        /// Steps for which the drive has stood still.
        standing: u64,
        /// Blocks in contact that slide.
        n_slipping: usize,
    },
    /// A run under a drive that is held has taken more steps than can be counted.
    #[error(
        "the run has taken {step} steps, the most that there may be, in {drive_steps} of which the held drive has moved: raise the speed of the \
         drive or the time step, or shorten the run"
    )]
    TooManySteps {
        /// Number of steps done.
        step: u64,
        /// Number of steps in which the drive has moved.
        drive_steps: u64,
    },
    /// An observer failed.
    #[error("{0}")]
    Observer(String),
}

/// Why a surface is impossible.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SurfaceError {
    /// Every block is textured.
    #[error(
        "the texture covers all {n_blocks} blocks, so that nothing is left in contact to carry the load: \
         reduce its coverage"
    )]
    NoContact {
        /// Number of blocks.
        n_blocks: usize,
    },
    /// The load of a textured block has no block in contact near it that takes it.
    #[error(
        "no block in contact is within {distance:.1} blocks of block ({i}, {j}), which is textured and leaves its load to such blocks: raise the \
         distance within which load is shared, or make the texture smaller"
    )]
    NoContactNear {
        /// Column of the block.
        i: usize,
        /// Row of the block.
        j: usize,
        /// The distance, in blocks.
        distance: f64,
    },
}
