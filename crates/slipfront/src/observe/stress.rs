//! Stress between block and substrate: the paper's contact stress (Eq. 10) and the true traction.
//!
//! For a stuck block `F_f + F_c = -F_s`, so that Eq. 10 shows the pull of its own drive spring and hides the
//! concentration beside a cavity; the traction shows it.

use super::Observer;
use crate::kernel::Forces;
use crate::lanes;
use crate::vector_field::{add, length};
use crate::width::widest;
use crate::{RunError, Snapshot};

/// Contact stress of block `b`, `tau_c = |F_f + F_c|/l^2` (Eq. 10), in units of `P mu_s`.
#[inline]
pub fn contact_stress(now: &Snapshot, b: usize) -> f64 {
    length(add(now.forces.friction.at(b), now.forces.lattice.at(b)))
}

/// Traction of block `b`, `|F_f|/l^2`, in units of `P mu_s`; not a number over a texture, which touches nothing.
#[inline]
pub fn traction(now: &Snapshot, b: usize) -> f64 {
    if now.model.surface.textured[b] {
        f64::NAN
    } else {
        length(now.forces.friction.at(b))
    }
}

/// The largest contact stress over blocks in contact and all steps, by which tau_c* is scaled. To be shown every
/// step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StressMaximum {
    square: f64,
}

impl StressMaximum {
    /// `tau_c^max` in units of `P mu_s`.
    pub fn value(&self) -> f64 {
        self.square.sqrt()
    }
}

impl Observer for StressMaximum {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        let (forces, textured) = (now.forces, now.model.surface.textured.as_slice());
        let square = widest!(largest_square(forces: &Forces, textured: &[bool]) -> f64);
        self.square = self.square.max(square);
        Ok(())
    }
}

/// Largest `tau_c^2` over the blocks in contact.
#[inline(always)]
fn largest_square(forces: &Forces, textured: &[bool]) -> f64 {
    let n = textured.len();
    let (friction_x, friction_y) = (&forces.friction.x[..n], &forces.friction.y[..n]);
    let (lattice_x, lattice_y) = (&forces.lattice.x[..n], &forces.lattice.y[..n]);
    lanes::largest(n, |b| {
        let (x, y) = (friction_x[b] + lattice_x[b], friction_y[b] + lattice_y[b]);
        if textured[b] { 0.0 } else { x * x + y * y }
    })
}
