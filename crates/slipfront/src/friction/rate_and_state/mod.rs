//! Friction that depends on speed and on the state of the contact.

mod slide;

use std::ops::Range;

use self::slide::{LARGE, Sliding, slide};
use super::needs::Needs;
use crate::elementary::{SMALL_DECAY, exp, ln, mean_decay, small_mean_decay};
use crate::forces::{Forces, part, part_mut, values_of, values_of_mut};
use crate::state::State;
use crate::surface::Surface;
use crate::vector_field::{VectorField, length};
use slipfront_kernel::Integrator;
use slipfront_kernel::fixed_point::RunningSum;

/// Rate-and-state friction with Dieterich's law for the state:
/// `mu = mu_0 + a ln(V/V_0) + b ln(V_0 theta/D_c)`, `dtheta/dt = 1 - V theta/D_c`; coefficients over `mu_s`.
/// The logarithm of the speed is regularised at V = 0:
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
    /// Slip over which the state adapts to a change of speed, in units of `P mu_s l^2/(E h)`.
    pub d_c: f64,
    /// Reference speed, in units of `P mu_s/sqrt(E rho)`.
    pub v_0: f64,
    /// Coefficient of steady sliding at the reference speed.
    pub mu_0: f64,
    /// State at the start, t*.
    pub theta_0: f64,
    /// Speed above which a block counts as sliding.
    pub slip_speed: f64,
}

/// `[c_0, c_1]` of the logarithm of the factor of V as a function of the state, `c_0 + c_1 ln(theta)`.
type LogFactors = [f64; 2];

/// The function `asinh(exp(y))`, without overflow.
fn asinh_of_exp(y: f64) -> f64 {
    if y > LARGE {
        y + std::f64::consts::LN_2
    } else {
        libm::asinh(libm::exp(y))
    }
}

impl RateAndState {
    /// Needs of rate and state: the state and the load of a block.
    pub(super) const NEEDS: Needs = Needs {
        is_fused: false,
        columns: 1,
        has_state: true,
        ..Needs::NONE
    };

    /// Part of [`log_factor`](Self::log_factor) that all blocks share.
    fn log_factors(&self) -> LogFactors {
        let at_one = (self.mu_0 + self.b * ln(self.v_0 / self.d_c)) / self.a - ln(2.0 * self.v_0);
        [at_one, self.b / self.a]
    }

    /// Logarithm of the factor of V in the regularised law, `(mu_0 + b ln(V_0 theta/D_c))/a - ln(2 V_0)`.
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

    /// Coefficient of steady sliding at a speed, where the state is `D_c/V`.
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

    /// Advances the states of some blocks by `dt` at constant speed: [`evolve`](Self::evolve) for several
    /// blocks at once.
    #[inline(always)]
    fn evolve_all<const BLOCKS: usize>(&self, theta: &mut [f64; BLOCKS], speed: &[f64; BLOCKS], dt: f64) {
        // Slip over a step is nearly always short, and then needs no exponential.
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

    /// Speeds after a step and friction of some blocks, with the speeds `free` without friction and `before`
    /// the step:
    ///
    /// ```text
    /// v + g F_n mu(v, theta) = free
    /// ```
    ///
    /// with the change of speed per force `g = dt/(m c+)`.
    #[inline(always)]
    fn slide<const BLOCKS: usize>(
        &self,
        factors: LogFactors,
        [free, before]: [&[f64; BLOCKS]; 2],
        theta: &[f64; BLOCKS],
        normal_force: &[f64; BLOCKS],
        g: &[f64; BLOCKS],
    ) -> Sliding<BLOCKS> {
        let mut log_factor = [0.0; BLOCKS];
        for k in 0..BLOCKS {
            log_factor[k] = Self::log_factor(factors, theta[k]);
        }
        slide(self.a, [free, before], &log_factor, normal_force, g)
    }

    /// Stiffness per block below which steady sliding of a block at `speed` under the normal force `sigma` is
    /// unstable (Rice and Ruina 1983, with inertia and damping), in units of `E h`, for blocks of mass `m` =
    /// 1:
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
        let fall = (self.b - self.a) * sigma - viscous;
        let inertia = speed * speed / ((sigma * self.a + viscous) * self.d_c);
        (fall / self.d_c * (1.0 + inertia)).max(0.0)
    }
}

/// Number of blocks computed together, so that the processor works on some while it waits for others.
const AT_ONCE: usize = 32;

/// The state of all contacts: the memory of the law.
#[derive(Debug)]
pub(crate) struct StateContact {
    law: RateAndState,
    log_factors: LogFactors,
    /// States `theta`, t*.
    pub(super) theta: Vec<f64>,
    /// Normal forces `F_n`; 0 over a texture.
    normal_force: Vec<f64>,
}

impl StateContact {
    pub(super) fn new(law: RateAndState, surface: &Surface) -> Self {
        let n = surface.n_blocks();
        Self {
            law,
            log_factors: law.log_factors(),
            theta: vec![law.theta_0; n],
            normal_force: (0..n).map(|b| surface.normal_force(b)).collect(),
        }
    }

    /// Advances the states of some blocks by a step, at the speeds in its middle.
    #[inline(always)]
    pub(super) fn evolve(&mut self, blocks: &Range<usize>, velocity: &VectorField, dt_star: f64) {
        for first in blocks.clone().step_by(AT_ONCE) {
            let blocks = first..blocks.end.min(first + AT_ONCE);
            let (n, [vx, vy]) = (blocks.len(), part(velocity, &blocks));
            let (mut speed, mut theta) = ([0.0; AT_ONCE], [1.0; AT_ONCE]);
            for k in 0..n {
                speed[k] = length([vx[k], vy[k]]);
            }
            let own = &mut self.theta[blocks];
            theta[..n].copy_from_slice(own);
            self.law.evolve_all(&mut theta, &speed, dt_star);
            own.copy_from_slice(&theta[..n]);
        }
    }

