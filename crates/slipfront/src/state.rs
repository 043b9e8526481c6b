//! What changes from step to step: displacements, velocities, stick or slip.

use crate::VectorField;

/// Whether a block rests on the substrate or slides over it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Contact {
    /// At rest; friction balances the other forces.
    Stuck,
    /// Moving: its velocity is not zero (D12).
    Sliding,
}

/// The state at step n: displacements at t_n, velocities half a step earlier (leapfrog, D6).
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Displacement **u** from the rest site, in units of `P mu_s l/E`.
    pub displacement: VectorField,
    /// Velocity at `t - dt/2`, in units of `P mu_s/sqrt(E rho)`.
    pub velocity: VectorField,
    /// Memory of the friction law (D2): a block slides if and only if its velocity is not zero (D12).
    pub contact: Vec<Contact>,
}

impl State {
    /// Every block stuck at its rest site.
    pub fn at_rest(n_blocks: usize) -> Self {
        Self::moving(VectorField::zeros(n_blocks), VectorField::zeros(n_blocks))
    }

    /// A given motion: `displacement` at t = 0, `velocity` half a step earlier. Blocks that move are sliding.
    pub fn moving(displacement: VectorField, velocity: VectorField) -> Self {
        let contact = velocity
            .x
            .iter()
            .zip(&velocity.y)
            .map(|(&x, &y)| contact_of([x, y]))
            .collect();
        Self {
            displacement,
            velocity,
            contact,
        }
    }
}

/// Sliding means a velocity that is not zero (D12).
#[inline(always)]
pub(crate) fn contact_of(velocity: [f64; 2]) -> Contact {
    if velocity == [0.0, 0.0] {
        Contact::Stuck
    } else {
        Contact::Sliding
    }
}
