//! The load on the blocks, and the thresholds of friction.

use slipfront::Surface;
use slipfront::surface::{Contact, Load};

/// Normal forces, in units of `P l^2`: `F_n,i = p_i (sum_all p)/(sum_contact p)` on blocks in contact, 0 over
/// a texture.
///
/// With [`Load::Kept`] the blocks in contact bear only `p_i`. Missing blocks have no pressure.
pub(crate) fn normal_forces(surface: &Surface, contact: &Contact, exists: &[bool]) -> Vec<f64> {
    let n = surface.textured.len();
    let pressure = |b: usize| match &contact.pressure {
        _ if !exists[b] => 0.0,
        Some(pressure) => pressure[b],
        None => 1.0,
    };
    let in_contact = |b: &usize| !surface.textured[*b];
    let on_all: f64 = (0..n).map(pressure).sum();
    let on_contact: f64 = (0..n).filter(in_contact).map(pressure).sum();
    let factor = match contact.load {
        Load::Redistributed => on_all / on_contact,
        Load::Kept => 1.0,
    };
    let force = |b: usize| if in_contact(&b) { factor * pressure(b) } else { 0.0 };
    (0..n).map(force).collect()
}

/// Strength of friction of one block at age 0 and speed 0, in units of `P mu_s l^2`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Threshold {
    /// Part `mu_i F_n,i` from the coefficient.
    pub(crate) of_load: f64,
    /// Adhesion `tau_a l^2`, which neither ages nor weakens.
    pub(crate) of_adhesion: f64,
}

impl Threshold {
    /// The threshold `mu_i F_n,i + tau_a l^2`; 0 over a texture, where there is no load.
    pub(crate) fn new(
        coefficient: f64,
        contact: &Contact,
        normal_force: f64,
        in_contact: bool,
        adhesion: f64,
    ) -> Self {
        Self {
            of_load: coefficient / contact.mu_static_mean * normal_force,
            of_adhesion: if in_contact { adhesion } else { 0.0 },
        }
    }

    /// The whole threshold, with the part of the load times `factor`.
    pub(crate) fn scaled(&self, factor: f64) -> f64 {
        factor * self.of_load + self.of_adhesion
    }
}
