//! Friction that follows speed and the state of the contact.

use crate::elementary::{SMALL_DECAY, exp, ln, mean_decay, small_mean_decay};

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

/// Steps that no solution needs: far from the root each takes two units off the unknown, which begins less than 16 above it or 7
/// below for any `a` of 1e-8 and more, and comes no farther beyond it than 22; the last few triple the digits.
const MAX_STEPS: usize = 40;

/// After a step of this size the error, which is below its third power, is beyond the last digit.
const LAST_STEP: f64 = 1e-5;

/// The speed before is a good guess of the next if it is more than this share of the speed without friction.
const SLOW: f64 = 1e-3;

/// Least speed of which there is a logarithm; blocks that would be slower do not move.
const MIN_SPEED: f64 = 1e-300;

/// Least logarithm of the factor of V: below, there is no friction.
const MIN_LOG_FACTOR: f64 = -300.0;

/// `[c_0, c_1]` of the logarithm of the factor of V as a function of the state, `c_0 + c_1 ln(theta)`.
pub(crate) type LogFactors = [f64; 2];

/// Speeds and magnitudes of friction of some blocks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sliding<const BLOCKS: usize> {
    /// Speeds after a step.
    pub(crate) speed: [f64; BLOCKS],
    /// Magnitudes of friction.
    pub(crate) friction: [f64; BLOCKS],
}

