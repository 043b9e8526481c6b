//! Problems with exact solutions, shared by tests and benches.
//!
//! Quantities are in the units of this crate (lengths in blocks, times in `l sqrt(rho/E)`, forces in
//! `P mu_s l^2`). The chapters of slipfront-family and the tests in `tests/physics` compare the kernels with
//! these solutions.

mod bisection;
mod edge_drive;
mod friction;
mod sliders;
mod torsion;

pub use edge_drive::precursor_load;
pub use friction::*;
pub use sliders::{
    PairMode, composite_peak, graded_first_slip_time_star, lagged_decay_rate, pair_modes, viscous_decay_rate,
};
pub use torsion::{torsion_first_slip, torsion_of_decoupled_blocks, torsion_of_decoupled_disc};

use bisection::bisected;

use crate::lattice::{K_DIAGONAL, K_DRIVE, K_STRAIGHT};
use crate::scales::damping;

/// Time of the first slip on a surface without texture, for any direction of the drive (Eqs. 1, 2, 4, D12).
///
/// Until then no block has moved, so that no lattice spring exerts a force:
///
/// ```text
/// k_s V* t* = min_i max(mu_si, mu_ki)/mu_s,   k_s = 3/8
/// ```
///
/// `mu_static`, `mu_kinetic`: local coefficients, one per block; `mu_static_mean`: the scale of forces.
///
/// ```
/// use slipfront::exact_solutions::first_slip_time_star;
/// // The block with mu_s = 0.3 but mu_k = 0.6 sticks up to 0.6; its neighbour slips first, at 0.375.
/// assert_eq!(first_slip_time_star(&[0.3, 0.375], &[0.6, 0.2], 1.0, 0.01), 100.0);
/// ```
pub fn first_slip_time_star(mu_static: &[f64], mu_kinetic: &[f64], mu_static_mean: f64, v_star: f64) -> f64 {
    let min_threshold = mu_static
        .iter()
        .zip(mu_kinetic)
        .map(|(s, k)| s.max(*k))
        .fold(f64::INFINITY, f64::min);
    min_threshold / (mu_static_mean * K_DRIVE * v_star)
}

/// Level of mu* when every block slides steadily at `V*` (Eqs. 4, 5, 11a), reached for `Omega*` >= 1:
///
/// ```text
/// mu_k* = mean(mu_ki)/mu_s + sqrt(3/4) Omega* V*
/// ```
///
/// ```
/// use slipfront::exact_solutions::steady_level;
/// assert_eq!(steady_level(0.5, 2.0, 0.1), 0.5 + 0.75_f64.sqrt() * 0.2);
/// ```
pub fn steady_level(mean_kinetic_star: f64, omega_star: f64, v_star: f64) -> f64 {
    mean_kinetic_star + damping(omega_star) * v_star
}

/// Stick and slip of one block on its drive spring, and of a uniform lattice without texture, which moves as
/// a rigid body.
///
/// The extension `e = V t - u` obeys, from the moment of slip on,
///
/// ```text
/// e'' + Omega e' + k_s e = R* + Omega V,   e(0) = 1/k_s,  e'(0) = V,   Omega = sqrt(3/4) Omega*
/// ```
///
/// until `e' = V` again, when the block has come to rest. With `y = e - (R + Omega V)/k_s` the solution is
/// `y = exp(-Omega t/2) (a cos w t + b sin w t)`, `w^2 = k_s - Omega^2/4`.
///
/// ```
/// use slipfront::exact_solutions::SlipCycle;
/// // No damping, R* = 1/2: the force falls from 1 to 2 R* - 1 = 0, and its mean is R*.
/// let cycle = SlipCycle::new(0.0, 0.5, 0.03);
/// assert!((cycle.slip_duration() - 5.25015).abs() < 5e-6);
/// assert!(cycle.force_at_stop().abs() < 1e-12 && (cycle.mean_force() - 0.5).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipCycle {
    damping: f64,
    r_star: f64,
    v_star: f64,
    slip_duration: f64,
}

/// A damped oscillation, `exp(-Omega t/2) (cosine cos w t + sine sin w t)`.
#[derive(Clone, Copy)]
struct DampedOscillation {
    decay: f64,
    frequency: f64,
    cosine: f64,
    sine: f64,
}

impl DampedOscillation {
    fn at(&self, t: f64) -> f64 {
        let (s, c) = libm::sincos(self.frequency * t);
        libm::exp(-self.decay * t) * (self.cosine * c + self.sine * s)
    }

    fn derivative(&self) -> Self {
        Self {
            cosine: self.frequency * self.sine - self.decay * self.cosine,
            sine: -self.frequency * self.cosine - self.decay * self.sine,
            ..*self
        }
    }

    /// First zero after t = 0.
    fn first_zero(&self) -> f64 {
        let phase = libm::atan2(self.cosine, -self.sine);
        phase.rem_euclid(std::f64::consts::PI) / self.frequency
    }
}

