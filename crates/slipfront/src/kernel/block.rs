//! One block at one instant: its state and forces, and the fields that a run keeps.

use serde::{Deserialize, Serialize};

use crate::vector_field::{add, length};

/// One block at t_n, with friction and contact from the update that starts there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Block {
    /// Displacement **u**, in units of `P mu_s l^2/(E h)`.
    pub displacement: [f64; 2],
    /// Velocity at `t_n + dt/2`.
    pub velocity: [f64; 2],
    /// Force `F_s` of the drive spring (Eq. 2), including any constant force and the change of the normal
    /// force at an [`Interface`](crate::Interface).
    pub force_drive: [f64; 2],
    /// Force `F_c` of the lattice springs (Eq. 3).
    pub force_lattice: [f64; 2],
    /// Force `F_f` of friction (Eq. 4).
    pub force_friction: [f64; 2],
    /// Whether the block slides from t_n on: its velocity (D12), or at an [`Interface`](crate::Interface) its
    /// velocity along x, is not zero.
    pub slides: bool,
}

impl Block {
    /// Contact stress, `tau_c = |F_f + F_c|/l^2` (Eq. 10), in units of `P mu_s`.
    ///
    /// For a stuck block `F_f + F_c = -F_s`: Eq. 10 then shows the pull of the block's own drive spring and
    /// hides the stress concentration at the edge of a cavity. The [`traction`](Self::traction) shows this
    /// concentration.
    #[inline]
    pub fn contact_stress(&self) -> f64 {
        length(add(self.force_friction, self.force_lattice))
    }

    /// Traction, `|F_f|/l^2`, in units of `P mu_s`; meaningless over a texture, where there is no contact.
    #[inline]
    pub fn traction(&self) -> f64 {
        length(self.force_friction)
    }
}

/// A quantity with one value per block. Values are dimensionless, as everywhere in this crate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Field {
    /// Contact stress tau_c (Eq. 10), in units of `P mu_s`; the division by its maximum comes later.
    #[serde(rename = "contact_stress_star")]
    ContactStress,
    /// Traction `|F_f|/l^2`, in units of `P mu_s`; NaN over a texture.
    Traction,
    /// Displacement along x.
    DisplacementX,
    /// Displacement along y.
    DisplacementY,
    /// Velocity along x half a step after the instant.
    VelocityX,
    /// Velocity along y half a step after the instant.
    VelocityY,
    /// Sliding: 1 for a block that slides, 0 for one that is stuck.
    Sliding,
}

impl Field {
    /// Every field.
    pub const ALL: [Field; 7] = [
        Field::ContactStress,
        Field::Traction,
        Field::DisplacementX,
        Field::DisplacementY,
        Field::VelocityX,
        Field::VelocityY,
        Field::Sliding,
    ];

    /// The value at one block. [`Snapshot::read_field`](crate::Snapshot::read_field) reads all blocks, much
    /// faster.
    #[inline]
    pub fn value(self, block: &Block, textured: bool) -> f64 {
        match self {
            Field::ContactStress => block.contact_stress(),
            Field::Traction if textured => f64::NAN,
            Field::Traction => block.traction(),
            Field::DisplacementX => block.displacement[0],
            Field::DisplacementY => block.displacement[1],
            Field::VelocityX => block.velocity[0],
            Field::VelocityY => block.velocity[1],
            Field::Sliding => f64::from(u8::from(block.slides)),
        }
    }
}
