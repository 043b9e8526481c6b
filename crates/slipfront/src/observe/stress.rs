//! Stress between block and substrate: the paper's contact stress (Eq. 10) and the true traction.
//!
//! For a stuck block `F_f + F_c = -F_s`, so that Eq. 10 shows the pull of its own drive spring and hides the
//! concentration beside a cavity; the traction shows it. The largest contact stress over blocks in contact and all steps,
//! by which tau_c* is scaled, is [`Simulation::contact_stress_max`](crate::Simulation::contact_stress_max).

use crate::kernel::Block;
use crate::vector_field::{add, length};

/// Contact stress, `tau_c = |F_f + F_c|/l^2` (Eq. 10), in units of `P mu_s`.
#[inline]
pub fn contact_stress(block: &Block) -> f64 {
    length(add(block.force_friction, block.force_lattice))
}

/// Traction, `|F_f|/l^2`, in units of `P mu_s`; of no meaning over a texture, which touches nothing.
#[inline]
pub fn traction(block: &Block) -> f64 {
    length(block.force_friction)
}
