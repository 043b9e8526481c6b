//! The sliding surface: local friction coefficients, texture and load of every block.
//!
//! [`Coefficients`] are drawn or given, [`mesh`] finds the textured blocks, and the [`Load`] is distributed over the blocks in
//! contact; [`Surface::new`] makes the friction thresholds of all blocks from the three, [`Surface::of_ranks`] those of the
//! blocks that a rank holds.

mod coefficients;
mod mesh;
mod outline;
mod texture;
mod whole;

pub use coefficients::{Coefficients, Distribution, STREAMS};
pub use mesh::{Meshed, mesh, mesh_watched};
pub use texture::{Cavity, Groove, Orientation, Texture, cavity_lambda, cavity_percent};

use self::whole::Whole;
use crate::communicator::{Alone, Communicator};
use crate::error::SurfaceError;
use crate::lattice::Lattice;

/// What happens to the load of textured blocks, which carry none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Load {
    /// The blocks in contact carry equal parts of the whole load: `F_n,i = P l^2 N/N_contact`. The paper's model.
    Redistributed,
    /// Every block in contact carries `P l^2`; the load of the textured blocks is lost. For comparison.
    Kept,
}

impl Load {
    /// Normal force on a block in contact in units of `P l^2`.
    fn normal_force_per_block(self, whole: &Whole) -> f64 {
        match self {
            Load::Redistributed => whole.n_blocks as f64 / whole.n_contact as f64,
            Load::Kept => 1.0,
        }
    }
}

/// Friction of every block; arrays have one value per block that this process holds.
///
/// Its methods on the whole surface tell what the arrays were when it was made.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Whether a block lies over a texture and so has no contact with the substrate.
    pub textured: Vec<bool>,
    /// Local static coefficients `mu_si`; 0 over a texture.
    pub mu_static: Vec<f64>,
    /// Local kinetic coefficients `mu_ki`; 0 over a texture.
    pub mu_kinetic: Vec<f64>,
    whole: Whole,
    /// Normal force on a block in contact, in units of `P l^2`.
    normal_force_per_block: f64,
    /// The scale of all forces, `mu_s`.
    mu_static_mean: f64,
}

impl Surface {
    /// Sets the coefficients of textured blocks to 0 and distributes the load.
    ///
    /// `mu_static_mean` is the scale of all forces. Fails when no block is left in contact.
    pub fn new(
        coefficients: Coefficients,
        textured: Vec<bool>,
        load: Load,
        mu_static_mean: f64,
    ) -> Result<Self, SurfaceError> {
        Self::of_ranks(coefficients, textured, load, mu_static_mean, &Alone)
    }

    /// [`new`](Self::new) of the blocks that this rank holds, called by all `ranks` of a lattice at once. What depends on the
    /// whole surface has the same bits on all of them, however many they are.
    pub fn of_ranks(
        mut coefficients: Coefficients,
        textured: Vec<bool>,
        load: Load,
        mu_static_mean: f64,
        ranks: &dyn Communicator,
    ) -> Result<Self, SurfaceError> {
        assert_eq!(
            coefficients.mu_static.len(),
            textured.len(),
            "coefficients and texture belong to different lattices"
        );
        for b in (0..textured.len()).filter(|&b| textured[b]) {
            coefficients.mu_static[b] = 0.0;
            coefficients.mu_kinetic[b] = 0.0;
        }
        let whole = Whole::find(&coefficients, &textured, ranks);
        if whole.n_contact == 0 {
            let n_blocks = whole.n_blocks;
            return Err(SurfaceError::NoContact { n_blocks });
        }
        Ok(Self {
            textured,
            mu_static: coefficients.mu_static,
            mu_kinetic: coefficients.mu_kinetic,
            normal_force_per_block: load.normal_force_per_block(&whole),
            whole,
            mu_static_mean,
        })
    }

    /// Equal coefficients for all blocks and no texture. Coefficients are in units of their static mean, so that `mu_static`
    /// is 1 in the model of the paper.
    pub fn uniform(lattice: &Lattice, mu_static: f64, mu_kinetic: f64) -> Self {
        let n = lattice.n_blocks();
        let textured = vec![false; n];
        let coefficients = Coefficients::given(vec![mu_static; n], vec![mu_kinetic; n]);
        Self {
            whole: Whole::find(&coefficients, &textured, &Alone),
            textured,
            mu_static: coefficients.mu_static,
            mu_kinetic: coefficients.mu_kinetic,
            normal_force_per_block: 1.0,
            mu_static_mean: 1.0,
        }
    }

