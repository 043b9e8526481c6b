//! Steady sliding under friction that falls with speed.

use crate::friction::Weakening;

/// Rate at which a small disturbance of steady sliding at `v` grows, of a block of mass 1 on a spring of stiffness `k`, with friction
/// `mu_k F_n` = `kinetic` at rest and damping `Omega`: the larger real part of
///
/// ```text
/// s^2 + (Omega + dF/dv) s + k = 0,   dF/dv = -kinetic (1 - ratio) v_c/(v_c + v)^2
/// ```
///
/// Steady sliding is unstable if and only if `dF/dv + Omega < 0`.
///
/// ```
/// # use slipfront::{Weakening, exact_solutions::weakening_growth};
/// // dF/dv = -0.5 0.5 0.1/0.2^2 = -0.625.
/// let law = Weakening { critical_speed: 0.1, ratio: 0.5 };
/// assert!((weakening_growth(&law, 0.5, 0.1, 0.375, 0.525) - 0.05).abs() < 1e-15);
/// ```
pub fn weakening_growth(law: &Weakening, kinetic: f64, v: f64, k: f64, damping: f64) -> f64 {
    let slope = -kinetic * (1.0 - law.ratio) * law.critical_speed / (law.critical_speed + v).powi(2);
    let resistance = damping + slope;
    let discriminant = (0.25 * resistance * resistance - k).max(0.0);
    -0.5 * resistance + discriminant.sqrt()
}
