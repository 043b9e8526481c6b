//! The forces of a step.

use std::ops::Range;

use crate::vector_field::VectorField;

/// Forces at t_n and the outcome of the update that starts there; one value per block.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Forces {
    pub(crate) drive: VectorField,
    /// Sum over the springs between blocks and the dampers in parallel with them, per block.
    pub(crate) lattice: VectorField,
    pub(crate) friction: VectorField,
    /// Velocities after the update within a step; between steps the velocities before the update.
    pub(crate) velocity: VectorField,
    pub(crate) slides: Vec<bool>,
    /// Force of the spring along each bond, before the forces are summed into `lattice`.
    pub(crate) springs: [VectorField; 4],
}

/// Values of some blocks. All such slices have the same length, so that loops over them check no bounds.
#[inline(always)]
pub(crate) fn values_of<'a, T>(values: &'a [T], blocks: &Range<usize>) -> &'a [T] {
    &values[blocks.clone()][..blocks.len()]
}

/// Values of some blocks, to be filled.
#[inline(always)]
pub(crate) fn values_of_mut<'a, T>(values: &'a mut [T], blocks: &Range<usize>) -> &'a mut [T] {
    &mut values[blocks.clone()][..blocks.len()]
}

/// Components of a field over some blocks.
#[inline(always)]
pub(crate) fn part<'a>(field: &'a VectorField, blocks: &Range<usize>) -> [&'a [f64]; 2] {
    [values_of(&field.x, blocks), values_of(&field.y, blocks)]
}

/// Components of a field over some blocks, to be filled.
#[inline(always)]
pub(crate) fn part_mut<'a>(field: &'a mut VectorField, blocks: &Range<usize>) -> [&'a mut [f64]; 2] {
    [
        values_of_mut(&mut field.x, blocks),
        values_of_mut(&mut field.y, blocks),
    ]
}
