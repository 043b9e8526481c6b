//! Sliders under laws of friction with thresholds that change.

use super::bisection::bisected;
use crate::friction::{Ageing, RateAndState, Weakening};

/// Growth rate of a small disturbance of steady sliding at `v`, for a block of mass 1 on a spring of
/// stiffness `k`, with friction `mu_k F_n` = `kinetic` at rest and damping `Omega`: the larger real part of
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

/// Time at which a block slips if it has been stuck since t = 0 and is pulled by a spring of stiffness `k`.
/// The end of the spring rests until `hold` and then moves at `v`. The static friction at age 0 is 1, so that
///
/// ```text
/// k v (t - hold) = 1 + beta ln(1 + t/tau)
/// ```
///
/// ```
/// # use slipfront::{Ageing, exact_solutions::ageing_slip_time};
/// // Without ageing as always.
/// let none = Ageing { beta: 0.0, time: 1.0 };
/// assert_eq!(ageing_slip_time(&none, 0.0, 40.0, 0.5, 0.1), 60.0);
/// // The pull of the spring may begin at another value than 0, and the age at another time.
/// assert_eq!(ageing_slip_time(&none, 0.5, 40.0, 0.5, 0.1), 50.0);
/// ```
///
/// `pull`: force of the spring while its end rests.
pub fn ageing_slip_time(law: &Ageing, pull: f64, hold: f64, k: f64, v: f64) -> f64 {
    slip_time(law, 0.0, pull, hold, k, v)
}

fn slip_time(law: &Ageing, stopped_at: f64, pull: f64, hold: f64, k: f64, v: f64) -> f64 {
    let aged = |t: f64| 1.0 + law.beta * libm::log1p((t - stopped_at) / law.time);
    let excess = |t: f64| pull + k * v * (t - hold) - aged(t);
    // The pull rises linearly, and from some time on faster than the threshold: find a bracket, then bisect
    // to the last bit.
    let (mut low, mut high) = (hold, hold + 1.0);
    while excess(high) < 0.0 {
        (low, high) = (high, hold + 2.0 * (high - hold));
    }
    bisected([low, high], |t| excess(t) >= 0.0)
}

/// Stop of a block that slides steadily at `v` when its drive stops. With `w^2 = k - Omega^2/4` the block
/// comes to rest after
///
/// ```text
/// t_stop = (pi - atan(2 w/Omega))/w,   where its spring pulls with   F_stop = mu_k F_n - sqrt(k) v exp(-Omega t_stop/2)
/// ```
///
/// The motion solves `v'' + Omega v' + k v = 0`, `v(0) = v`, `v'(0) = 0`. This holds for `Omega^2 < 4 k`; a
/// block with more damping creeps and never stops.
///
/// ```
/// # use slipfront::exact_solutions::StopOfSteadySliding;
/// // Without damping a quarter of a period.
/// let stop = StopOfSteadySliding::new(0.5, 0.1, 0.25, 0.0);
/// assert_eq!((stop.time, stop.pull), (std::f64::consts::PI, 0.45));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopOfSteadySliding {
    /// Time `t_stop` from the stop of the drive to the stop of the block.
    pub time: f64,
    /// Force `F_stop` of the drive spring when the block stops.
    pub pull: f64,
}

impl StopOfSteadySliding {
    /// The stop of a block with kinetic friction `kinetic` = `mu_k F_n` on a drive spring of stiffness `k`;
    /// the mass is 1.
    pub fn new(kinetic: f64, v: f64, k: f64, damping: f64) -> Self {
        let w = (k - 0.25 * damping * damping).sqrt();
        let time = (std::f64::consts::PI - libm::atan2(2.0 * w, damping)) / w;
        Self {
            time,
            pull: kinetic - k.sqrt() * v * libm::exp(-0.5 * damping * time),
        }
    }

    /// Time of the next slip if the drive stops at `stopped` and moves again at `v` from `restarted` on. The
    /// age of the contact counts from the stop of the block.
    pub fn next_slip_time(&self, law: &Ageing, stopped: f64, restarted: f64, k: f64, v: f64) -> f64 {
        slip_time(law, stopped + self.time, self.pull, restarted, k, v)
    }
}

/// Friction in excess of steady sliding at `v_2`, over `mu_s`, for a contact that slid steadily at `v_1` and
/// then slides at `v_2`, after a slip of `x`:
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
    law.b * libm::log1p((v_2 / v_1 - 1.0) * libm::exp(-x / law.d_c))
}

