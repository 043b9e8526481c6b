//! The forces of a step.

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

/// The first `n` values of each component.
#[inline(always)]
pub(super) fn components(field: &VectorField, n: usize) -> [&[f64]; 2] {
    [&field.x[..n], &field.y[..n]]
}
