//! Springs between the blocks and the substrate.

use std::ops::Range;

use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};

use super::needs::Needs;
use crate::dead_load::DeadLoad;
use crate::forces::{Forces, part, part_mut, values_of, values_of_mut};
use crate::state::State;
use crate::surface::Surface;
use crate::vector_field::{VectorField, dot};
use slipfront_kernel::Integrator;
use slipfront_kernel::fixed_point::RunningSum;

/// Springs between every block in contact and the substrate: `F_f = -k_t (u - a)`, where the anchor `a` moves
/// when `k_t |u - a|` exceeds the static threshold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSprings {
    /// Stiffness `k_t` per block, in units of `E h`.
    pub stiffness: f64,
    /// Friction of a block after its spring has broken.
    pub after_break: AfterBreak,
}

/// Friction of a block after its spring to the substrate has broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AfterBreak {
    /// The spring forms again at once, without stress: the anchor becomes `u`.
    FormsAgain {
        /// Seed from which it draws another coefficient; none if every spring keeps its own.
        redraw: Option<u64>,
    },
    /// The block slides at its kinetic friction: the anchor follows it, so that `k_t |u - a| = mu_k F_n`,
    /// until the spring relaxes. Then the spring holds the block again, up to the static threshold (elastic
    /// and perfectly plastic, with a static peak).
    Slides,
}

impl ContactSprings {
    /// Needs of contact springs: the anchor of the spring of each block, and how often it has broken, or
    /// whether the block slides.
    pub(super) const NEEDS: Needs = Needs {
        is_fused: false,
        columns: 3,
        stores_energy: true,
        ..Needs::NONE
    };

    /// Ratio of the pulls, through drive springs of stiffness `k`, that load contact springs and rigid
    /// contacts equally.
    pub(super) fn pull_over_rigid(&self, k: f64) -> f64 {
        (k + self.stiffness) / self.stiffness
    }

    /// Whether a block slides at its kinetic friction after its spring has broken.
    pub fn slides(&self) -> bool {
        self.after_break == AfterBreak::Slides
    }

    /// Mean friction in steady sliding, from static and kinetic friction. Springs that form again are
    /// distributed uniformly over all extensions, so that the mean is half of static friction.
    pub(super) fn steady_force(&self, of_static: f64, of_kinetic: f64) -> f64 {
        match self.after_break {
            AfterBreak::FormsAgain { .. } => 0.5 * of_static,
            AfterBreak::Slides => of_kinetic,
        }
    }

