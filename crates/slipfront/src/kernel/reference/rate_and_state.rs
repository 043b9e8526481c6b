//! Friction that follows speed and state.

use super::forces::Forces;
use crate::fixed_point;
use crate::friction::{Integrator, RateAndState};
use crate::kernel::totals::ContactTotals;
use crate::model::Model;
use crate::state::State;
use crate::vector_field::{VectorField, length};

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
        let n = model.lattice.n_blocks();
        Self {
            law,
            theta: vec![law.theta_0; n],
            normal_force: (0..n).map(|b| model.surface.normal_force(b)).collect(),
        }
    }

    /// Takes the states forward over a step, at the speeds in its middle.
    pub(super) fn evolve(&mut self, velocity: &VectorField, dt_star: f64) {
        for (b, theta) in self.theta.iter_mut().enumerate() {
            *theta = self.law.evolve(*theta, length(velocity.at(b)), dt_star);
        }
    }

    /// Friction and the velocities half a step later. A block counts as sliding above the slip speed.
    #[inline(always)]
    pub(super) fn apply(&self, model: &Model, state: &State, integrator: &Integrator, forces: &mut Forces) {
        let slider = &model.slider;
        for b in 0..self.theta.len() {
            let (drive, lattice) = (forces.drive.at(b), forces.lattice.at(b));
            let integrator = integrator.of_mass(slider.mass(b));
            let force = [0, 1].map(|axis| drive[axis] + lattice[axis]);
            let free = integrator.accelerate(state.velocity.at(b), force);
            let free_speed = length(free);
            let g = integrator.force_to_velocity;
            let (speed, friction) = self.law.slide(free_speed, self.theta[b], self.normal_force[b], g);
            let direction = free.map(|v| if free_speed > 0.0 { v / free_speed } else { 0.0 });
            [forces.friction.x[b], forces.friction.y[b]] = direction.map(|d| -friction * d);
            [forces.velocity.x[b], forces.velocity.y[b]] = direction.map(|d| speed * d);
            forces.slides[b] = speed > self.law.slip_speed;
        }
    }

    /// The mean state of the blocks in contact.
    #[inline(always)]
    pub(super) fn totals(&self, model: &Model) -> ContactTotals {
        let textured = &model.surface.textured;
        let sum = fixed_point::sum(
            self.theta.len(),
            |b| {
                if textured[b] { 0.0 } else { self.theta[b] }
            },
        );
        ContactTotals {
            mean_state: sum / model.surface.n_contact() as f64,
            ..ContactTotals::default()
        }
    }
}