    /// Friction and the velocities half a step later of some blocks. A block counts as sliding above the slip
    /// speed.
    #[inline(always)]
    pub(super) fn apply(
        &self,
        blocks: &Range<usize>,
        state: &State,
        integrator: impl Fn(usize) -> Integrator,
        forces: &mut Forces,
    ) {
        for first in blocks.clone().step_by(AT_ONCE) {
            let end = blocks.end.min(first + AT_ONCE);
            self.apply_to(
                &(first..end),
                state,
                |k| integrator(first - blocks.start + k),
                forces,
            );
        }
    }

    /// Friction and the velocities half a step later of at most [`AT_ONCE`] blocks.
    #[inline(always)]
    fn apply_to(
        &self,
        blocks: &Range<usize>,
        state: &State,
        integrator: impl Fn(usize) -> Integrator,
        forces: &mut Forces,
    ) {
        let n = blocks.len();
        let (zeros, ones) = ([0.0; AT_ONCE], [1.0; AT_ONCE]);
        // Places without a block have the values of a block without friction.
        let (mut velocity, mut free, mut before) = ([zeros; 2], ones, ones);
        let (mut theta, mut normal_force, mut g) = (ones, zeros, zeros);
        let ([vx, vy], [dx, dy]) = (part(&state.velocity, blocks), part(&forces.drive, blocks));
        let [lx, ly] = part(&forces.lattice, blocks);
        theta[..n].copy_from_slice(&self.theta[blocks.clone()]);
        normal_force[..n].copy_from_slice(&self.normal_force[blocks.clone()]);
        for k in 0..n {
            let integrator = integrator(k);
            let moved = integrator.accelerate([vx[k], vy[k]], [dx[k] + lx[k], dy[k] + ly[k]]);
            [velocity[0][k], velocity[1][k]] = moved;
            (free[k], before[k]) = (length(moved), length([vx[k], vy[k]]));
            g[k] = integrator.force_to_velocity;
        }
        let Sliding { speed, friction } = {
            let speeds = [&free, &before];
            self.law
                .slide(self.log_factors, speeds, &theta, &normal_force, &g)
        };
        let ([fx, fy], [wx, wy]) = (
            part_mut(&mut forces.friction, blocks),
            part_mut(&mut forces.velocity, blocks),
        );
        let slides = values_of_mut(&mut forces.slides, blocks);
        for k in 0..n {
            let moves = free[k] >= f64::MIN_POSITIVE;
            let inverse = if moves { 1.0 / free[k] } else { 0.0 };
            let (x, y) = (inverse * velocity[0][k], inverse * velocity[1][k]);
            (fx[k], fy[k]) = (-friction[k] * x, -friction[k] * y);
            (wx[k], wy[k]) = (speed[k] * x, speed[k] * y);
            slides[k] = speed[k] > self.law.slip_speed;
        }
    }

    /// Adds the states of those of the given blocks that are in contact. The sums have room for the terms.
    #[inline(always)]
    pub(super) fn add_states(
        &self,
        surface: &Surface,
        blocks: &Range<usize>,
        sum: &mut RunningSum,
        states: &mut [f64],
    ) {
        let (theta, textured) = (
            values_of(&self.theta, blocks),
            values_of(&surface.textured, blocks),
        );
        let states = &mut states[..blocks.len()];
        for k in 0..blocks.len() {
            states[k] = if textured[k] { 0.0 } else { theta[k] };
        }
        sum.add(states);
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

    /// Speeds, speeds before, states and loads of blocks that creep, slide, begin to slide, stop, or have no
    /// load, and of places without a block.
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

    /// Speeds without friction that lead to these speeds.
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

    /// A young contact with a small direct effect and `e^-L` = 1e29: friction can only slow a block down.
    #[test]
    fn a_block_whose_friction_has_nearly_vanished_is_not_accelerated() {
        let law = RateAndState {
            a: 0.005,
            b: 0.091,
            d_c: 0.05,
            v_0: 0.01,
            mu_0: 0.0,
            ..LAW
        };
        let free = [6.4e-6];
        let found = law.slide(law.log_factors(), [&free, &[0.0]], &[0.1], &[1.0], &[G]);
        assert!(
            found.speed[0] <= free[0] && found.speed[0] > (1.0 - 1e-12) * free[0],
            "{found:?}"
        );
    }

    /// At the computed speed, friction follows the law, and friction and speed balance the free speed. A
    /// speed is as exact as `w`, which is some hundreds, and friction and free speed cancel where the law is
    /// steep.
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
                // Of two ways to compute the speed the more exact one counts.
                let of_exponentials = exp(-RateAndState::log_factor(law.log_factors(), theta));
                let of_difference = free[k] + G * load * a;
                let cancelled = 4.0 * f64::EPSILON * of_exponentials.min(of_difference);
                let left = speed + G * friction - free[k];
                assert!(left.abs() <= rounding + cancelled, "{a} {k}: {left:e}");
                if speed > 0.0 && load > 0.0 {
                    let of_law = load * law.coefficient(speed, theta);
                    assert!(
                        (friction - of_law).abs() <= 1e-14 * of_law + 1e-14 * load * a,
                        "{a} {k}: {friction} {of_law}"
                    );
                }
                let slope = if exact > 0.0 { G * load * a / exact } else { 0.0 };
                let bound = 1e-12 * exact + cancelled + rounding / (1.0 + slope);
                assert!((speed - exact).abs() <= bound, "{a} {k}: {speed:e} {exact:e}");
            }
        }
    }

    /// Bits of a block do not depend on the blocks next to it.
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
