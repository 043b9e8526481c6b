//! Heterogeneous sliders, sliders with damped springs, and surfaces of two zones.

use crate::lattice::{K_DRIVE, K_STRAIGHT};

/// Time of the first slip of a slider without texture that has blocks of different stiffness. Until then
/// nothing has moved, so that
///
/// ```text
/// k_s,i V* t* = max(mu_si, mu_ki) F_n,i,   k_s,i = k_s E_i/E
/// ```
///
/// for the block that slips first. `limits`: the right-hand sides; `stiffness`: `E_i/E`.
///
/// ```
/// use slipfront::exact_solutions::graded_first_slip_time_star;
/// // The stiffer block slips first although it holds more.
/// assert_eq!(graded_first_slip_time_star(&[0.75, 1.5], &[1.0, 4.0], 0.01), 100.0);
/// ```
pub fn graded_first_slip_time_star(limits: &[f64], stiffness: &[f64], v_star: f64) -> f64 {
    let extensions = limits
        .iter()
        .zip(stiffness)
        .map(|(limit, modulus)| limit / modulus);
    extensions.fold(f64::INFINITY, f64::min) / (K_DRIVE * v_star)
}

/// A mode of two blocks: the square of its frequency, and the displacement of the second block over that of
/// the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairMode {
    /// Square of the frequency, `omega^2`.
    pub omega_squared: f64,
    /// Ratio of the displacements, `u_2/u_1`.
    pub ratio: f64,
}

/// The modes of two blocks in a row, with moduli `E_1`, `E_2` and masses `m_1`, `m_2`, without friction. The
/// spring between the blocks has the harmonic mean of their moduli, and the drive spring of each block has
/// the modulus of the block:
///
/// ```text
/// m_i u_i'' = -k_s E_i u_i + k (u_j - u_i),   k = k_1 2 E_1 E_2/(E_1 + E_2)
/// ```
///
/// ```
/// use slipfront::exact_solutions::pair_modes;
/// // Equal blocks swing together on their drive springs, or against each other.
/// let [slow, fast] = pair_modes([1.0, 1.0], [1.0, 1.0]);
/// assert_eq!((slow.omega_squared, slow.ratio), (0.375, 1.0));
/// assert_eq!((fast.omega_squared, fast.ratio), (0.375 + 2.0 * 0.75, -1.0));
/// ```
pub fn pair_modes(stiffness: [f64; 2], masses: [f64; 2]) -> [PairMode; 2] {
    let [one, other] = stiffness;
    let k = K_STRAIGHT * 2.0 * one * other / (one + other);
    let own = [0, 1].map(|i| (k + K_DRIVE * stiffness[i]) / masses[i]);
    let (mean, half) = (0.5 * (own[0] + own[1]), 0.5 * (own[0] - own[1]));
    let root = (half * half + k * k / (masses[0] * masses[1])).sqrt();
    [mean - root, mean + root].map(|omega_squared| PairMode {
        omega_squared,
        ratio: (own[0] - omega_squared) * masses[0] / k,
    })
}

/// Decay rate of the amplitude of a mode of equal blocks, with a damper in parallel with every spring between
/// blocks (Kelvin-Voigt), `eta = tau_v k`, for small oscillations without contact:
///
/// ```text
/// (1/2) [Omega + tau_v (omega^2 - k_s)]
/// ```
///
/// `omega_squared`: squared frequency of the mode without dampers; dampers do not act on the part of it that
/// comes from drive springs. `damping`: `Omega`.
///
/// ```
/// use slipfront::exact_solutions::viscous_decay_rate;
/// // Together, all blocks swing on their drive springs alone.
/// assert_eq!(viscous_decay_rate(0.375, 0.2, 5.0), 0.1);
/// ```
pub fn viscous_decay_rate(omega_squared: f64, damping: f64, viscosity_time: f64) -> f64 {
    0.5 * (damping + viscosity_time * (omega_squared - K_DRIVE))
}

/// Decay rate of the amplitude of a mode with dampers in steps of `dt` at `Omega` = 0. A damper acts with the
/// velocity half a step before, so that the rate differs from [`viscous_decay_rate`]:
///
/// ```text
/// -ln(1 - gamma dt)/(2 dt),   gamma = tau_v (omega^2 - k_s)
/// ```
///
/// ```
/// use slipfront::exact_solutions::{lagged_decay_rate, viscous_decay_rate};
/// let exact = viscous_decay_rate(2.0, 0.0, 0.1);
/// let excess = |dt: f64| lagged_decay_rate(2.0, 0.1, dt) / exact - 1.0;
/// // Of first order.
/// assert!((excess(2e-3) / excess(1e-3) - 2.0).abs() < 1e-3);
/// ```
pub fn lagged_decay_rate(omega_squared: f64, viscosity_time: f64, dt: f64) -> f64 {
    let gamma = viscosity_time * (omega_squared - K_DRIVE);
    -libm::log1p(-gamma * dt) / (2.0 * dt)
}

/// Largest mu* of a surface of two zones with blocks that do not pull on each other: a fraction `f` of the
/// blocks has the static coefficient `mu_1`, the rest `mu_2 > mu_1`, both over `mu_s`, and kinetic friction
/// is R* times as large. For `Omega* > sqrt(2)` a block that has slipped does not oscillate. In the limit of
/// a slow drive
///
/// ```text
/// mu* = max(mu_1, f R* mu_1 + (1 - f) mu_2)
/// ```
///
/// at the slip of the first or of the second zone. A faster drive adds the drag of the first zone, at most
/// `f Omega V*`.
///
/// ```
/// use slipfront::exact_solutions::composite_peak;
/// assert_eq!(composite_peak(0.5, [0.5, 1.0], 0.5), 0.625);
/// assert_eq!(composite_peak(0.5, [0.9, 1.0], 0.25), 0.9);
/// ```
pub fn composite_peak(f: f64, [mu_1, mu_2]: [f64; 2], r_star: f64) -> f64 {
    mu_1.max(f * r_star * mu_1 + (1.0 - f) * mu_2)
}
