//! What changes from step to step: displacements and velocities.

use crate::vector_field::VectorField;

/// Whether a block sticks to the substrate or slides over it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Contact {
    /// At rest; friction balances the other forces.
    Stuck,
    /// Moving: its velocity is not zero (D12).
    Sliding,
}

/// A state at step n: displacements at t_n, velocities half a step earlier or later (leapfrog, D6). A block slides if and
/// only if its velocity is not zero (D12), so that the friction law (D2) needs no further memory.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Displacement **u** from the rest site, in units of `P mu_s l/E`.
    pub displacement: VectorField,
    /// Velocity in units of `P mu_s/sqrt(E rho)`: at `t - dt/2` where a simulation begins, at `t + dt/2` where it stands.
    pub velocity: VectorField,
}

impl State {
    /// Every block stuck at its rest site.
    pub fn at_rest(n_blocks: usize) -> Self {
        Self {
            displacement: VectorField::zeros(n_blocks),
            velocity: VectorField::zeros(n_blocks),
        }
    }
}

/// A block slides if and only if its velocity is not zero (D12).
#[inline(always)]
pub(crate) fn contact_of(velocity: [f64; 2]) -> Contact {
    if velocity == [0.0, 0.0] {
        Contact::Stuck
    } else {
        Contact::Sliding
    }
}