    /// Force at which the spring of a block yields after `breaks`; `number` is the number of the block in the
    /// whole lattice. A spring that is drawn anew takes the coefficient of a random block in contact, chosen
    /// by the seed, the block and the number of breaks, so that the distribution of thresholds stays the
    /// same, whether drawn or given. A block that slides has its kinetic friction.
    fn threshold(&self, surface: &Surface, block: usize, number: usize, breaks: u64) -> f64 {
        match self.after_break {
            AfterBreak::Slides if breaks > 0 => surface.kinetic_force(block),
            AfterBreak::FormsAgain { redraw: Some(seed) } if breaks > 0 && !surface.textured[block] => {
                let mut key = [0; 32];
                for (word, bytes) in [seed, number as u64, breaks].iter().zip(key.chunks_exact_mut(8)) {
                    bytes.copy_from_slice(&word.to_le_bytes());
                }
                let mut random = ChaCha8Rng::from_seed(key);
                let n = surface.n_blocks() as u128;
                // The loop ends: at least this block is in contact.
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

/// Contact springs of all blocks. Anchors and numbers of breaks are the memory of the law.
#[derive(Debug)]
pub(crate) struct SpringContact {
    law: ContactSprings,
    /// Displacement at which a spring has no force.
    pub(super) anchor: VectorField,
    /// Number of times that the spring of each block has broken, if it forms again; otherwise 1 while the
    /// block slides, and 0 while its spring holds it.
    pub(super) breaks: Vec<f64>,
    /// Force to which a breaking spring falls: the kinetic friction of a block that slides, or 0.
    after_break: Vec<f64>,
    /// Number of the first block of the band in the whole lattice.
    first_block: usize,
}

impl SpringContact {
    /// Springs that hold the dead load with the blocks at their rest sites, `k_t a = -F_0`. `first_block`:
    /// number of the first block in the whole lattice.
    pub(super) fn new(
        law: ContactSprings,
        surface: &Surface,
        dead_load: &DeadLoad,
        first_block: usize,
    ) -> Self {
        let n_blocks = surface.n_blocks();
        let after_break = |b: usize| {
            if law.slides() {
                surface.kinetic_force(b)
            } else {
                0.0
            }
        };
        let mut anchor = VectorField::zeros(n_blocks);
        // Without a load the component is 0, not -0.
        if dead_load.acts() {
            for b in 0..n_blocks {
                let per_force = -dead_load.relative(b) / law.stiffness;
                [anchor.x[b], anchor.y[b]] = dead_load.force.map(|force| per_force * force);
            }
        }
        Self {
            law,
            anchor,
            breaks: vec![0.0; n_blocks],
            after_break: (0..n_blocks).map(after_break).collect(),
            first_block,
        }
    }

    /// Stiffness of the spring of a block: 0 over a texture.
    #[inline(always)]
    fn stiffness(&self, textured: bool) -> f64 {
        if textured { 0.0 } else { self.law.stiffness }
    }

    /// Whether a block slid in the step before.
    #[inline(always)]
    fn slid(&self, b: usize) -> bool {
        self.law.slides() && self.breaks[b] != 0.0
    }

    /// Moves the anchors of springs that break, or of blocks that slide, at the present instant, so that a
    /// force of [`after_break`](Self::after_break) is left, and finds the thresholds of the next step. Treats
    /// some of the blocks.
    #[inline(always)]
    pub(super) fn move_anchors(
        &mut self,
        surface: &Surface,
        blocks: &Range<usize>,
        displacement: &VectorField,
        slides: &[bool],
        threshold: &mut [f64],
    ) {
        let any_slides = slides[blocks.clone()]
            .iter()
            .fold(false, |any, slides| any | slides);
        let any_slid = self.law.slides()
            && self.breaks[blocks.clone()]
                .iter()
                .fold(false, |any, breaks| any | (*breaks != 0.0));
        // Usually no spring breaks and no block slides.
        if !(any_slides || any_slid) {
            return;
        }
        for b in blocks.clone() {
            if slides[b] {
                let [x, y] = displacement.at(b);
                let [ex, ey] = [x - self.anchor.x[b], y - self.anchor.y[b]];
                let left = self.after_break[b] / (self.law.stiffness * dot([ex, ey], [ex, ey]).sqrt());
                [self.anchor.x[b], self.anchor.y[b]] = [x - left * ex, y - left * ey];
                self.breaks[b] = if self.law.slides() {
                    1.0
                } else {
                    self.breaks[b] + 1.0
                };
            } else if self.slid(b) {
                self.breaks[b] = 0.0;
            } else {
                continue;
            }
            threshold[b] = self.threshold(surface, b);
        }
    }

    /// Threshold of the spring of block `b` after its breaks.
    fn threshold(&self, surface: &Surface, b: usize) -> f64 {
        let breaks = self.breaks[b] as u64;
        self.law.threshold(surface, b, self.first_block + b, breaks)
    }

    /// Finds the thresholds after the present numbers of breaks.
    pub(super) fn find_thresholds(&self, surface: &Surface, threshold: &mut [f64]) {
        for (b, threshold) in threshold.iter_mut().enumerate() {
            *threshold = self.threshold(surface, b);
        }
    }

    /// Forces of the springs of some blocks, and velocities half a step later. A block counts as sliding in
    /// the step in which its spring breaks, and while it slides. A breaking spring pulls with the mean of its
    /// forces before and after, which conserves energy to second order.
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
        let (threshold, textured) = (values_of(threshold, blocks), values_of(&surface.textured, blocks));
        let after_break = values_of(&self.after_break, blocks);
        let (slid, slid_before) = (self.law.slides(), values_of(&self.breaks, blocks));
        let ([fx, fy], [wx, wy]) = (
            part_mut(&mut forces.friction, blocks),
            part_mut(&mut forces.velocity, blocks),
        );
        let slides = values_of_mut(&mut forces.slides, blocks);
        for k in 0..n {
            let stiffness = self.stiffness(textured[k]);
            let pull = [stiffness * (ux[k] - ax[k]), stiffness * (uy[k] - ay[k])];
            let square = dot(pull, pull);
            // Kinetic friction above the static threshold also holds the block.
            let limit = threshold[k].max(after_break[k]);
            let yields = square > limit * limit;
            let after = after_break[k] / square.sqrt();
            let before = if slid & (slid_before[k] != 0.0) {
                after
            } else {
                1.0
            };
            let share = if yields { -0.5 * (before + after) } else { -1.0 };
            [fx[k], fy[k]] = [share * pull[0], share * pull[1]];
            let force = [dx[k] + lx[k] + fx[k], dy[k] + ly[k] + fy[k]];
            [wx[k], wy[k]] = integrator(k).accelerate([vx[k], vy[k]], force);
            slides[k] = yields;
        }
    }

    /// Adds energies of some blocks: of the springs that hold or slide, of the springs that break at the
    /// present instant, and the work against friction of sliding blocks since the instant before. The sums
    /// have room for two numbers of each block.
    #[inline(always)]
    pub(super) fn add_energies(
        &self,
        surface: &Surface,
        blocks: &Range<usize>,
        displacement: &VectorField,
        slides: &[bool],
        [held, broken, slid]: [&mut RunningSum; 3],
        [of_held, of_broken]: [&mut [f64]; 2],
    ) {
        let n = blocks.len();
        let ([ux, uy], [ax, ay]) = (part(displacement, blocks), part(&self.anchor, blocks));
        let (textured, slides) = (values_of(&surface.textured, blocks), values_of(slides, blocks));
        let (of_held, of_broken) = (&mut of_held[..n], &mut of_broken[..n]);
        let after_break = values_of(&self.after_break, blocks);
        let slid_before = values_of(&self.breaks, blocks);
        let half_compliance = 0.5 / self.law.stiffness;
        for k in 0..n {
            let extension = [ux[k] - ax[k], uy[k] - ay[k]];
            let energy = 0.5 * self.stiffness(textured[k]) * dot(extension, extension);
            let left = half_compliance * after_break[k] * after_break[k];
            of_held[k] = if slides[k] { left } else { energy };
            of_broken[k] = if slides[k] { energy - left } else { 0.0 };
        }
        held.add(of_held);
        if !self.law.slides() {
            broken.add(of_broken);
            return;
        }
        for k in 0..n {
            let extension = [ux[k] - ax[k], uy[k] - ay[k]];
            let slip = dot(extension, extension).sqrt() - after_break[k] / self.law.stiffness;
            let goes_on = slides[k] & (slid_before[k] != 0.0);
            of_held[k] = if goes_on { after_break[k] * slip } else { 0.0 };
            of_broken[k] = if goes_on { 0.0 } else { of_broken[k] };
        }
        broken.add(of_broken);
        slid.add(of_held);
    }
}