    /// Normal force `F_n,i` on block `b` in units of `P l^2`; 0 over a texture.
    pub fn normal_force(&self, b: usize) -> f64 {
        if self.textured[b] {
            0.0
        } else {
            self.normal_force_per_block
        }
    }

    /// Static threshold `mu_si F_n,i` of block `b` in units of `P mu_s l^2`.
    pub fn static_limit(&self, b: usize) -> f64 {
        self.mu_static[b] / self.mu_static_mean * self.normal_force(b)
    }

    /// Kinetic friction `mu_ki F_n,i` of block `b` in units of `P mu_s l^2`.
    pub fn kinetic_force(&self, b: usize) -> f64 {
        self.mu_kinetic[b] / self.mu_static_mean * self.normal_force(b)
    }

    /// [`kinetic_force`](Self::kinetic_force) of the blocks from `first` on.
    #[inline(always)]
    pub(crate) fn read_kinetic_forces(&self, first: usize, forces: &mut [f64]) {
        let blocks = first..first + forces.len();
        let coefficients = self.mu_kinetic[blocks.clone()].iter().zip(&self.textured[blocks]);
        for (force, (mu_kinetic, &textured)) in forces.iter_mut().zip(coefficients) {
            let normal_force = if textured {
                0.0
            } else {
                self.normal_force_per_block
            };
            *force = mu_kinetic / self.mu_static_mean * normal_force;
        }
    }

    /// Number of blocks that this process holds.
    pub fn n_blocks(&self) -> usize {
        self.textured.len()
    }

    /// Number of blocks of the whole surface that touch the substrate.
    pub fn n_contact(&self) -> usize {
        self.whole.n_contact
    }

    /// Negative draws of coefficients of the whole surface that were set to 0, static and kinetic together.
    pub fn negative_draws(&self) -> usize {
        self.whole.negative_draws
    }

    /// Textured share of the whole surface as meshed, `A*` in % (Eq. 15).
    pub fn texture_percent(&self) -> f64 {
        let Whole {
            n_blocks, n_contact, ..
        } = self.whole;
        100.0 * (n_blocks - n_contact) as f64 / n_blocks as f64
    }

    /// Mean of `mu_si` over all blocks in contact.
    pub fn mean_static_coefficient(&self) -> f64 {
        self.whole.sum_static / self.whole.n_contact as f64
    }

    /// Mean of `mu_ki` over all blocks in contact.
    pub fn mean_kinetic_coefficient(&self) -> f64 {
        self.whole.sum_kinetic / self.whole.n_contact as f64
    }

    /// Mean kinetic friction over all blocks, textured ones included: `mean(mu_ki F_n,i)` in units of `P mu_s l^2`.
    pub fn mean_kinetic_force(&self) -> f64 {
        let sum = self.whole.sum_kinetic / self.mu_static_mean * self.normal_force_per_block;
        sum / self.whole.n_blocks as f64
    }

    /// The smallest force that makes a block in contact slip: `min_i max(mu_si, mu_ki) F_n,i` over the whole surface (D12).
    pub fn min_slip_threshold(&self) -> f64 {
        // Rounding keeps the order of numbers, so that these are the bits of the smallest of all thresholds.
        self.whole.min_coefficient / self.mu_static_mean * self.normal_force_per_block
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texture_takes_load_and_friction_and_conserves_the_total() {
        let lattice = Lattice::free(4, 2);
        let mut textured = vec![false; 8];
        textured[3] = true;
        textured[5] = true;
        let given = Coefficients::given(vec![2.0; 8], vec![1.0; 8]);
        let surface = Surface::new(given, textured, Load::Redistributed, 2.0).unwrap();
        assert_eq!(surface.static_limit(0), 8.0 / 6.0);
        assert_eq!(
            (
                surface.static_limit(3),
                surface.kinetic_force(5),
                surface.mu_static[3]
            ),
            (0.0, 0.0, 0.0)
        );
        let load: f64 = (0..8).map(|b| surface.normal_force(b)).sum();
        assert!((load - lattice.n_blocks() as f64).abs() < 1e-12);
        assert_eq!(surface.texture_percent(), 25.0);
    }
}