/// `x e^-step` of a step of at most [`LAST_STEP`].
#[inline(always)]
fn decayed(x: f64, step: f64) -> f64 {
    x - x * (step * (1.0 - step * (0.5 - step / 6.0)))
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
    /// What does not change from block to block of [`log_factor`](Self::log_factor).
    pub(crate) fn log_factors(&self) -> LogFactors {
        let at_one = (self.mu_0 + self.b * ln(self.v_0 / self.d_c)) / self.a - ln(2.0 * self.v_0);
        [at_one, self.b / self.a]
    }

    /// `ln` of the factor of V in the regularised law, `(mu_0 + b ln(V_0 theta/D_c))/a - ln(2 V_0)`.
    #[inline(always)]
    fn log_factor([at_one, slope]: LogFactors, theta: f64) -> f64 {
        at_one + slope * ln(theta)
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
        self.a * asinh_of_exp(Self::log_factor(self.log_factors(), theta) + libm::log(speed))
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
        let x = speed * (dt / self.d_c);
        let mean_decay = mean_decay(x);
        let decay = if x < SMALL_DECAY {
            1.0 - x * mean_decay
        } else {
            exp(-x)
        };
        theta * decay + dt * mean_decay
    }

    /// [`evolve`](Self::evolve) of some blocks.
    #[inline(always)]
    pub(crate) fn evolve_all<const BLOCKS: usize>(
        &self,
        theta: &mut [f64; BLOCKS],
        speed: &[f64; BLOCKS],
        dt: f64,
    ) {
        // Slip over a step is nearly always short, which takes no exponential.
        let per_speed = dt / self.d_c;
        if (0..BLOCKS).fold(true, |all, k| all & (speed[k] * per_speed < SMALL_DECAY)) {
            for k in 0..BLOCKS {
                let x = speed[k] * per_speed;
                let mean_decay = small_mean_decay(x);
                theta[k] = theta[k] * (1.0 - x * mean_decay) + dt * mean_decay;
            }
        } else {
            for k in 0..BLOCKS {
                theta[k] = self.evolve(theta[k], speed[k], dt);
            }
        }
    }

    /// The speeds after a step and the friction of some blocks, whose speeds would be `free` without friction and were `before`:
    ///
    /// ```text
    /// v + g F_n mu(v, theta) = free
    /// ```
    ///
    /// with the change of speed per force `g = dt/(m c+)`. With `w = mu/a` as the unknown and `L` the
    /// [`log_factor`](Self::log_factor), `v = sinh(w) e^-L`, and the equation is
    ///
    /// ```text
    /// h(w) = (e^(w - L) - e^-(w + L))/2 + g F_n a w - free = 0
    /// ```
    ///
    /// It is solved by Halley's method, from the speed before, or, if this was much less, from the speed without friction. After a
    /// [`LAST_STEP`] a block stays where it is: it has the same bits whatever blocks are beside it.
    #[inline(always)]
    pub(crate) fn slide<const BLOCKS: usize>(
        &self,
        factors: LogFactors,
        [free, before]: [&[f64; BLOCKS]; 2],
        theta: &[f64; BLOCKS],
        normal_force: &[f64; BLOCKS],
        g: &[f64; BLOCKS],
    ) -> Sliding<BLOCKS> {
        let zeros = [0.0; BLOCKS];
        let (mut log_factor, mut per_unit) = (zeros, zeros);
        // Nothing holds a block over a texture, and nothing moves one that would not move without friction: others take their place.
        let is_held = |k: usize| (free[k] > MIN_SPEED) & (normal_force[k] > 0.0);
        let (mut target, mut guess) = (zeros, zeros);
        for k in 0..BLOCKS {
            let is_held = is_held(k);
            target[k] = if is_held { free[k] } else { 1.0 };
            guess[k] = if is_held { before[k].min(free[k]) } else { 1.0 };
            per_unit[k] = if is_held {
                g[k] * normal_force[k] * self.a
            } else {
                0.0
            };
        }
        // The two exponentials, and the latest step.
        let (mut w, mut rising, mut falling, mut step) = (zeros, zeros, zeros, [f64::INFINITY; BLOCKS]);
        let mut may_fall = false;
        for k in 0..BLOCKS {
            log_factor[k] = Self::log_factor(factors, theta[k]).max(MIN_LOG_FACTOR);
            let is_slow = guess[k] <= SLOW * target[k];
            rising[k] = 2.0 * if is_slow { target[k] } else { guess[k] };
            w[k] = log_factor[k] + ln(rising[k]);
            may_fall |= w[k] <= LARGE;
        }
        // What few blocks need stands behind a condition on all; the others do not change by it.
        if may_fall {
            for k in 0..BLOCKS {
                let guess = 0.5 * rising[k];
                let whole = guess + (guess * guess + exp(-2.0 * log_factor[k])).sqrt();
                let falls = w[k] <= LARGE;
                rising[k] = if falls { whole } else { rising[k] };
                let sum = log_factor[k] + ln(whole.max(MIN_SPEED));
                w[k] = if falls { sum } else { w[k] };
            }
        }
        // No friction is more than what stops a block.
        let is_beyond = |k: usize, w: f64| per_unit[k] * w > target[k];
        if (0..BLOCKS).fold(false, |any, k| any | is_beyond(k, w[k])) {
            for k in 0..BLOCKS {
                let most = target[k] / per_unit[k];
                let is_beyond = is_beyond(k, w[k]);
                w[k] = if is_beyond { most } else { w[k] };
                let exponential = exp(most - log_factor[k]);
                rising[k] = if is_beyond { exponential } else { rising[k] };
            }
        }
        for _ in 0..MAX_STEPS {
            if (0..BLOCKS).fold(false, |any, k| any | (w[k] <= LARGE)) {
                for k in 0..BLOCKS {
                    let now = if w[k] <= LARGE {
                        exp(-(log_factor[k] + w[k]))
                    } else {
                        0.0
                    };
                    falling[k] = if step[k].abs() > LAST_STEP {
                        now
                    } else {
                        falling[k]
                    };
                }
            } else {
                falling = zeros;
            }
            let mut goes_on = false;
            for k in 0..BLOCKS {
                let [sinh, cosh] = [rising[k] - falling[k], rising[k] + falling[k]].map(|sum| 0.5 * sum);
                let error = sinh + per_unit[k] * w[k] - target[k];
                let slope = cosh + per_unit[k];
                let next = error * slope / (slope * slope - 0.5 * error * sinh);
                step[k] = if step[k].abs() > LAST_STEP { next } else { 0.0 };
                w[k] -= step[k];
                goes_on |= step[k].abs() > LAST_STEP;
                rising[k] = decayed(rising[k], step[k]);
                falling[k] = decayed(falling[k], -step[k]);
            }
            if !goes_on {
                break;
            }
            for k in 0..BLOCKS {
                rising[k] = if step[k].abs() > LAST_STEP {
                    exp(w[k] - log_factor[k])
                } else {
                    rising[k]
                };
            }
        }
        let mut sliding = Sliding {
            speed: *free,
            friction: zeros,
        };
        for k in 0..BLOCKS {
            let is_held = is_held(k);
            let (speed, friction) = (0.5 * (rising[k] - falling[k]), normal_force[k] * self.a * w[k]);
            sliding.speed[k] = if is_held { speed } else { free[k] };
            sliding.friction[k] = if is_held { friction } else { 0.0 };
        }
        sliding
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

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: RateAndState = RateAndState {
        a: 0.01,
        b: 0.02,
        d_c: 0.5,
        v_0: 0.03,
        mu_0: 0.6,
        theta_0: 1.0,
        slip_speed: 1e-3,
    };

    /// Speeds, speeds before, states and loads of blocks that creep, slide, begin to, stop, float, or are no block.
    const BLOCKS: [[f64; 4]; 12] = [
        [0.03, 0.03, 16.7, 1.0],
        [0.03, 0.029, 16.0, 1.0],
        [0.03, 0.0, 16.7, 1.0],
        [1e-12, 0.5, 1e6, 1.0],
        [2.0, 1e-4, 1e-3, 1.0],
        [0.1, 0.1, 1.0, 0.0],
        [0.0, 0.0, 16.7, 1.0],
        [0.0, 0.0, 1.0, 0.0],
        [1e-30, 1e-29, 16.7, 3.0],
        [1e-60, 0.0, 16.7, 1e-6],
        [0.5, 20.0, 1e-12, 50.0],
        [0.02, 0.04, 20.0, 0.7],
    ];

    /// Change of speed per force.
    const G: f64 = 0.1;

    /// The speeds without friction that leave these speeds.
    fn free_speeds(law: &RateAndState) -> [f64; 12] {
        BLOCKS.map(|[speed, _, theta, load]| {
            let friction = if speed > 0.0 {
                load * law.coefficient(speed, theta)
            } else {
                0.0
            };
            speed + G * friction
        })
    }

    /// At the speed that is found friction is that of the law, and both together take the block from its free speed. A speed is as
    /// exact as `w`, of some hundreds, and as the difference of the two exponentials, near `e^-L` where it is small; and friction and
    /// free speed cancel where the law is steep.
    #[test]
    fn speed_and_friction_fulfil_the_law() {
        for a in [0.01, 0.1, 1e-3] {
            let law = RateAndState { a, ..LAW };
            let free = free_speeds(&law);
            let column = |number: usize| BLOCKS.map(|block| block[number]);
            let found = law.slide(
                law.log_factors(),
                [&free, &column(1)],
                &column(2),
                &column(3),
                &[G; 12],
            );
            for (k, [exact, _, theta, load]) in BLOCKS.into_iter().enumerate() {
                let (speed, friction) = (found.speed[k], found.friction[k]);
                let rounding = 4.0 * f64::EPSILON * free[k];
                let of_exponentials =
                    4.0 * f64::EPSILON * exp(-RateAndState::log_factor(law.log_factors(), theta));
                let left = speed + G * friction - free[k];
                assert!(left.abs() <= rounding + of_exponentials, "{a} {k}: {left:e}");
                if speed > 0.0 && load > 0.0 {
                    let of_law = load * law.coefficient(speed, theta);
                    assert!(
                        (friction - of_law).abs() <= 1e-14 * of_law + 1e-14 * load * a,
                        "{a} {k}: {friction} {of_law}"
                    );
                }
                let slope = if exact > 0.0 { G * load * a / exact } else { 0.0 };
                let bound = 1e-12 * exact + of_exponentials + rounding / (1.0 + slope);
                assert!((speed - exact).abs() <= bound, "{a} {k}: {speed:e} {exact:e}");
            }
        }
    }

    /// Bits of a block do not depend on those beside it.
    #[test]
    fn blocks_have_the_same_bits_alone() {
        let (free, factors) = (free_speeds(&LAW), LAW.log_factors());
        let column = |number: usize| BLOCKS.map(|block| block[number]);
        let together = LAW.slide(factors, [&free, &column(1)], &column(2), &column(3), &[G; 12]);
        let mut theta = column(2);
        LAW.evolve_all(&mut theta, &column(0), 30.0);
        for (k, [speed, before, state, load]) in BLOCKS.into_iter().enumerate() {
            let alone = LAW.slide(factors, [&[free[k]], &[before]], &[state], &[load], &[G]);
            assert_eq!(alone.speed[0].to_bits(), together.speed[k].to_bits(), "{k}");
            assert_eq!(alone.friction[0].to_bits(), together.friction[k].to_bits(), "{k}");
            let mut alone = [state];
            LAW.evolve_all(&mut alone, &[speed], 30.0);
            assert_eq!(alone[0].to_bits(), theta[k].to_bits(), "{k}");
            assert_eq!(
                alone[0].to_bits(),
                LAW.evolve(state, speed, 30.0).to_bits(),
                "{k}"
            );
        }
    }
}
