//! State that a run needs to continue later with the same bits.
//!
//! A checkpoint is small. The columns are stored next to it: numbers of every block in the order of the
//! lattice, so that they do not depend on how the kernel lays out its arrays, on the number of threads or
//! ranks, or on the SIMD width. They are passed part by part, so that no array of the size of the lattice is
//! copied. The next sweep computes everything else that a kernel keeps.

use serde::{Deserialize, Serialize};
use slipfront_kernel::MotionBounds;

use crate::clock::{Clock, Rest};
use crate::friction::ContactTotals;
use crate::measure::Peak;
use crate::model::Model;
use crate::totals::Totals;

/// A run between two steps, without the numbers of its blocks, which are the columns of the checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Number of steps done.
    pub step: u64,
    /// Number of steps in which the drive moved.
    pub drive_steps: u64,
    /// Number of consecutive steps up to this one in which the drive stood still.
    pub(crate) standing: u64,
    pub(crate) rest: Rest,
    pub(crate) totals: Totals,
    pub(crate) contact: ContactTotals,
    pub(crate) peak: Peak,
    /// Largest square of a contact stress so far.
    pub(crate) stress_square_max: f64,
    /// Bounds on displacements and speeds; present only for the fused kernel.
    pub(crate) motion_bounds: Option<MotionBounds>,
}

impl Checkpoint {
    /// The instant of the checkpoint, with times in steps of `dt_star`.
    pub(crate) fn clock(&self, dt_star: f64) -> Clock {
        Clock {
            step: self.step,
            drive_steps: self.drive_steps,
            standing: self.standing,
            rest: self.rest,
            dt_star,
        }
    }

    /// Whether a run of this model can have these counts of steps.
    pub fn is_consistent_with(&self, model: &Model) -> bool {
        let stood = self.step.checked_sub(self.drive_steps);
        let is_held = model.drive.is_held();
        (self.rest == Rest::Exact || is_held)
            && stood.is_some_and(|stood| self.standing <= stood && (stood == 0 || is_held))
    }
}

impl Model {
    /// Number of columns of a checkpoint; a column holds one number per block.
    pub fn n_columns(&self) -> usize {
        BlockColumn::ALL.len() + self.friction.n_columns()
    }
}

/// A number that is kept for every block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlockColumn {
    /// u_x at t_n.
    DisplacementX,
    /// u_y at t_n.
    DisplacementY,
    /// v_x half a step after t_n for the fused kernel, half a step before t_n for the general kernel, which
    /// evaluates t_n again.
    VelocityX,
    /// v_y at the instant of [`VelocityX`](Self::VelocityX).
    VelocityY,
    /// t* of the first slip; NaN for a block that has not slipped.
    FirstSlip,
    /// One of the [numbers](crate::Friction::n_columns) that the law of friction remembers, counted from 0.
    Memory(usize),
}

impl BlockColumn {
    /// The columns under every law of friction, in the order in which they are passed, before the columns of
    /// the law.
    pub const ALL: [Self; 5] = [
        Self::DisplacementX,
        Self::DisplacementY,
        Self::VelocityX,
        Self::VelocityY,
        Self::FirstSlip,
    ];

    /// Number of blocks in a part of a column.
    const PART: usize = 1 << 16;

    /// Passes all columns of the blocks of a model part by part to `work`: the number of the column, the
    /// column, the first block, and room for the values. Stops at the first error.
    pub(crate) fn for_each_part<E>(
        model: &Model,
        mut work: impl FnMut(usize, Self, usize, &mut [f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        let n_blocks = model.surface.n_blocks();
        let mut values = vec![0.0; n_blocks.min(Self::PART)];
        let of_law = (0..model.friction.n_columns()).map(Self::Memory);
        for (number, column) in Self::ALL.into_iter().chain(of_law).enumerate() {
            for first in (0..n_blocks).step_by(Self::PART) {
                let len = Self::PART.min(n_blocks - first);
                work(number, column, first, &mut values[..len])?;
            }
        }
        Ok(())
    }
}
