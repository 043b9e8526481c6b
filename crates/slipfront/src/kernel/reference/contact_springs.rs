//! Springs between the blocks and the substrate.

use super::forces::{Forces, components};
use crate::communicator::Communicator;
use crate::fixed_point::sum_over;
use crate::friction::{ContactSprings, Integrator};
use crate::kernel::totals::ContactTotals;
use crate::model::Model;
use crate::state::State;
use crate::surface::Surface;
use crate::vector_field::{VectorField, dot};

/// The springs of all blocks. Anchors and numbers of breaks are the memory of the law.
#[derive(Debug)]
pub(super) struct SpringContact {
    law: ContactSprings,
    /// Displacement at which a spring has no force.
    pub(super) anchor: VectorField,
    /// How often it has broken: a whole number.
    pub(super) breaks: Vec<f64>,
    /// Number of the first block of this rank in the whole lattice.
    first_block: usize,
}

impl SpringContact {
    pub(super) fn new(law: ContactSprings, model: &Model) -> Self {
        let n_blocks = model.surface.n_blocks();
        Self {
            law,
            anchor: VectorField::zeros(n_blocks),
            breaks: vec![0.0; n_blocks],
            first_block: model.lattice.blocks_of(&model.rows).start,
        }
    }

    /// Stiffness of the spring of a block: none over a texture.
    #[inline(always)]
    fn stiffness(&self, textured: bool) -> f64 {
        if textured { 0.0 } else { self.law.stiffness }
    }

    /// Lets the springs that break at the present instant form again where their blocks are now.
    pub(super) fn form_again(
        &mut self,
        model: &Model,
        displacement: &VectorField,
        breaks: &[bool],
        threshold: &mut [f64],
    ) {
        for b in (0..breaks.len()).filter(|&b| breaks[b]) {
            [self.anchor.x[b], self.anchor.y[b]] = displacement.at(b);
            self.breaks[b] += 1.0;
            threshold[b] = self.threshold(&model.surface, b);
        }
    }

    /// Threshold of the spring of a block after its breaks.
    fn threshold(&self, surface: &Surface, b: usize) -> f64 {
        let breaks = self.breaks[b] as u64;
        self.law.threshold(surface, b, self.first_block + b, breaks)
    }

    /// Finds the thresholds that belong to the numbers of breaks.
    pub(super) fn find_thresholds(&self, model: &Model, threshold: &mut [f64]) {
        for (b, threshold) in threshold.iter_mut().enumerate() {
            *threshold = self.threshold(&model.surface, b);
        }
    }

    /// Forces of the springs and velocities half a step later; a block counts as sliding in the step in which its spring breaks. Such
    /// a spring pulls for the half of the step that lies before the break, which keeps the balance of energy to second order.
    #[inline(always)]
    pub(super) fn apply(
        &self,
        model: &Model,
        state: &State,
        threshold: &[f64],
        integrator: &Integrator,
        forces: &mut Forces,
    ) {
        let n = threshold.len();
        let ([ux, uy], [ax, ay]) = (components(&state.displacement, n), components(&self.anchor, n));
        let ([vx, vy], textured) = (components(&state.velocity, n), &model.surface.textured[..n]);
        let ([dx, dy], [lx, ly]) = (components(&forces.drive, n), components(&forces.lattice, n));
        let (friction, after) = (&mut forces.friction, &mut forces.velocity);
        let [fx, fy] = [&mut friction.x[..n], &mut friction.y[..n]];
        let [wx, wy] = [&mut after.x[..n], &mut after.y[..n]];
        let slides = &mut forces.slides[..n];
        for b in 0..n {
            let stiffness = self.stiffness(textured[b]);
            let pull = [stiffness * (ux[b] - ax[b]), stiffness * (uy[b] - ay[b])];
            let breaks = dot(pull, pull) > threshold[b] * threshold[b];
            let share = if breaks { -0.5 } else { -1.0 };
            [fx[b], fy[b]] = [share * pull[0], share * pull[1]];
            let force = [dx[b] + lx[b] + fx[b], dy[b] + ly[b] + fy[b]];
            let integrator = integrator.of_mass(model.slider.mass(b));
            [wx[b], wy[b]] = integrator.accelerate([vx[b], vy[b]], force);
            slides[b] = breaks;
        }
    }

    #[inline(always)]
    fn extension(&self, displacement: &VectorField, b: usize) -> [f64; 2] {
        let ([ux, uy], [ax, ay]) = (displacement.at(b), self.anchor.at(b));
        [ux - ax, uy - ay]
    }

    /// Energies of the springs that hold and of those that break at the present instant.
    #[inline(always)]
    pub(super) fn totals(
        &self,
        ranks: &dyn Communicator,
        model: &Model,
        displacement: &VectorField,
        breaks: &[bool],
    ) -> ContactTotals {
        let sum = |broken: bool| {
            let energy = |b: usize| {
                let extension = self.extension(displacement, b);
                let energy = 0.5 * self.stiffness(model.surface.textured[b]) * dot(extension, extension);
                if breaks[b] == broken { energy } else { 0.0 }
            };
            sum_over(ranks, breaks.len(), energy)
        };
        ContactTotals {
            spring_energy: sum(false),
            broken_energy: sum(true),
            mean_state: 0.0,
        }
    }
}
