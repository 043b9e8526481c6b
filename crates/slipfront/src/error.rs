//! Errors of the physics, each a sentence.

use thiserror::Error;

/// Why a run ended early.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RunError {
    /// Displacements or speeds have become infinite or too large for the computation.
    #[error(
        "the displacement of block ({i}, {j}) is {value:.3e} at step {step}, t* = {time_star:.4}: the run has diverged; reduce \
         the strain epsilon of the load or the time step"
    )]
    NotFinite {
        /// Step at which the divergence was found.
        step: u64,
        /// Dimensionless time of that step.
        time_star: f64,
        /// Column of the block with the largest displacement along an axis; the first such block.
        i: usize,
        /// Row of this block.
        j: usize,
        /// Displacement of this block along this axis, finite or not.
        value: f64,
    },
    /// Some block has slid for too long under a held drive.
    #[error(
        "{n_slipping} blocks in contact still slide at step {step}, t* = {time_star:.1}, after the drive has been stopped for \
         {standing} steps: friction dissipates too little for the slider to come to rest; increase kinetic friction or damping, \
         or use constant loading"
    )]
    NoRest {
        /// Step at which the limit on sliding was exceeded.
        step: u64,
        /// Dimensionless time of that step.
        time_star: f64,
        /// Number of steps in which the drive has stood still.
        standing: u64,
        /// Number of blocks in contact that slide.
        n_slipping: usize,
    },
    /// A run under a held drive has taken more steps than can be counted.
    #[error(
        "the run has reached the maximum of {step} steps; the held drive moved in {drive_steps} of them: increase the drive \
         speed or the time step, or shorten the run"
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

/// Reason why a surface is impossible.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SurfaceError {
    /// Every block is textured.
    #[error(
        "the texture covers all {n_blocks} blocks, so no block is in contact to carry the load: reduce its coverage"
    )]
    NoContact {
        /// Number of blocks.
        n_blocks: usize,
    },
    /// A textured block has no block in contact near enough to take its load.
    #[error(
        "no block in contact is within {distance:.1} blocks of the textured block ({i}, {j}) to carry its load: increase the \
         distance `within`, or make the texture smaller"
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
