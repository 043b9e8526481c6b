//! Whichever kernel a run uses, behind one set of functions.

use super::block::Block;
use super::execution::{Execution, Kernel};
use super::fused::Fused;
use super::reference::Reference;
use super::strain_bound::StrainBound;
use super::totals::Totals;
use crate::checkpoint::Checkpoint;
use crate::field::Field;
use crate::model::Model;
use crate::state::State;

/// A kernel with its state. Functions that take the number of the step mean the present one, unless they advance to it.
#[derive(Debug)]
pub(crate) enum Engine {
    Reference(Box<Reference>),
    Fused(Box<Fused>),
}

impl Engine {
    /// Begins in a given state, or at rest.
    pub(crate) fn new(model: &Model, dt_star: f64, state: Option<State>, execution: Execution) -> Self {
        let Execution { threads, skips, .. } = execution;
        match execution.kernel.for_law(model.law) {
            Kernel::Fused => {
                let kernel = Fused::new(model, dt_star, state.as_ref(), threads, skips);
                Self::Fused(Box::new(kernel))
            }
            Kernel::Reference => {
                let state = state.unwrap_or_else(|| State::at_rest(model.lattice.n_blocks()));
                Self::Reference(Box::new(Reference::new(model, dt_star, state)))
            }
        }
    }

    /// Continues from a checkpoint; none if it is that of another lattice or kernel.
    pub(crate) fn resume(
        model: &Model,
        dt_star: f64,
        checkpoint: Checkpoint,
        execution: Execution,
    ) -> Option<Self> {
        if !checkpoint.has_blocks(model.lattice.n_blocks()) {
            return None;
        }
        let Execution { threads, skips, .. } = execution;
        match (execution.kernel.for_law(model.law), checkpoint.strain_bound) {
            (Kernel::Fused, Some(bound)) => {
                let kernel = Fused::resume(model, dt_star, checkpoint, bound, threads, skips);
                Some(Self::Fused(Box::new(kernel)))
            }
            (Kernel::Reference, None) => {
                let kernel = Reference::resume(model, dt_star, checkpoint);
                Some(Self::Reference(Box::new(kernel)))
            }
            _ => None,
        }
    }

    /// Advances to step `number`: the next one, or 0 to begin with.
    pub(crate) fn step(&mut self, model: &Model, number: u64, energies: bool) -> Totals {
        match self {
            Self::Reference(kernel) => kernel.step(model, number, energies),
            Self::Fused(kernel) => kernel.step(model, number, energies),
        }
    }

    /// Block `b` with the forces on it.
    pub(crate) fn block(&self, model: &Model, number: u64, b: usize) -> Block {
        match self {
            Self::Reference(kernel) => kernel.block(b),
            Self::Fused(kernel) => kernel.block(model, number, b),
        }
    }

    /// Values of `field` in every `stride`-th row, several blocks of a row at a time: `write` is given the row, the column
    /// of the first value, and the values.
    pub(crate) fn read_rows(
        &self,
        model: &Model,
        number: u64,
        field: Field,
        stride: usize,
        write: impl FnMut(usize, usize, &[f32]),
    ) {
        match self {
            Self::Reference(kernel) => kernel.read_rows(model, field, stride, write),
            Self::Fused(kernel) => kernel.read_rows(model, number, field, stride, write),
        }
    }

    /// Displacement now and velocity half a step later of block `b`.
    pub(crate) fn motion(&self, b: usize) -> [[f64; 2]; 2] {
        match self {
            Self::Reference(kernel) => kernel.motion(b),
            Self::Fused(kernel) => kernel.motion(b),
        }
    }

    /// When block `b` first slid while in contact; NaN if it never has.
    pub(crate) fn first_slip(&self, b: usize) -> f64 {
        match self {
            Self::Reference(kernel) => kernel.first_slip(b),
            Self::Fused(kernel) => kernel.first_slip(b),
        }
    }

    /// Largest contact stress of a block in contact at any step so far.
    pub(crate) fn contact_stress_max(&self, model: &Model, number: u64) -> f64 {
        self.stress_square_max(model, number).sqrt()
    }

    /// Square of [`contact_stress_max`](Self::contact_stress_max).
    pub(crate) fn stress_square_max(&self, model: &Model, number: u64) -> f64 {
        match self {
            Self::Reference(kernel) => kernel.stress_square_max(),
            Self::Fused(kernel) => kernel.stress_square_max(model, number),
        }
    }

    /// What a checkpoint keeps for the choice of spring formulas; the reference kernel makes no such choice.
    pub(crate) fn strain_bound(&self) -> Option<StrainBound> {
        match self {
            Self::Reference(_) => None,
            Self::Fused(kernel) => Some(kernel.strain_bound()),
        }
    }

    /// Velocity of block `b` as a checkpoint keeps it: the reference kernel evaluates t_n again when it resumes, and so
    /// needs the velocity half a step earlier.
    pub(crate) fn checkpoint_velocity(&self, b: usize) -> [f64; 2] {
        match self {
            Self::Reference(kernel) => kernel.velocity_before(b),
            Self::Fused(kernel) => kernel.motion(b)[1],
        }
    }
}
