//! The state that changes from step to step: displacements and velocities.

use crate::vector_field::VectorField;

/// A state at step n: displacements at t_n, velocities half a step earlier or later (leapfrog, D6). A block
/// slides if and only if its velocity is not zero (D12), so that the friction law (D2) needs no further
/// memory.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Displacement **u** from the rest site, in units of `P mu_s l^2/(E h)`.
    pub displacement: VectorField,
    /// Velocity in units of `P mu_s/sqrt(E rho)`: at `t - dt/2` at the start of a simulation, at `t + dt/2`
    /// after that.
    pub velocity: VectorField,
}

impl State {
    /// The state of blocks that are all stuck at their rest sites.
    pub fn at_rest(n_blocks: usize) -> Self {
        Self {
            displacement: VectorField::zeros(n_blocks),
            velocity: VectorField::zeros(n_blocks),
        }
    }

    /// Whether all numbers are finite.
    pub fn is_finite(&self) -> bool {
        let fields = [&self.displacement, &self.velocity];
        let mut values = fields
            .into_iter()
            .flat_map(|field| field.x.iter().chain(&field.y));
        values.all(|value| value.is_finite())
    }
}
