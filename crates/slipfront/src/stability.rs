//! The largest time step for which a slider is stable.

use crate::communicator::Communicator;
use crate::lattice::{Bond, K_DRIVE, dt_star_limit};
use crate::model::Model;
use crate::moduli::Moduli;
use crate::slider::Slider;

/// Largest stable time step of a block. `springs` is the largest eigenvalue of `2 sum_j k_ij e_ij e_ij^T/m_i`
/// over the springs to its neighbours; `held` the stiffness of the springs to the drive and to the substrate,
/// over the mass of the block; `viscosity_time` the time `tau_v` of the dampers in parallel with the springs
/// to the neighbours, which lag by half a step:
///
/// ```text
/// (dt^2 + 2 tau_v dt) springs + dt^2 held = 4
/// ```
///
/// The first term bounds the contribution of the neighbours for any motion, since
/// `(x - y)^2 <= 2 x^2 + 2 y^2`.
///
/// ```
/// use slipfront::stability::stable_step;
/// // A block in the middle of the paper's slider: springs 4.5, a drive spring of 0.375.
/// assert!((stable_step(4.5, 0.375, 0.0) - 0.9058).abs() < 5e-5);
/// assert!((stable_step(4.5, 0.375, 0.365) - 0.6295).abs() < 5e-5);
/// ```
pub fn stable_step(springs: f64, held: f64, viscosity_time: f64) -> f64 {
    let all = springs + held;
    let lag = viscosity_time * springs;
    4.0 / (lag + (lag * lag + 4.0 * all).sqrt())
}

impl Model {
    /// The bound below which a time step must stay: the least [`stable_step`] of all blocks, and no more than
    /// [`dt_star_limit`], the bound of the paper's slider. A bulk body has the bound `2/sqrt(K)` with its
    /// largest stiffness. Friction and damping do not lower it. All `ranks` of a lattice must call this
    /// together.
    pub fn stable_step_limit(&self, ranks: &dyn Communicator) -> f64 {
        let (lattice, slider) = (&self.lattice, &self.slider);
        let contact = self.friction.contact_stiffness();
        if let Some(body) = &self.body {
            let held = body.largest_stiffness().max(self.drive.k_drive) + contact;
            return stable_step(0.0, held, 0.0);
        }
        let foundation = self
            .friction
            .interface()
            .map_or(0.0, |interface| interface.foundation);
        let contact = contact.max(foundation);
        let is_plain = self.slider == Slider::default() && contact == 0.0;
        if is_plain && self.drive.k_drive <= K_DRIVE {
            return dt_star_limit();
        }
        let moduli = Moduli::new(slider, lattice, &self.rows, ranks);
        let of_block = |b: usize| {
            let (i, row) = lattice.column_row(b);
            let place = [i, self.rows.start + row];
            // xx, yy and xy of the sum over all springs of the block.
            let mut sum = [0.0; 3];
            for bond in Bond::ALL {
                for sign in [1, -1] {
                    let spring = moduli.spring(place, bond.offset.map(|step| sign * step));
                    let [x, y] = bond.rest.map(|component| component / bond.rest_length);
                    let stiffness = 2.0 * bond.stiffness * spring / slider.mass(b);
                    for (sum, product) in sum.iter_mut().zip([x * x, y * y, x * y]) {
                        *sum += stiffness * product;
                    }
                }
            }
            let [xx, yy, xy] = sum;
            let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
            let springs = mean + (half * half + xy * xy).sqrt();
            let held = (self.drive.k_drive * slider.drive_spring(b) + contact) / slider.mass(b);
            stable_step(springs, held, slider.viscosity_time)
        };
        let blocks = (0..self.surface.n_blocks()).filter(|&b| slider.exists(b));
        ranks.least_of(blocks.map(of_block).fold(dt_star_limit(), f64::min))
    }
}