/// Growth rate of a small disturbance of steady sliding at `v`, for a block of mass 1 under the normal force
/// `sigma` on a spring of stiffness `k`: the largest real part of the roots of
///
/// ```text
/// (s^2 + A s + k)(s + q) = sigma b s/D_c,   A = sigma a/v + Omega,   q = v/D_c
/// ```
///
/// The rate is positive below [`RateAndState::critical_stiffness`] and negative above.
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
    // The polynomial is positive at 0 and negative far to the left. Bisection finds the root between; the
    // other two are roots of the quadratic quotient.
    let far = -1.0 - c2.abs().max(c1.abs()).max(c0);
    let root = bisected([far, 0.0], |s| cubic(s) > 0.0);
    let (half, product) = (-0.5 * (c2 + root), c1 + root * (c2 + root));
    let discriminant = (half * half - product).max(0.0);
    root.max(half + discriminant.sqrt())
}

/// Slip of a block without damping in a jump: its strength falls faster than its drive spring unloads, while
/// the drive stands still at the threshold. The block comes to rest beyond the weakening length `D_c = D/W`,
/// where the spring has done as much work as friction:
///
/// ```text
/// s = [D + sqrt(D^2 - k_s D D_c)]/k_s
/// ```
///
/// `drop`: difference `D` of the thresholds; `weakening`: `W > k_s`, loss of strength per slip; `k`: `k_s`.
///
/// ```
/// # use slipfront::exact_solutions::slip_of_jump;
/// assert_eq!(slip_of_jump(0.5, 0.5, 0.375), 2.0);
/// for weakening in [0.6, 2.0] {
///     assert!(slip_of_jump(0.5, weakening, 0.375) > 0.5 / weakening);
/// }
/// ```
pub fn slip_of_jump(drop: f64, weakening: f64, k: f64) -> f64 {
    (drop + (drop * drop - k * drop * (drop / weakening)).sqrt()) / k
}

/// Ratio of the first peak of friction to its mean in sliding, for a rigid slider that is moved slowly on
/// springs with thresholds distributed uniformly from 1 - w to 1 + w, w <= 1/3. All springs have the same
/// extension until the weakest breaks, at 1 - w. Later the extension of each spring is distributed uniformly
/// up to its threshold, so that it bears half its threshold on average. A spring that keeps its threshold x
/// breaks at a rate proportional to 1/x:
///
/// ```text
/// kept:   2 (1 - w)          drawn anew:   2 (1 - w)/(1 + w^2/3),   since the mean is <x^2>/(2 <x>)
/// ```
///
/// ```
/// # use slipfront::exact_solutions::static_over_kinetic_of_springs;
/// assert_eq!(static_over_kinetic_of_springs(0.25, false), 1.5);
/// for (w, ratio) in [(0.05, 1.8984), (0.1, 1.7940), (0.2, 1.5789)] {
///     assert!((static_over_kinetic_of_springs(w, true) - ratio).abs() < 5e-5);
/// }
/// ```
pub fn static_over_kinetic_of_springs(w: f64, redrawn: bool) -> f64 {
    let kept = 2.0 * (1.0 - w);
    if redrawn { kept / (1.0 + w * w / 3.0) } else { kept }
}

/// Force on the first block of a chain of `n` at which its spring to the substrate breaks, over the threshold
/// of this spring, in equilibrium. Springs have stiffness `k` between the blocks and `k_t` to the substrate.
///
/// ```text
/// F/(mu_s F_n) = sinh(q n)/(2 sinh(q/2) cosh(q (n - 1/2))),   cosh q = 1 + k_t/(2 k)
/// ```
///
/// ```
/// # use slipfront::exact_solutions::chain_slip_force;
/// // One block; two blocks, of which k u_1 = (k + k_t) u_2: F = k_t (u_1 + u_2).
/// assert!((chain_slip_force(1, 0.75, 0.1) - 1.0).abs() < 1e-12);
/// assert!((chain_slip_force(2, 0.75, 0.25) - 1.75).abs() < 1e-12);
/// ```
pub fn chain_slip_force(n: usize, k: f64, k_t: f64) -> f64 {
    let q = libm::acosh(1.0 + 0.5 * k_t / k);
    let n = n as f64;
    libm::sinh(q * n) / (2.0 * libm::sinh(0.5 * q) * libm::cosh(q * (n - 0.5)))
}
