//! Conversion between dimensional and dimensionless quantities (Eq. 11), in this file alone.
//!
//! Lengths count in blocks, masses in block masses, times in `l sqrt(rho/E)` (D4: the paper prints no `l`),
//! displacements in `P mu_s l/E`, forces in `P mu_s l^2`. The case parser builds a [`Scales`]; writers of
//! results ask it for units.

use crate::lattice::K_STRAIGHT;

/// The five dimensional quantities that set every unit of the model, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// Edge of a block, `l`, m.
    pub block_size: f64,
    /// Young's modulus `E`, Pa.
    pub young_modulus: f64,
    /// Density `rho`, kg/m^3.
    pub density: f64,
    /// Pressure on the whole area, `P`, Pa.
    pub pressure: f64,
    /// Mean local static friction coefficient, `mu_s`.
    pub mu_static_mean: f64,
}

impl Scales {
    /// One unit of time, `l sqrt(rho/E)`, s.
    pub fn time(&self) -> f64 {
        self.block_size * (self.density / self.young_modulus).sqrt()
    }

    /// One unit of displacement, `P mu_s l/E`, m.
    pub fn displacement(&self) -> f64 {
        self.epsilon() * self.block_size
    }

    /// One unit of speed, `P mu_s/sqrt(E rho)`, m/s: `V* = V` in this unit (Eq. 11a).
    ///
    /// ```
    /// // Case 8 of Table 1: 0.0949 mm/s is V* = 0.03.
    /// let case8 = slipfront::Scales {
    ///     block_size: 1e-6, young_modulus: 100e9, density: 10e3, pressure: 100e3, mu_static_mean: 1.0,
    /// };
    /// // 0.0949 is printed to half a unit of its last digit.
    /// assert!((0.0949e-3 / case8.speed() - 0.03).abs() < 0.00005e-3 / case8.speed());
    /// ```
    pub fn speed(&self) -> f64 {
        self.pressure * self.mu_static_mean / (self.young_modulus * self.density).sqrt()
    }

    /// One unit of stress, `P mu_s`, Pa.
    pub fn stress(&self) -> f64 {
        self.pressure * self.mu_static_mean
    }

    /// One unit of force, `P mu_s l^2`, N.
    pub fn force(&self) -> f64 {
        self.stress() * self.block_size * self.block_size
    }

    /// One unit of energy, `P mu_s l^2` times `P mu_s l/E`, J.
    pub fn energy(&self) -> f64 {
        self.force() * self.displacement()
    }

    /// One unit of stiffness, `E l`, N/m.
    pub fn stiffness(&self) -> f64 {
        self.young_modulus * self.block_size
    }

    /// The load's strain, `eps = P mu_s/E`, which measures how nonlinear the springs are.
    pub fn epsilon(&self) -> f64 {
        self.pressure * self.mu_static_mean / self.young_modulus
    }

    /// A length in m, counted in blocks, to a billionth of a block: "2.5 um" over "1 um" is 2.5, not the
    /// 2.4999999999999996 of the two roundings, which would move a groove by a block.
    ///
    /// ```
    /// let scales = slipfront::Scales {
    ///     block_size: 1e-6, young_modulus: 100e9, density: 10e3, pressure: 100e3, mu_static_mean: 1.0,
    /// };
    /// assert_eq!(scales.in_blocks(22.5e-6), 22.5);
    /// ```
    pub fn in_blocks(&self, length: f64) -> f64 {
        const GRID: f64 = (1u64 << 30) as f64;
        (length / self.block_size * GRID).round() / GRID
    }

    /// Damping `Omega*` (Eq. 11a, with `k_1`) of a damping rate `Omega` in 1/s.
    pub fn omega_star(&self, damping_rate: f64) -> f64 {
        damping_rate * self.time() / K_STRAIGHT.sqrt()
    }

    /// Damping rate `Omega` in 1/s of a damping `Omega*`.
    pub fn damping_rate(&self, omega_star: f64) -> f64 {
        damping(omega_star) / self.time()
    }
}

/// Damping per unit of dimensionless time, `sqrt(k_1) Omega*`.
pub fn damping(omega_star: f64) -> f64 {
    K_STRAIGHT.sqrt() * omega_star
}
