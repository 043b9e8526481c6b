//! Quantities of which a run keeps one value per block.

use serde::{Deserialize, Serialize};

use crate::kernel::block::Block;

/// A quantity with one value per block. Values are dimensionless, as everywhere in this crate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Field {
    /// Contact stress tau_c (Eq. 10), in units of `P mu_s`; not yet divided by its maximum.
    #[serde(rename = "contact_stress_star")]
    ContactStress,
    /// Traction `|F_f|/l^2`, in units of `P mu_s`; NaN over a texture.
    Traction,
    /// Displacement along x.
    DisplacementX,
    /// Displacement along y.
    DisplacementY,
    /// Velocity along x half a step later.
    VelocityX,
    /// Velocity along y half a step later.
    VelocityY,
    /// 1 for a block that slides, 0 for one that is stuck.
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

    /// The value at one block. [`Snapshot::read_field`](crate::Snapshot::read_field) reads all blocks, much faster.
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
            Field::Sliding => f64::from(u8::from(block.slides())),
        }
    }
}
