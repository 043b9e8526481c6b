//! Sums over all blocks, which every kernel computes at every step.

use serde::{Deserialize, Serialize};

/// Sums over all blocks at t_n, in units of this crate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Totals {
    /// Sum `sum w u` over the blocks that the drive springs pull, with the
    /// relative stiffness `w` of these springs. For a rotation the two components are not x and y, but along
    /// the [direction](crate::Drive::direction_at) `g` of each block and across it, to its left.
    pub displacement: [f64; 2],
    /// Sum `sum w v` at t_n, the mean of the half steps around it, in the components of `displacement`.
    pub velocity: [f64; 2],
    /// Sum `sum w v` at `t_n + dt/2`, in the components of `displacement`.
    pub velocity_after: [f64; 2],
    /// Sum `sum m v^2` at t_n.
    pub velocity_square: f64,
    /// Power of friction, `sum F_f . v` at t_n: negative.
    pub friction_power: f64,
    /// Number of blocks that slide from t_n on, textured ones included.
    pub n_sliding: usize,
    /// Number of sliding blocks that are in contact.
    pub n_slipping: usize,
    /// Stored energies, at steps at which an observer needs them.
    pub stored_energy: Option<StoredEnergy>,
}

/// Energies stored at t_n, in units of `P mu_s l^2` times `P mu_s l^2/(E h)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StoredEnergy {
    /// Kinetic energy, the mean of the half steps before and after.
    pub kinetic: f64,
    /// Energy of the springs between blocks, or of the body above them.
    pub lattice: f64,
    /// Energy of the drive springs.
    pub drive_springs: f64,
}

impl StoredEnergy {
    /// Sum of all energies.
    pub fn total(&self) -> f64 {
        self.kinetic + self.lattice + self.drive_springs
    }
}
