//! Friction that follows speed and state.

use std::ops::Range;

use super::forces::{Forces, components};
use crate::communicator::Communicator;
use crate::fixed_point::sum_over;
use crate::friction::{Integrator, RateAndState, Sliding};
use crate::kernel::totals::ContactTotals;
use crate::model::Model;
use crate::state::State;
use crate::vector_field::{VectorField, length};

/// Blocks whose speeds are found together, so that the processor works on some while it waits for others.
const AT_ONCE: usize = 32;

/// The state of all contacts, which is the memory of the law.
#[derive(Debug)]
pub(super) struct StateContact {
    law: RateAndState,
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
            theta: vec![law.theta_0; n],
            normal_force: (0..n).map(|b| model.surface.normal_force(b)).collect(),
        }
    }

    /// Takes the states forward over a step, at the speeds in its middle.
    #[inline(always)]
    pub(super) fn evolve(&mut self, velocity: &VectorField, dt_star: f64) {
        let n = self.theta.len();
        let [vx, vy] = components(velocity, n);
        for b in 0..n {
            self.theta[b] = self.law.evolve(self.theta[b], length([vx[b], vy[b]]), dt_star);
        }
    }

    /// Friction and the velocities half a step later. A block counts as sliding above the slip speed.
    #[inline(always)]
    pub(super) fn apply(&self, model: &Model, state: &State, integrator: &Integrator, forces: &mut Forces) {
        for first in (0..self.theta.len()).step_by(AT_ONCE) {
            let len = AT_ONCE.min(self.theta.len() - first);
            self.apply_to(first..first + len, model, state, integrator, forces);
        }
    }

    /// The same for at most [`AT_ONCE`] blocks.
    #[inline(always)]
    fn apply_to(
        &self,
        blocks: Range<usize>,
        model: &Model,
        state: &State,
        integrator: &Integrator,
        forces: &mut Forces,
    ) {
        let zeros = [0.0; AT_ONCE];
        let (mut velocity, mut free) = ([zeros; 2], zeros);
        // Where there is no block the values are those of one that is not moved.
        let (mut theta, mut normal_force, mut g) = ([1.0; AT_ONCE], zeros, zeros);
        for (k, b) in blocks.clone().enumerate() {
            let integrator = integrator.of_mass(model.slider.mass(b));
            let (drive, lattice) = (forces.drive.at(b), forces.lattice.at(b));
            let force = [drive[0] + lattice[0], drive[1] + lattice[1]];
            let moved = integrator.accelerate(state.velocity.at(b), force);
            [velocity[0][k], velocity[1][k]] = moved;
            free[k] = length(moved);
            (theta[k], normal_force[k], g[k]) =
                (self.theta[b], self.normal_force[b], integrator.force_to_velocity);
        }
        let Sliding { speed, friction } = self.law.slide(&free, &theta, &normal_force, &g);
        for (k, b) in blocks.enumerate() {
            let direction = [0, 1].map(|axis| {
                if free[k] > 0.0 {
                    velocity[axis][k] / free[k]
                } else {
                    0.0
                }
            });
            [forces.friction.x[b], forces.friction.y[b]] = direction.map(|d| -friction[k] * d);
            [forces.velocity.x[b], forces.velocity.y[b]] = direction.map(|d| speed[k] * d);
            forces.slides[b] = speed[k] > self.law.slip_speed;
        }
    }

    /// The mean state of the blocks in contact.
    #[inline(always)]
    pub(super) fn totals(&self, ranks: &dyn Communicator, model: &Model) -> ContactTotals {
        let textured = &model.surface.textured;
        let sum = sum_over(ranks, self.theta.len(), |b| {
            if textured[b] { 0.0 } else { self.theta[b] }
        });
        ContactTotals {
            mean_state: sum / model.surface.n_contact() as f64,
            ..ContactTotals::default()
        }
    }
}
