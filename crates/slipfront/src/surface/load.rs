//! The load on the blocks, and adhesion.

use crate::lattice::Lattice;

/// Distribution of the load of textured blocks, which bear no load themselves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Load {
    /// The blocks in contact carry the whole load: `F_n,i = p_i l^2 sum_all p/sum_contact p`, which is
    /// `P l^2 N/N_contact` under an equal pressure. This is the paper's model.
    Redistributed,
    /// Every block in contact carries `p_i l^2`; the load of the textured blocks is lost. For comparison.
    Kept,
}

impl Load {
    /// Ratio of the normal force on a block in contact to `p_i l^2`, from the sums of pressures over all
    /// blocks and over those in contact.
    pub(super) fn factor(self, [all, contact]: [f64; 2]) -> f64 {
        match self {
            Load::Redistributed => all / contact,
            Load::Kept => 1.0,
        }
    }
}

/// Parameters that turn coefficients into thresholds, `mu_i F_n,i + tau_a l^2`.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Distribution of the load of textured blocks.
    pub load: Load,
    /// Scale of all forces, `mu_s`.
    pub mu_static_mean: f64,
    /// Local pressure `p_i/P` of every block that this process holds, before the load of textured blocks is
    /// distributed; 1 if not given.
    pub pressure: Option<Vec<f64>>,
    /// Friction that does not depend on the load.
    pub adhesion: Adhesion,
    /// Whether every block that this process holds faces the substrate, and bears a load there unless it is
    /// textured: all blocks if not given, those of the lowest row for an upright sheet. Means over the
    /// surface are means over these blocks.
    pub faces: Option<Vec<bool>>,
}

/// Shear strength of the contact without load, in units of `P mu_s`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Adhesion {
    /// Strength added to the static threshold of a block in contact, `tau_a l^2`.
    pub of_static: f64,
    /// Strength added to the kinetic friction of a block in contact, `tau_ak l^2`.
    pub of_kinetic: f64,
}

impl Contact {
    /// Contact with equal pressure, without adhesion.
    pub fn new(load: Load, mu_static_mean: f64) -> Self {
        Self {
            load,
            mu_static_mean,
            pressure: None,
            adhesion: Adhesion::default(),
            faces: None,
        }
    }
}

/// Pressure that rises along an axis, `p/P = 1 + slope (2 x/L - 1)` at the centre of every block of some
/// rows; its mean over the lattice is `P`.
///
/// ```
/// use slipfront::Lattice;
/// use slipfront::surface::pressure_along;
/// assert_eq!(pressure_along(&Lattice::free(2, 2), 0..2, 0, 0.5), [0.75, 1.25, 0.75, 1.25]);
/// assert_eq!(pressure_along(&Lattice::free(2, 2), 1..2, 1, 0.5), [1.25, 1.25]);
/// ```
pub fn pressure_along(lattice: &Lattice, rows: std::ops::Range<usize>, axis: usize, slope: f64) -> Vec<f64> {
    let length = [lattice.nx, lattice.ny][axis] as f64;
    let at = |place: usize| 1.0 + slope * ((2 * place + 1) as f64 / length - 1.0);
    let columns = |j: usize| (0..lattice.nx).map(move |i| at([i, j][axis]));
    rows.flat_map(columns).collect()
}
