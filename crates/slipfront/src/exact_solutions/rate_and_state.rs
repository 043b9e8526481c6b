//! Sliding under rate and state.

use crate::friction::RateAndState;

/// Friction above that of steady sliding at `v_2`, over `mu_s`, of a contact that slid steadily at `v_1` and is made to slide at `v_2`,
/// after a slip of `x` (ageing law):
///
/// ```text
/// mu - mu_ss = b ln[1 + (v_2/v_1 - 1) exp(-x/D_c)]
/// ```
///
/// ```
/// # use slipfront::{RateAndState, exact_solutions::friction_after_speed_step};
/// let law = RateAndState { a: 0.01, b: 0.02, d_c: 0.5, v_0: 0.03, mu_0: 0.6, theta_0: 1.0, slip_speed: 0.01 };
/// // At once mu lies a ln 10 above the old level, which lies (b - a) ln 10 above the new one.
/// assert!((friction_after_speed_step(&law, 1.0, 10.0, 0.0) - 0.02 * 10_f64.ln()).abs() < 1e-16);
/// ```
pub fn friction_after_speed_step(law: &RateAndState, v_1: f64, v_2: f64, x: f64) -> f64 {
    law.b * ((v_2 / v_1 - 1.0) * (-x / law.d_c).exp()).ln_1p()
}

/// Rate at which a small disturbance of steady sliding at `v` grows, of a block of mass 1 under the normal force `sigma` on a spring of
/// stiffness `k`: the largest real part of the roots of
///
/// ```text
/// (s^2 + A s + k)(s + q) = sigma b s/D_c,   A = sigma a/v + Omega,   q = v/D_c
/// ```
///
/// It is positive below [`RateAndState::critical_stiffness`] and negative above.
///
/// ```
/// # use slipfront::{RateAndState, exact_solutions::rate_and_state_growth};
/// let law = RateAndState { a: 0.01, b: 0.02, d_c: 0.5, v_0: 0.03, mu_0: 0.6, theta_0: 1.0, slip_speed: 0.01 };
/// let critical = law.critical_stiffness(1.0, 0.0, 0.03);
/// assert!(rate_and_state_growth(&law, 1.0, 0.03, critical, 0.0).abs() < 1e-9);
/// assert!(rate_and_state_growth(&law, 1.0, 0.03, 0.9 * critical, 0.0) > 0.0);
/// ```
pub fn rate_and_state_growth(law: &RateAndState, sigma: f64, v: f64, k: f64, damping: f64) -> f64 {
    let (resistance, q) = (sigma * law.a / v + damping, v / law.d_c);
    // s^3 + c2 s^2 + c1 s + c0.
    let (c2, c1, c0) = (
        resistance + q,
        k + resistance * q - sigma * law.b / law.d_c,
        k * q,
    );
    let cubic = |s: f64| ((s + c2) * s + c1) * s + c0;
    // It is positive at 0 and negative far to the left: the root between them by bisection, the others of what remains.
    let (mut low, mut high) = (-1.0 - c2.abs().max(c1.abs()).max(c0), 0.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if cubic(middle) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    let root = 0.5 * (low + high);
    let (half, product) = (-0.5 * (c2 + root), c1 + root * (c2 + root));
    let discriminant = (half * half - product).max(0.0);
    root.max(half + discriminant.sqrt())
}