impl SlipCycle {
    /// The cycle at `omega_star` (underdamped: below `2 sqrt(k_s/k_1) = 1.41`), `r_star` < 1 and `v_star`.
    ///
    /// # Panics
    /// If the block never sticks again, because it is overdamped or never reaches the speed of the drive
    /// again.
    pub fn new(omega_star: f64, r_star: f64, v_star: f64) -> Self {
        let mut cycle = Self {
            damping: damping(omega_star),
            r_star,
            v_star,
            slip_duration: 0.0,
        };
        assert!(
            cycle.damping < 2.0 * K_DRIVE.sqrt(),
            "overdamped: the block never sticks again"
        );
        let rate = cycle.oscillation().derivative();
        // e' falls from V to its minimum and rises to its maximum, both where e'' vanishes; it passes V in
        // between.
        let minimum = rate.derivative().first_zero();
        let maximum = minimum + std::f64::consts::PI / rate.frequency;
        assert!(
            rate.at(maximum) > v_star,
            "the block never catches up with the drive again"
        );
        cycle.slip_duration = bisected([minimum, maximum], |t| rate.at(t) >= v_star);
        cycle
    }

    fn oscillation(&self) -> DampedOscillation {
        let decay = 0.5 * self.damping;
        let frequency = (K_DRIVE - decay * decay).sqrt();
        let y = (1.0 - self.r_star - self.damping * self.v_star) / K_DRIVE;
        DampedOscillation {
            decay,
            frequency,
            cosine: y,
            sine: (self.v_star + decay * y) / frequency,
        }
    }

    /// Time of the first slip, `1/(k_s V*)`.
    pub fn onset_time_star(&self) -> f64 {
        1.0 / (K_DRIVE * self.v_star)
    }

    /// Time from slip to stick. Without damping `(2/w0) (pi - atan((1 - R) w0/(k_s V)))`, `w0^2 = k_s`.
    pub fn slip_duration(&self) -> f64 {
        self.slip_duration
    }

    /// Force of the drive spring a time `t` after the slip began, up to [`SlipCycle::slip_duration`].
    pub fn force(&self, t: f64) -> f64 {
        self.r_star + self.damping * self.v_star + K_DRIVE * self.oscillation().at(t)
    }

    /// Velocity of the block a time `t` after the slip began, `V - e'`.
    pub fn velocity(&self, t: f64) -> f64 {
        self.v_star - self.oscillation().derivative().at(t)
    }

    /// Force at which the block sticks; `2 R - 1` without damping.
    pub fn force_at_stop(&self) -> f64 {
        self.force(self.slip_duration)
    }

    /// Time of the largest force after the slip began, where `e' = 0`.
    pub fn peak_delay(&self) -> f64 {
        self.oscillation().derivative().first_zero()
    }

    /// Largest force; `R + sqrt((1 - R)^2 + k_s V^2)` without damping.
    pub fn peak(&self) -> f64 {
        self.force(self.peak_delay())
    }

    /// Time from one slip to the next: the slip, and the stick in which the force climbs back to 1.
    pub fn period(&self) -> f64 {
        self.slip_duration + (1.0 - self.force_at_stop()) / (K_DRIVE * self.v_star)
    }

    /// Mean force over a period. A slip begins and ends at rest, so that momentum balance over the period T
    /// gives
    ///
    /// ```text
    /// integral over slip = R t_slip + Omega V T,   integral over stick = (1 - F_stop^2)/(2 k_s V)
    /// ```
    pub fn mean_force(&self) -> f64 {
        let period = self.period();
        let slip = self.r_star * self.slip_duration + self.damping * self.v_star * period;
        let stick = (1.0 - self.force_at_stop().powi(2)) / (2.0 * K_DRIVE * self.v_star);
        (slip + stick) / period
    }

    /// Energy lost to friction in one slip, `R V T`: the block moves by `V T`.
    pub fn friction_loss(&self) -> f64 {
        self.r_star * self.v_star * self.period()
    }

    /// Energy lost to damping in one slip: the work of the drive, `V T` times the mean force, less the loss
    /// to friction.
    pub fn damping_loss(&self) -> f64 {
        self.v_star * self.period() * self.mean_force() - self.friction_loss()
    }
}

/// A plane wave of the linear lattice (eps = 0), `u = p cos(a i + b j)`, and its squared frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LatticeWave {
    /// Square of the frequency, `omega^2`.
    pub omega_squared: f64,
    /// Unit vector **p** along which the blocks oscillate.
    pub polarization: [f64; 2],
}

