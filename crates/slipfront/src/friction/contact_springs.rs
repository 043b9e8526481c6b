//! Springs between the blocks and the substrate.

use std::ops::Range;

use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};

use super::integrator::Integrator;
use super::needs::Needs;
use crate::fixed_point::RunningSum;
use crate::forces::{Forces, part, part_mut};
use crate::state::State;
use crate::surface::Surface;
use crate::vector_field::{VectorField, dot};

/// Springs between every block in contact and the substrate. A spring breaks at its static threshold and
/// forms again without stress: `F_f = -k_t (u - a)`, where the anchor `a` becomes `u` when `k_t |u - a|`
/// exceeds the threshold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSprings {
    /// Stiffness `k_t` per block, in units of `E h`.
    pub stiffness: f64,
    /// Seed by which a spring that forms again takes another coefficient; none if every spring keeps its own.
    pub redraw: Option<u64>,
}

impl ContactSprings {
    /// Needs of springs in contact: the anchor of the spring of a block, and how often it has broken.
    pub(super) const NEEDS: Needs = Needs {
        is_fused: false,
        columns: 3,
        stores_energy: true,
        ..Needs::NONE
    };

    /// Pull of a drive through springs of stiffness `k` that loads springs in contact as far as rigid
    /// contacts are loaded by a pull of 1.
    pub(super) fn pull_over_rigid(&self, k: f64) -> f64 {
        (k + self.stiffness) / self.stiffness
    }

    /// Static threshold of the spring of a block that has broken `breaks` times; `number` is the number of
    /// the block in the whole lattice. A spring that is drawn anew has the coefficient of a block in contact
    /// that seed, block and number of breaks choose at random, so that thresholds keep their distribution,
    /// drawn or given.
    fn threshold(&self, surface: &Surface, block: usize, number: usize, breaks: u64) -> f64 {
        match self.redraw {
            Some(seed) if breaks > 0 && !surface.textured[block] => {
                let mut key = [0; 32];
                for (word, bytes) in [seed, number as u64, breaks].iter().zip(key.chunks_exact_mut(8)) {
                    bytes.copy_from_slice(&word.to_le_bytes());
                }
                let mut random = ChaCha8Rng::from_seed(key);
                let n = surface.n_blocks() as u128;
                // A block in contact there is at least: this one.
                let mut choose = || ((u128::from(random.next_u64()) * n) >> 64) as usize;
                let mut other = choose();
                while surface.textured[other] {
                    other = choose();
                }
                surface.static_limit_with(surface.mu_static[other], block)
            }
            _ => surface.static_limit(block),
        }
    }
}

/// The springs of all blocks. Anchors and numbers of breaks are the memory of the law.
#[derive(Debug)]
pub(crate) struct SpringContact {
    law: ContactSprings,
    /// Displacement at which a spring has no force.
    pub(super) anchor: VectorField,
    /// Number of times that the spring of each block has broken; whole numbers.
    pub(super) breaks: Vec<f64>,
    /// Number of the first block of the band in the whole lattice.
    first_block: usize,
}

impl SpringContact {
    /// Springs without stress. `first_block`: number of the first block in the whole lattice.
    pub(super) fn new(law: ContactSprings, n_blocks: usize, first_block: usize) -> Self {
        Self {
            law,
            anchor: VectorField::zeros(n_blocks),
            breaks: vec![0.0; n_blocks],
            first_block,
        }
    }

    /// Stiffness of the spring of a block: none over a texture.
    #[inline(always)]
    fn stiffness(&self, textured: bool) -> f64 {
        if textured { 0.0 } else { self.law.stiffness }
    }

    /// Lets those springs of some blocks that break at the present instant form again where their blocks are
    /// now.
    #[inline(always)]
    pub(super) fn form_again(
        &mut self,
        surface: &Surface,
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
            threshold[b] = self.threshold(surface, b);
        }
    }

    /// Threshold of the spring of block `b` after its breaks.
    fn threshold(&self, surface: &Surface, b: usize) -> f64 {
        let breaks = self.breaks[b] as u64;
        self.law.threshold(surface, b, self.first_block + b, breaks)
    }

    /// Finds the thresholds that belong to the numbers of breaks.
    pub(super) fn find_thresholds(&self, surface: &Surface, threshold: &mut [f64]) {
        for (b, threshold) in threshold.iter_mut().enumerate() {
            *threshold = self.threshold(surface, b);
        }
    }

    /// Forces of the springs of some blocks and velocities half a step later; a block counts as sliding in
    /// the step in which its spring breaks. Such a spring pulls for the half of the step that lies before the
    /// break, which keeps the balance of energy to second order.
    #[inline(always)]
    pub(super) fn apply(
        &self,
        surface: &Surface,
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
            &surface.textured[blocks.clone()][..n],
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

    /// Adds the energies of the springs of some blocks: of the springs that hold, and of those that break at
    /// the present instant. The sums have room for both.
    #[inline(always)]
    pub(super) fn add_energies(
        &self,
        surface: &Surface,
        blocks: &Range<usize>,
        displacement: &VectorField,
        breaks: &[bool],
        [held, broken]: [&mut RunningSum; 2],
        [of_held, of_broken]: [&mut [f64]; 2],
    ) {
        let n = blocks.len();
        let ([ux, uy], [ax, ay]) = (part(displacement, blocks), part(&self.anchor, blocks));
        let (ux, uy, ax, ay) = (&ux[..n], &uy[..n], &ax[..n], &ay[..n]);
        let (textured, breaks) = (
            &surface.textured[blocks.clone()][..n],
            &breaks[blocks.clone()][..n],
        );
        let (of_held, of_broken) = (&mut of_held[..n], &mut of_broken[..n]);
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
