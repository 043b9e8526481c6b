//! Friction that follows speed and the state of the contact.

use crate::elementary::{exp, ln, mean_decay};

/// Rate and state with the ageing law: `mu = mu_0 + a ln(V/V_0) + b ln(V_0 theta/D_c)`, `dtheta/dt = 1 - V theta/D_c`; coefficients
/// over `mu_s`. The logarithm of the speed is regularised at V = 0,
///
/// ```text
/// mu = a asinh(V/(2 V_0) exp((mu_0 + b ln(V_0 theta/D_c))/a))
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateAndState {
    /// Direct effect.
    pub a: f64,
    /// Evolution effect.
    pub b: f64,
    /// Slip over which the state follows a change of speed, in units of `P mu_s l/E`.
    pub d_c: f64,
    /// Reference speed, in units of `P mu_s/sqrt(E rho)`.
    pub v_0: f64,
    /// Coefficient of steady sliding at the reference speed.
    pub mu_0: f64,
    /// State at the start, t*.
    pub theta_0: f64,
    /// A block counts as sliding above this speed.
    pub slip_speed: f64,
}

/// Above this logarithm of its argument, `asinh x = ln(2 x)` to the last bit; and above this argument `sinh` has one exponential.
const LARGE: f64 = 20.0;

/// Newton steps that no solution needs: while the exponential is more than the linear term each takes at least half a unit off the
/// unknown, which begins less than 16 above the root for any `a` of 1e-8 and more; the last few double the digits.
const MAX_STEPS: usize = 40;

/// Least speed of which there is a logarithm; blocks that would be slower do not move.
const MIN_SPEED: f64 = 1e-300;

/// `asinh(1)`.
const ASINH_1: f64 = 0.881_373_587_019_543;

/// Bounds of the logarithm of the factor of V: below, there is no friction, and above, its inverse is no more than the least speed.
const LOG_FACTORS: [f64; 2] = [-300.0, 340.0];

/// Speeds and magnitudes of friction of some blocks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sliding<const BLOCKS: usize> {
    /// Speeds after a step.
    pub(crate) speed: [f64; BLOCKS],
    /// Magnitudes of friction.
    pub(crate) friction: [f64; BLOCKS],
}

/// `asinh(exp(y))`, without overflow.
fn asinh_of_exp(y: f64) -> f64 {
    if y > LARGE {
        y + std::f64::consts::LN_2
    } else {
        libm::asinh(libm::exp(y))
    }
}

impl RateAndState {
    /// `ln` of the factor of V in the regularised law, `(mu_0 + b ln(V_0 theta/D_c))/a - ln(2 V_0)`.
    #[inline(always)]
    fn log_factor(&self, theta: f64) -> f64 {
        (self.mu_0 + self.b * ln(self.v_0 * theta / self.d_c)) / self.a - ln(2.0 * self.v_0)
    }

    /// Coefficient at a speed and state, over `mu_s`.
    ///
    /// ```
    /// # use slipfront::RateAndState;
    /// let law = RateAndState { a: 0.01, b: 0.02, d_c: 0.5, v_0: 0.03, mu_0: 0.6, theta_0: 1.0, slip_speed: 0.01 };
    /// // Steady sliding at V_0; a jump of speed by a factor of e raises friction by a.
    /// let steady = 0.5 / 0.03;
    /// assert!((law.coefficient(0.03, steady) - 0.6).abs() < 1e-15);
    /// assert!((law.coefficient(0.03 * 1_f64.exp(), steady) - 0.61).abs() < 1e-15);
    /// ```
    pub fn coefficient(&self, speed: f64, theta: f64) -> f64 {
        self.a * asinh_of_exp(self.log_factor(theta) + libm::log(speed))
    }

    /// Coefficient of steady sliding at a speed: that of the state `D_c/V`.
    pub fn steady_coefficient(&self, speed: f64) -> f64 {
        self.coefficient(speed, self.d_c / speed)
    }

    /// The state after a time at constant speed, exact:
    ///
    /// ```text
    /// theta' = theta e^-x + dt (1 - e^-x)/x,   x = V dt/D_c
    /// ```
    ///
    /// ```
    /// # use slipfront::RateAndState;
    /// let law = RateAndState { a: 0.01, b: 0.02, d_c: 0.5, v_0: 0.03, mu_0: 0.6, theta_0: 1.0, slip_speed: 0.01 };
    /// // At rest it is the age; in steady sliding it stays at D_c/V.
    /// assert_eq!(law.evolve(3.0, 0.0, 0.1), 3.1);
    /// assert!((law.evolve(5.0, 0.1, 2.0) - 5.0).abs() < 1e-14);
    /// ```
    #[inline(always)]
    pub fn evolve(&self, theta: f64, speed: f64, dt: f64) -> f64 {
        let x = speed * dt / self.d_c;
        theta * exp(-x) + dt * mean_decay(x)
    }

