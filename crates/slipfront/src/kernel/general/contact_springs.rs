//! Springs between the blocks and the substrate.

use std::ops::Range;

use super::forces::{Forces, part, part_mut};
use super::weighted::Scratch;
use crate::fixed_point::RunningSum;
use crate::friction::{ContactSprings, Integrator};
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

    /// Lets those springs of some blocks that break at the present instant form again where their blocks are now.
    #[inline(always)]
    pub(super) fn form_again(
        &mut self,
        model: &Model,
        blocks: &Range<usize>,
        displacement: &VectorField,
        breaks: &[bool],
        threshold: &mut [f64],
    ) {
        // Most parts have none.
        if !breaks[blocks.clone()]
            .iter()
            .fold(false, |any, breaks| any | breaks)
        {
            return;
        }
        for b in blocks.clone().filter(|&b| breaks[b]) {
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

    /// Forces of the springs of some blocks and velocities half a step later; a block counts as sliding in the step in which its spring
    /// breaks. Such a spring pulls for the half of the step that lies before the break, which keeps the balance of energy to second
    /// order.
    #[inline(always)]
    pub(super) fn apply(
        &self,
        model: &Model,
        blocks: &Range<usize>,
        state: &State,
        threshold: &[f64],
        integrator: impl Fn(usize) -> Integrator,
        forces: &mut Forces,
    ) {
        let n = blocks.len();
        let ([ux, uy], [ax, ay]) = (part(&state.displacement, blocks), part(&self.anchor, blocks));
        let ([vx, vy], [dx, dy]) = (part(&state.velocity, blocks), part(&forces.drive, blocks));
        let [lx, ly] = part(&forces.lattice, blocks);
        let (ux, uy, ax, ay, vx, vy) = (&ux[..n], &uy[..n], &ax[..n], &ay[..n], &vx[..n], &vy[..n]);
        let (dx, dy, lx, ly) = (&dx[..n], &dy[..n], &lx[..n], &ly[..n]);
        let (threshold, textured) = (
            &threshold[blocks.clone()][..n],
            &model.surface.textured[blocks.clone()][..n],
        );
        let ([fx, fy], [wx, wy]) = (
            part_mut(&mut forces.friction, blocks),
            part_mut(&mut forces.velocity, blocks),
        );
        let (fx, fy, wx, wy) = (&mut fx[..n], &mut fy[..n], &mut wx[..n], &mut wy[..n]);
        let slides = &mut forces.slides[blocks.clone()][..n];
        for k in 0..n {
            let stiffness = self.stiffness(textured[k]);
            let pull = [stiffness * (ux[k] - ax[k]), stiffness * (uy[k] - ay[k])];
            let breaks = dot(pull, pull) > threshold[k] * threshold[k];
            let share = if breaks { -0.5 } else { -1.0 };
            [fx[k], fy[k]] = [share * pull[0], share * pull[1]];
            let force = [dx[k] + lx[k] + fx[k], dy[k] + ly[k] + fy[k]];
            [wx[k], wy[k]] = integrator(k).accelerate([vx[k], vy[k]], force);
            slides[k] = breaks;
        }
    }

    /// Adds the energies of those springs of some blocks that hold, and of those that break at the present instant.
    #[inline(always)]
    pub(super) fn add_energies(
        &self,
        model: &Model,
        blocks: &Range<usize>,
        displacement: &VectorField,
        breaks: &[bool],
        [held, broken]: [&mut RunningSum; 2],
        scratch: &mut Scratch,
    ) {
        let n = blocks.len();
        let ([ux, uy], [ax, ay]) = (part(displacement, blocks), part(&self.anchor, blocks));
        let (ux, uy, ax, ay) = (&ux[..n], &uy[..n], &ax[..n], &ay[..n]);
        let (textured, breaks) = (
            &model.surface.textured[blocks.clone()][..n],
            &breaks[blocks.clone()][..n],
        );
        let (of_held, of_broken) = (&mut scratch.terms[..n], &mut scratch.products[..n]);
        for k in 0..n {
            let extension = [ux[k] - ax[k], uy[k] - ay[k]];
            let energy = 0.5 * self.stiffness(textured[k]) * dot(extension, extension);
            of_held[k] = if breaks[k] { 0.0 } else { energy };
            of_broken[k] = if breaks[k] { energy } else { 0.0 };
        }
        held.add(of_held);
        broken.add(of_broken);
    }
}
