//! Speeds of blocks whose friction grows with the inverse hyperbolic sine of the speed.

use crate::elementary::{exp, ln};

/// Bound on logarithms and arguments: above it `asinh x = ln(2 x)` to the last bit for the logarithm of x,
/// and `sinh` has one exponential for the argument.
pub(super) const LARGE: f64 = 20.0;

/// Limit on the steps of an iteration, which no solution reaches: far from the root each step takes two units
/// off the unknown, which begins less than 16 above it or 7 below for any `a` of 1e-8 and more, and comes no
/// farther beyond it than 22; the last few steps triple the digits.
const MAX_STEPS: usize = 40;

/// Size of a step after which the error, which is below the third power of the step, is beyond the last
/// digit.
const LAST_STEP: f64 = 1e-5;

/// The speed before is a good guess of the next if it is more than this share of the speed without friction.
const SLOW: f64 = 1e-3;

/// Least speed of which there is a logarithm; blocks that would be slower do not move.
const MIN_SPEED: f64 = 1e-300;

/// Least logarithm of the factor of V, below which there is no friction.
const MIN_LOG_FACTOR: f64 = -300.0;

/// Speeds and magnitudes of friction of some blocks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sliding<const BLOCKS: usize> {
    /// Speeds after a step.
    pub(super) speed: [f64; BLOCKS],
    /// Magnitudes of friction.
    pub(super) friction: [f64; BLOCKS],
}

/// Speeds after a step and magnitudes of friction of some blocks under `mu = a asinh(V e^L)`, whose speeds
/// would be `free` without friction and were `before`:
///
/// ```text
/// v + g F_n a asinh(v e^L) = free
/// ```
///
/// With `w = mu/a` as the unknown `v = sinh(w) e^-L`, and the equation is
///
/// ```text
/// h(w) = (e^(w - L) - e^-(w + L))/2 + g F_n a w - free = 0
/// ```
///
/// It is solved by Halley's method, from the speed before, or, if this was much less, from the speed without
/// friction. After a [`LAST_STEP`] a block stays where it is: it has the same bits whatever blocks are beside
/// it.
#[inline(always)]
pub(super) fn slide<const BLOCKS: usize>(
    a: f64,
    [free, before]: [&[f64; BLOCKS]; 2],
    log_factor: &[f64; BLOCKS],
    normal_force: &[f64; BLOCKS],
    g: &[f64; BLOCKS],
) -> Sliding<BLOCKS> {
    let zeros = [0.0; BLOCKS];
    // Nothing holds a block over a texture, and nothing moves one that would not move without friction:
    // others take their place.
    let is_held = |k: usize| (free[k] > MIN_SPEED) & (normal_force[k] > 0.0);
    let mut equations = Equations {
        target: zeros,
        per_unit: zeros,
        log_factor: zeros,
    };
    let mut guess = zeros;
    for k in 0..BLOCKS {
        let is_held = is_held(k);
        equations.target[k] = if is_held { free[k] } else { 1.0 };
        guess[k] = if is_held { before[k].min(free[k]) } else { 1.0 };
        equations.per_unit[k] = if is_held { g[k] * normal_force[k] * a } else { 0.0 };
        equations.log_factor[k] = log_factor[k].max(MIN_LOG_FACTOR);
    }
    let mut roots = Roots::near(&equations, &guess);
    for _ in 0..MAX_STEPS {
        if !roots.improve(&equations) {
            break;
        }
    }
    let mut sliding = Sliding {
        speed: *free,
        friction: zeros,
    };
    for k in 0..BLOCKS {
        let is_held = is_held(k);
        let w = roots.w[k].max(0.0);
        let friction = normal_force[k] * a * w;
        let [sinh, cosh] = sinh_and_cosh(roots.rising[k], roots.falling[k]);
        // Rounding leaves an error of cosh(w) e^-L, in units of the last place, in the one, and of these in
        // the other: where friction has nearly vanished sinh is the difference of two large numbers.
        let left = (equations.target[k] - equations.per_unit[k] * w).max(0.0);
        let is_left = cosh > equations.target[k] + equations.per_unit[k];
        let speed = if is_left { left } else { sinh };
        sliding.speed[k] = if is_held { speed } else { free[k] };
        sliding.friction[k] = if is_held { friction } else { 0.0 };
    }
    sliding
}

/// The equations `h(w) = 0` of some blocks.
struct Equations<const BLOCKS: usize> {
    /// Speed without friction.
    target: [f64; BLOCKS],
    /// Factor of `w`, `g F_n a`.
    per_unit: [f64; BLOCKS],
    /// Logarithm `L` of the factor of V.
    log_factor: [f64; BLOCKS],
}

/// Approximate solutions of [`Equations`].
struct Roots<const BLOCKS: usize> {
    w: [f64; BLOCKS],
    /// The rising exponential `e^(w - L)`.
    rising: [f64; BLOCKS],
    /// The falling exponential `e^-(w + L)`.
    falling: [f64; BLOCKS],
    /// Amount by which `w` was lowered last; infinite before the first step.
    step: [f64; BLOCKS],
}

impl<const BLOCKS: usize> Roots<BLOCKS> {
    /// Initial guesses of the roots: those that belong to the speeds `guess` or to the speeds without
    /// friction, and none beyond the friction that stops a block.
    #[inline(always)]
    fn near(equations: &Equations<BLOCKS>, guess: &[f64; BLOCKS]) -> Self {
        let Equations {
            target,
            per_unit,
            log_factor,
        } = equations;
        let zeros = [0.0; BLOCKS];
        let (mut w, mut rising) = (zeros, zeros);
        let mut may_fall = false;
        for k in 0..BLOCKS {
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
        Self {
            w,
            rising,
            falling: zeros,
            step: [f64::INFINITY; BLOCKS],
        }
    }

    /// Takes a step of Halley's method towards each root that is not found yet; returns whether there was
    /// such a root.
    #[inline(always)]
    fn improve(&mut self, equations: &Equations<BLOCKS>) -> bool {
        let Equations {
            target,
            per_unit,
            log_factor,
        } = equations;
        let Self {
            w,
            rising,
            falling,
            step,
        } = self;
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
            *falling = [0.0; BLOCKS];
        }
        let mut goes_on = false;
        for k in 0..BLOCKS {
            let [sinh, cosh] = sinh_and_cosh(rising[k], falling[k]);
            let error = sinh + per_unit[k] * w[k] - target[k];
            let slope = cosh + per_unit[k];
            let next = error * slope / (slope * slope - 0.5 * error * sinh);
            step[k] = if step[k].abs() > LAST_STEP { next } else { 0.0 };
            w[k] -= step[k];
            goes_on |= step[k].abs() > LAST_STEP;
            rising[k] = decayed(rising[k], step[k]);
            falling[k] = decayed(falling[k], -step[k]);
        }
        if goes_on {
            for k in 0..BLOCKS {
                rising[k] = if step[k].abs() > LAST_STEP {
                    exp(w[k] - log_factor[k])
                } else {
                    rising[k]
                };
            }
        }
        goes_on
    }
}

/// The products `sinh w e^-L` and `cosh w e^-L` from `e^(w - L)` and `e^-(w + L)`.
#[inline(always)]
fn sinh_and_cosh(rising: f64, falling: f64) -> [f64; 2] {
    [rising - falling, rising + falling].map(|sum| 0.5 * sum)
}

/// The product `x e^-step` for a step of at most [`LAST_STEP`].
#[inline(always)]
fn decayed(x: f64, step: f64) -> f64 {
    x - x * (step * (1.0 - step * (0.5 - step / 6.0)))
}
