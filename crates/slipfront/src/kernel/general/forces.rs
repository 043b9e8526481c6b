//! The forces of a step.

use std::ops::Range;

use crate::vector_field::VectorField;

/// Forces at t_n and the outcome of the update that starts there; one value per block.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Forces {
    pub(super) drive: VectorField,
    /// Of the springs between blocks and the dampers beside them.
    pub(super) lattice: VectorField,
    pub(super) friction: VectorField,
    /// Velocities after the update within a step; between steps those before it.
    pub(super) velocity: VectorField,
    pub(super) slides: Vec<bool>,
    /// Force of the spring along each bond, before they are summed into `lattice`.
    pub(super) springs: [VectorField; 4],
}

/// Each component over some blocks.
#[inline(always)]
pub(super) fn part<'a>(field: &'a VectorField, blocks: &Range<usize>) -> [&'a [f64]; 2] {
    [&field.x[blocks.clone()], &field.y[blocks.clone()]]
}

/// The same, to be filled.
#[inline(always)]
pub(super) fn part_mut<'a>(field: &'a mut VectorField, blocks: &Range<usize>) -> [&'a mut [f64]; 2] {
    [&mut field.x[blocks.clone()], &mut field.y[blocks.clone()]]
}
