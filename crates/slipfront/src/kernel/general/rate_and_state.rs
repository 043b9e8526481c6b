//! Friction that follows speed and state.

use std::ops::Range;

use super::forces::{Forces, part, part_mut};
use super::weighted::Scratch;
use crate::fixed_point::RunningSum;
use crate::friction::{Integrator, LogFactors, RateAndState, Sliding};
use crate::model::Model;
use crate::state::State;
use crate::vector_field::{VectorField, length};

/// Blocks whose speeds are found together, so that the processor works on some while it waits for others.
const AT_ONCE: usize = 32;

/// The state of all contacts, which is the memory of the law.
#[derive(Debug)]
pub(super) struct StateContact {
    law: RateAndState,
    log_factors: LogFactors,
    /// `theta`, t*.
    pub(super) theta: Vec<f64>,
    /// `F_n`; 0 over a texture.
    normal_force: Vec<f64>,
}

impl StateContact {
    pub(super) fn new(law: RateAndState, model: &Model) -> Self {
        let n = model.surface.n_blocks();
        Self {
            law,
            log_factors: law.log_factors(),
            theta: vec![law.theta_0; n],
            normal_force: (0..n).map(|b| model.surface.normal_force(b)).collect(),
        }
    }

    /// Takes the states of some blocks forward over a step, at the speeds in its middle.
    #[inline(always)]
    pub(super) fn evolve(&mut self, blocks: &Range<usize>, velocity: &VectorField, dt_star: f64) {
        for first in blocks.clone().step_by(AT_ONCE) {
            let blocks = first..blocks.end.min(first + AT_ONCE);
            let (n, [vx, vy]) = (blocks.len(), part(velocity, &blocks));
            let (vx, vy) = (&vx[..n], &vy[..n]);
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

    /// Friction and the velocities half a step later of some blocks. A block counts as sliding above the slip speed.
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

    /// The same for at most [`AT_ONCE`] blocks.
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
        // Where there is no block the values are those of one that nothing holds.
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
        let (fx, fy, wx, wy) = (&mut fx[..n], &mut fy[..n], &mut wx[..n], &mut wy[..n]);
        let slides = &mut forces.slides[blocks.clone()][..n];
        for k in 0..n {
            let moves = free[k] >= f64::MIN_POSITIVE;
            let inverse = if moves { 1.0 / free[k] } else { 0.0 };
            let (x, y) = (inverse * velocity[0][k], inverse * velocity[1][k]);
            (fx[k], fy[k]) = (-friction[k] * x, -friction[k] * y);
            (wx[k], wy[k]) = (speed[k] * x, speed[k] * y);
            slides[k] = speed[k] > self.law.slip_speed;
        }
    }

    /// Adds the states of those of some blocks that are in contact.
    #[inline(always)]
    pub(super) fn add_states(
        &self,
        model: &Model,
        blocks: &Range<usize>,
        sum: &mut RunningSum,
        scratch: &mut Scratch,
    ) {
        let (n, theta) = (blocks.len(), &self.theta[blocks.clone()]);
        let (theta, textured) = (&theta[..n], &model.surface.textured[blocks.clone()][..n]);
        let states = &mut scratch.terms[..n];
        for k in 0..n {
            states[k] = if textured[k] { 0.0 } else { theta[k] };
        }
        sum.add(states);
    }
}
