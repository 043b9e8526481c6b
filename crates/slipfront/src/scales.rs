//! Conversion between dimensional and dimensionless quantities (Eq. 11).
//!
//! A block is `l` by `l` and as thick as the sheet, `h`; the paper's blocks are cubes, `h = l`. Lengths are
//! in blocks, masses in block masses, times in `l sqrt(rho/E)` (D4: the paper prints no `l`), displacements
//! in `P mu_s l^2/(E h)`, forces in `P mu_s l^2`. An upright sheet touches the substrate with its edge: the
//! contact area of a block is `l h`, which replaces `l^2` in all units. The case parser builds a [`Scales`];
//! writers of results get their units from it.
//!
//! Kernels know no units. The factors are applied where a value is read, where it is written or shown, and in
//! `leg.rs` of slipfront-run, where a run continues in the units of another case.

use crate::lattice::K_STRAIGHT;

/// The dimensional quantities that set every unit of the model, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// Edge of a block in the plane, `l`, m.
    pub block_size: f64,
    /// Thickness of the sheet, `h`, m.
    pub thickness: f64,
    /// Width of the area on which a block touches the substrate, m: `l`, or the thickness `h` under the edge
    /// of an upright sheet.
    pub contact_width: f64,
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

    /// One unit of displacement, `P mu_s l^2/(E h)`, m.
    pub fn displacement(&self) -> f64 {
        self.epsilon() * self.block_size
    }

    /// One unit of speed, `P mu_s l/(h sqrt(E rho))`, m/s: `V* = V` in this unit (Eq. 11a).
    ///
    /// ```
    /// // Case 8 of Table 1: 0.0949 mm/s is V* = 0.03.
    /// let case8 = slipfront::Scales {
    ///     block_size: 1e-6, thickness: 1e-6, contact_width: 1e-6, young_modulus: 100e9, density: 10e3, pressure: 100e3, mu_static_mean: 1.0,
    /// };
    /// // 0.0949 is printed to half a unit of its last digit.
    /// assert!((0.0949e-3 / case8.speed() - 0.03).abs() < 0.00005e-3 / case8.speed());
    /// ```
    pub fn speed(&self) -> f64 {
        self.pressure * self.mu_static_mean / (self.young_modulus * self.density).sqrt() * self.slenderness()
    }

    /// One unit of stress, `P mu_s`, Pa.
    pub fn stress(&self) -> f64 {
        self.pressure * self.mu_static_mean
    }

    /// One unit of force, `P mu_s l^2`, N.
    pub fn force(&self) -> f64 {
        self.stress() * self.block_size * self.contact_width
    }

    /// One unit of energy, `P mu_s l^2` times `P mu_s l^2/(E h)`, J.
    pub fn energy(&self) -> f64 {
        self.force() * self.displacement()
    }

    /// One unit of stiffness, `E h`, N/m.
    pub fn stiffness(&self) -> f64 {
        self.young_modulus * self.thickness
    }

    /// Stiffness of a spring on one block, in units of `E h`, for springs of the given stiffness per area, in
    /// N/m^3: `K l^2/(E h)`.
    ///
    /// ```
    /// let scales = slipfront::Scales {
    ///     block_size: 1e-6, thickness: 2e-6, contact_width: 1e-6, young_modulus: 100e9, density: 10e3, pressure: 100e3, mu_static_mean: 1.0,
    /// };
    /// assert!((scales.stiffness_of_area(0.4e17) - 0.2).abs() < 1e-15);
    /// ```
    pub fn stiffness_of_area(&self, per_area: f64) -> f64 {
        per_area * self.contact_area() / self.stiffness()
    }

    /// Strain of the load, `eps = P mu_s l/(E h)`, a measure of the nonlinearity of the springs.
    pub fn epsilon(&self) -> f64 {
        self.pressure * self.mu_static_mean / self.young_modulus * self.slenderness()
    }

    /// Area on which a block touches the substrate, `l^2`, m^2; `l h` under the edge of an upright sheet.
    pub fn contact_area(&self) -> f64 {
        self.block_size * self.contact_width
    }

    /// Width of the contact of a block over its thickness; exactly 1 for the paper's cubes.
    fn slenderness(&self) -> f64 {
        self.contact_width / self.thickness
    }

    /// A length in m as a number of blocks, to a billionth of a block: "2.5 um" over "1 um" is 2.5, not the
    /// 2.4999999999999996 that two roundings give, which would move a groove by a block.
    ///
    /// ```
    /// let scales = slipfront::Scales {
    ///     block_size: 1e-6, thickness: 1e-6, contact_width: 1e-6, young_modulus: 100e9, density: 10e3, pressure: 100e3, mu_static_mean: 1.0,
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
