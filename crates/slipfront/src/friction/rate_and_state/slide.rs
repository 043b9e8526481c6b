//! Speeds of blocks with friction that grows as the inverse hyperbolic sine of the speed.

use crate::elementary::{exp, ln};

/// Bound on logarithms and arguments. Above it `asinh x = ln(2 x)` to the last bit, with x given by its
/// logarithm, and one exponential is enough for `sinh` of the argument.
pub(super) const LARGE: f64 = 20.0;

/// Limit on the number of iterations, which no solution reaches. Far from the root each step changes the
/// unknown by two units; it begins less than 16 above the root or 7 below it for any `a` of 1e-8 and more,
/// and overshoots by at most 22. The last few steps triple the number of exact digits.
const MAX_STEPS: usize = 40;

/// Size of the last step: the error after it is below the third power of the step, and so beyond the last
/// digit.
const LAST_STEP: f64 = 1e-5;

/// Share of the speed without friction above which the speed before is a good initial guess.
const SLOW: f64 = 1e-3;

/// Least speed with a logarithm; blocks that would be slower do not move.
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

/// Speeds after a step and magnitudes of friction of some blocks under `mu = a asinh(V e^L)`, with the speeds
/// `free` without friction and `before` the step:
///
/// ```text
/// v + g F_n a asinh(v e^L) = free
/// ```
///
/// With the unknown `w = mu/a`, `v = sinh(w) e^-L`, and the equation is
///
/// ```text
/// h(w) = (e^(w - L) - e^-(w + L))/2 + g F_n a w - free = 0
/// ```
///
/// Halley's method solves it, beginning at the speed before, or, if this was much less, at the speed without
/// friction. A block is not changed any more after a [`LAST_STEP`], so that its bits do not depend on the
/// blocks computed with it.
#[inline(always)]
pub(super) fn slide<const BLOCKS: usize>(
    a: f64,
    [free, before]: [&[f64; BLOCKS]; 2],
    log_factor: &[f64; BLOCKS],
    normal_force: &[f64; BLOCKS],
    g: &[f64; BLOCKS],
) -> Sliding<BLOCKS> {
    let zeros = [0.0; BLOCKS];
    // A block over a texture has no friction, and a block that would not move without friction stays at rest:
    // dummy values replace both in the iteration.
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
        // Of two formulas for the speed, takes the one with the smaller rounding error, in units of the last
        // place: cosh(w) e^-L for `sinh`, target + per_unit for `left`. Where friction has nearly vanished,
        // sinh is the difference of two large numbers.
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
    /// Initial guesses of the roots, from the speeds `guess` or from the speeds without friction, and at most
    /// the friction that stops a block.
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
        // Work that only few blocks need is done only if one of them needs it; it does not change the others.
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
        // Friction is at most the force that stops a block.
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

    /// Takes a step of Halley's method towards each root that is not final yet; returns whether there was
    /// any.
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
    // Written out: an array's `map` may be a call for each block.
    [0.5 * (rising - falling), 0.5 * (rising + falling)]
}

/// The product `x e^-step` for a step of at most [`LAST_STEP`].
#[inline(always)]
fn decayed(x: f64, step: f64) -> f64 {
    x - x * (step * (1.0 - step * (0.5 - step / 6.0)))
}