/// The two waves of phase advance `a` per column and `b` per row, the slower one first (Eqs. 2, 3):
///
/// ```text
/// D11 = 2 k_1 (1 - cos a) + 2 k_2 (1 - cos a cos b) + k_s     omega^2 p = D p
/// D22 = 2 k_1 (1 - cos b) + 2 k_2 (1 - cos a cos b) + k_s
/// D12 = 2 k_2 sin a sin b
/// ```
///
/// ```
/// // The stiffest wave, columns against each other: omega^2 = 4 k_1 + 4 k_2 + k_s = 6.5 k_1.
/// let [_, fast] = slipfront::exact_solutions::lattice_waves(std::f64::consts::PI, 0.0, 0.375);
/// assert!((fast.omega_squared - 4.875).abs() < 1e-14);
/// ```
pub fn lattice_waves(a: f64, b: f64, k_drive: f64) -> [LatticeWave; 2] {
    let [(sin_a, cos_a), (sin_b, cos_b)] = [libm::sincos(a), libm::sincos(b)];
    let both = 2.0 * K_DIAGONAL * (1.0 - cos_a * cos_b) + k_drive;
    let d11 = 2.0 * K_STRAIGHT * (1.0 - cos_a) + both;
    let d22 = 2.0 * K_STRAIGHT * (1.0 - cos_b) + both;
    let d12 = 2.0 * K_DIAGONAL * sin_a * sin_b;
    let (middle, half) = (0.5 * (d11 + d22), 0.5 * (d11 - d22));
    let radius = libm::hypot(half, d12);
    // The direction of the faster wave has half the angle of (half, d12).
    let (s, c) = libm::sincos(0.5 * libm::atan2(d12, half));
    [
        LatticeWave {
            omega_squared: middle - radius,
            polarization: [-s, c],
        },
        LatticeWave {
            omega_squared: middle + radius,
            polarization: [c, s],
        },
    ]
}

/// Frequency of an undamped wave of frequency `omega` in leapfrog integration:
///
/// ```text
/// sin(omega_num dt/2) = omega dt/2
/// ```
///
/// ```
/// // At the limit of stability a period takes two steps.
/// let number = slipfront::exact_solutions::leapfrog_frequency(2.0, 1.0);
/// assert!((number - std::f64::consts::PI).abs() < 1e-12);
/// ```
pub fn leapfrog_frequency(omega: f64, dt: f64) -> f64 {
    2.0 / dt * libm::asin(0.5 * omega * dt)
}

/// Growth rate `s` of an oscillation `x = A exp(s t) cos(w t + p)` from four of its values at intervals of
/// `apart`, about a quarter of a period; NaN if the values belong to no oscillation.
///
/// ```text
/// q = (x_2^2 - x_1 x_3)/(x_1^2 - x_0 x_2) = exp(2 s apart),   since x_2 = p x_1 - q x_0
/// ```
///
/// ```
/// use slipfront::exact_solutions::oscillation_growth;
/// let x = |t: f64| (-0.2 * t).exp() * (1.5 * t + 0.3).cos();
/// assert!((oscillation_growth([0.0, 1.0, 2.0, 3.0].map(x), 1.0) + 0.2).abs() < 1e-14);
/// ```
pub fn oscillation_growth([x0, x1, x2, x3]: [f64; 4], apart: f64) -> f64 {
    let q = (x2 * x2 - x1 * x3) / (x1 * x1 - x0 * x2);
    libm::log(q) / (2.0 * apart)
}

/// Direction of a groove or a front relative to the sliding direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// The groove runs across the sliding direction: its edges are pulled and pushed.
    Across,
    /// The groove runs along the sliding direction: its edges are sheared.
    Along,
}

impl Facing {
    /// Stiffness between neighbouring rows that move as rigid bodies: `k_1 + k_2` in tension, `k_2` in shear.
    pub fn row_stiffness(self) -> f64 {
        match self {
            Facing::Across => K_STRAIGHT + K_DIAGONAL,
            Facing::Along => K_DIAGONAL,
        }
    }
}

/// Force on a row at the edge of a straight groove over the force of its own drive springs, before anything
/// slips, with periodic edges. The groove has `n` rows, each held by its drive springs and by stiffness K to
/// the next row:
///
/// ```text
/// F_edge = k_s V t [1 + (K/k_s)(1 - r)],   cosh q = 1 + k_s/(2 K),   r = cosh(q (n-1)/2)/cosh(q (n+1)/2)
/// ```
///
/// ```
/// use slipfront::exact_solutions::{Facing, groove_edge_factor};
/// // One row along: k_s (V t - u) = 2 k_2 u and k_s = k_2 give u = V t/3, which each edge bears on top of its own.
/// assert!((groove_edge_factor(Facing::Along, 1) - (1.0 + 1.0 / 3.0)).abs() < 1e-12);
/// ```
pub fn groove_edge_factor(facing: Facing, n: usize) -> f64 {
    let k = facing.row_stiffness();
    let q = libm::acosh(1.0 + K_DRIVE / (2.0 * k));
    let n = n as f64;
    let r = libm::cosh(0.5 * q * (n - 1.0)) / libm::cosh(0.5 * q * (n + 1.0));
    1.0 + k / K_DRIVE * (1.0 - r)
}

/// Speed of a slip front that enters blocks under a uniform prestress `tau = (F - F_k)/(F_s - F_k)`, without
/// drive springs and damping:
///
/// ```text
/// v = c/sqrt(1 - tau^2),   tau >= 1/2
/// ```
///
/// `c`: speed of long waves in blocks per unit of time, the square root of the stiffness between neighbouring
/// rows.
///
/// ```
/// assert_eq!(slipfront::exact_solutions::front_speed(1.0, 0.6), 1.25);
/// ```
pub fn front_speed(c: f64, tau: f64) -> f64 {
    c / (1.0 - tau * tau).sqrt()
}
