//! The sliding surface: local friction coefficients, texture and load of every block.
//!
//! [`Coefficients`] are drawn or given, [`mesh`] finds the textured blocks, and the [`Load`] is distributed over the blocks in
//! contact; [`Surface::new`] makes the friction thresholds of all blocks from the three.

mod coefficients;
mod mesh;
mod outline;
mod texture;

pub use coefficients::{Coefficients, Distribution, STREAMS};
pub use mesh::{Meshed, mesh, mesh_watched};
pub use texture::{Cavity, Groove, Orientation, Texture, cavity_lambda, cavity_percent};

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
    fn normal_force_per_block(self, textured: &[bool]) -> Result<f64, SurfaceError> {
        let n_blocks = textured.len();
        let n_contact = textured.iter().filter(|&&t| !t).count();
        if n_contact == 0 {
            return Err(SurfaceError::NoContact { n_blocks });
        }
        Ok(match self {
            Load::Redistributed => n_blocks as f64 / n_contact as f64,
            Load::Kept => 1.0,
        })
    }
}

/// Friction of every block; arrays have one value per block.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Whether a block lies over a texture and so has no contact with the substrate.
    pub textured: Vec<bool>,
    /// Local static coefficients `mu_si`; 0 over a texture.
    pub mu_static: Vec<f64>,
    /// Local kinetic coefficients `mu_ki`; 0 over a texture.
    pub mu_kinetic: Vec<f64>,
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
        let Coefficients {
            mut mu_static,
            mut mu_kinetic,
            ..
        } = coefficients;
        assert_eq!(
            mu_static.len(),
            textured.len(),
            "coefficients and texture belong to different lattices"
        );
        let normal_force_per_block = load.normal_force_per_block(&textured)?;
        for b in (0..textured.len()).filter(|&b| textured[b]) {
            mu_static[b] = 0.0;
            mu_kinetic[b] = 0.0;
        }
        Ok(Self {
            textured,
            mu_static,
            mu_kinetic,
            normal_force_per_block,
            mu_static_mean,
        })
    }

    /// Equal coefficients for all blocks and no texture. Coefficients are in units of their static mean, so that `mu_static`
    /// is 1 in the model of the paper.
    pub fn uniform(lattice: &Lattice, mu_static: f64, mu_kinetic: f64) -> Self {
        let n = lattice.n_blocks();
        Self {
            textured: vec![false; n],
            mu_static: vec![mu_static; n],
            mu_kinetic: vec![mu_kinetic; n],
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

    /// Number of blocks.
    pub fn n_blocks(&self) -> usize {
        self.textured.len()
    }

    /// Number of blocks that touch the substrate.
    pub fn n_contact(&self) -> usize {
        self.textured.iter().filter(|&&t| !t).count()
    }

    /// Textured share of the area as meshed, `A*` in % (Eq. 15).
    pub fn texture_percent(&self) -> f64 {
        100.0 * (self.n_blocks() - self.n_contact()) as f64 / self.n_blocks() as f64
    }

    /// The smallest force that makes a block in contact slip: `min_i max(mu_si, mu_ki) F_n,i` (D12).
    pub fn min_slip_threshold(&self) -> f64 {
        (0..self.n_blocks())
            .filter(|&b| !self.textured[b])
            .map(|b| self.static_limit(b).max(self.kinetic_force(b)))
            .fold(f64::INFINITY, f64::min)
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
