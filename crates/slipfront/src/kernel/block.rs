//! All that can be read of one block at one instant.

use crate::vector_field::{add, length};

/// One block at t_n. Friction and contact are those of the update that starts there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Block {
    /// **u**, in units of `P mu_s l/E`.
    pub displacement: [f64; 2],
    /// Velocity at `t_n + dt/2`.
    pub velocity: [f64; 2],
    /// `F_s` of the drive spring (Eq. 2), with any constant force.
    pub force_drive: [f64; 2],
    /// `F_c` of the lattice springs (Eq. 3).
    pub force_lattice: [f64; 2],
    /// `F_f` of friction (Eq. 4).
    pub force_friction: [f64; 2],
}

impl Block {
    /// Whether the block slides from t_n on: its velocity is not zero (D12).
    pub fn slides(&self) -> bool {
        self.velocity != [0.0, 0.0]
    }

    /// Contact stress, `tau_c = |F_f + F_c|/l^2` (Eq. 10), in units of `P mu_s`.
    ///
    /// For a stuck block `F_f + F_c = -F_s`: Eq. 10 then shows the pull of the block's own drive spring and hides the
    /// stress concentration at the edge of a cavity. [`traction`](Self::traction) shows it.
    #[inline]
    pub fn contact_stress(&self) -> f64 {
        length(add(self.force_friction, self.force_lattice))
    }

    /// Traction, `|F_f|/l^2`, in units of `P mu_s`; without meaning over a texture, where nothing is in contact.
    #[inline]
    pub fn traction(&self) -> f64 {
        length(self.force_friction)
    }
}
