//! What advances a [`State`](crate::State) by one step.
//!
//! [`mod@reference`] reads like the paper, one pass per equation. Observers see what a kernel leaves in
//! [`Forces`].

pub mod reference;

use crate::{Contact, VectorField};

/// Forces at t_n and the outcome of the update that starts there; one value per block.
#[derive(Clone, Debug, PartialEq)]
pub struct Forces {
    /// `F_s` of the drive springs (Eq. 2), with any constant force.
    pub drive: VectorField,
    /// `F_c` of the lattice springs (Eq. 3).
    pub lattice: VectorField,
    /// `F_f` of friction (Eq. 4).
    pub friction: VectorField,
    /// Velocity at `t_n + dt/2`.
    pub velocity_after: VectorField,
    /// Stuck or sliding from t_n on.
    pub contact_after: Vec<Contact>,
    /// Force of the spring along each bond, on its way into `lattice`.
    springs: [VectorField; 4],
}

impl Forces {
    /// No forces yet, for `n_blocks` blocks.
    pub fn zeros(n_blocks: usize) -> Self {
        let zeros = || VectorField::zeros(n_blocks);
        Self {
            drive: zeros(),
            lattice: zeros(),
            friction: zeros(),
            velocity_after: zeros(),
            contact_after: vec![Contact::Stuck; n_blocks],
            springs: [zeros(), zeros(), zeros(), zeros()],
        }
    }
}