    /// The speeds after a step and the friction of some blocks, whose speeds would be `free` without friction:
    ///
    /// ```text
    /// v + g F_n mu(v, theta) = free
    /// ```
    ///
    /// with the change of speed per force `g = dt/(m c+)`. With `w = mu/a` as the unknown, `v = sinh(w) e^-L`, and the equation is
    /// `h(w) = sinh(w) e^-L + g F_n a w - free = 0`. For w >= 0 this h rises and is convex, so that Newton's method from the right of
    /// the root comes down to it step by step; it ends where rounding lets it come no further, where it stays: a
    /// block has the same bits whatever blocks are beside it. It begins at the lesser of the roots that each of the two terms alone
    /// would have, of the first an upper bound, `asinh(e^y) <= max(y, 0) + asinh(1)`.
    #[inline(always)]
    pub(crate) fn slide<const BLOCKS: usize>(
        &self,
        free: &[f64; BLOCKS],
        theta: &[f64; BLOCKS],
        normal_force: &[f64; BLOCKS],
        g: &[f64; BLOCKS],
    ) -> Sliding<BLOCKS> {
        let zeros = [0.0; BLOCKS];
        let (mut speed, mut w, mut log_factor, mut inverse_square) = (zeros, zeros, zeros, zeros);
        for k in 0..BLOCKS {
            log_factor[k] = self.log_factor(theta[k]).max(LOG_FACTORS[0]);
            let inverse = exp(-log_factor[k]);
            let is_small = log_factor[k] < LOG_FACTORS[1];
            inverse_square[k] = if is_small { inverse * inverse } else { 0.0 };
            let without_load = (log_factor[k] + ln(free[k].max(MIN_SPEED))).max(0.0) + ASINH_1;
            w[k] = (free[k] / (g[k] * normal_force[k] * self.a)).min(without_load);
        }
        for _ in 0..MAX_STEPS {
            let mut has_moved = false;
            for k in 0..BLOCKS {
                let per_unit = g[k] * normal_force[k] * self.a;
                let rising = exp(w[k] - log_factor[k]);
                let falling = if w[k] > LARGE {
                    0.0
                } else {
                    inverse_square[k] / rising
                };
                speed[k] = 0.5 * (rising - falling);
                let error = speed[k] + per_unit * w[k] - free[k];
                let next = w[k] - error / (0.5 * (rising + falling) + per_unit);
                has_moved |= next < w[k];
                w[k] = if next < w[k] { next } else { w[k] };
            }
            if !has_moved {
                break;
            }
        }
        let mut friction = zeros;
        for k in 0..BLOCKS {
            // Nothing holds a block over a texture, and nothing moves one that would not move without friction.
            let slides = (free[k] > MIN_SPEED) & (normal_force[k] > 0.0);
            friction[k] = if slides {
                normal_force[k] * self.a * w[k]
            } else {
                0.0
            };
            speed[k] = if slides { speed[k] } else { free[k] };
        }
        Sliding { speed, friction }
    }

    /// Stiffness per block below which steady sliding of a block at `speed` under the normal force `sigma` is unstable (Rice and
    /// Ruina 1983, with inertia and damping), in units of `E l`, for blocks of mass `m` = 1:
    ///
    /// ```text
    /// k_c = max(0, [(b - a) sigma - m Omega V]/D_c [1 + m V^2/((sigma a + m Omega V) D_c)])
    /// ```
    ///
    /// ```
    /// # use slipfront::{RateAndState, scales::damping};
    /// let law = RateAndState { a: 0.01, b: 0.02, d_c: 0.5, v_0: 0.03, mu_0: 0.6, theta_0: 1.0, slip_speed: 0.01 };
    /// assert!((law.critical_stiffness(1.0, damping(0.1), 0.03) - 0.0169).abs() < 5e-5);
    /// // So much damping that nothing makes it unstable.
    /// assert_eq!(law.critical_stiffness(1.0, damping(0.1), 0.3), 0.0);
    /// ```
    pub fn critical_stiffness(&self, sigma: f64, damping: f64, speed: f64) -> f64 {
        let viscous = damping * speed;
        let weakening = (self.b - self.a) * sigma - viscous;
        let inertia = speed * speed / ((sigma * self.a + viscous) * self.d_c);
        (weakening / self.d_c * (1.0 + inertia)).max(0.0)
    }
}
