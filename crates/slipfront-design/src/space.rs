//! The space of a search: patches that grow together, or numbers of the shapes of the base case.

use std::sync::Arc;

use slipfront_study::draws::Draws;

use crate::limits::{Illegal, Limits};
use crate::patch::{Form, PatchDraft};
use crate::ranges::{PatchRanges, is_angle};
use crate::shapes::Shapes;
use crate::slider_blocks::SliderBlocks;

/// A draft of a texture.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Draft {
    /// Patches that grow together.
    Patches(PatchDraft),
    /// Shares of the ranges of the unknowns of shapes.
    Shapes(Vec<f64>),
}

/// Numbers of patches of random drafts, in turn.
const PATCHES: [usize; 4] = [2, 3, 1, 4];

/// Largest number of draws until shapes are legal, for a random start.
const TRIES: usize = 50;

/// Standard deviation, as a share of the ranges of unknowns, below which drafts hardly differ.
const NARROW_SHARE: f64 = 1e-3;

/// Standard deviation in blocks below which drafts of patches hardly differ.
const NARROW_BLOCKS: f64 = 0.1;

/// The numbers that a search varies, and the textures that they define.
#[derive(Debug)]
pub(crate) enum Space {
    /// Patches within limits.
    Patches {
        grid: SliderBlocks,
        limits: Limits,
        ranges: PatchRanges,
        /// Number of drafts anywhere so far.
        n_anywhere: usize,
    },
    /// Numbers of shapes.
    Shapes {
        shapes: Arc<Shapes>,
        /// Number of drafts anywhere so far.
        n_anywhere: usize,
    },
}

impl Space {
    /// Patches within limits.
    pub(crate) fn patches(grid: SliderBlocks, limits: Limits) -> Self {
        Self::Patches {
            ranges: PatchRanges::new(&grid, &limits),
            grid,
            limits,
            n_anywhere: 0,
        }
    }

    /// Numbers of shapes.
    pub(crate) fn shapes(shapes: Arc<Shapes>) -> Self {
        Self::Shapes {
            shapes,
            n_anywhere: 0,
        }
    }

    /// The legal texture of a draft.
    ///
    /// # Errors
    /// A sentence with a limit that the draft breaks, or with the reason why a case refuses it.
    pub(crate) fn texture(&self, draft: &Draft) -> Result<Vec<bool>, String> {
        match (self, draft) {
            (Self::Patches { grid, limits, .. }, Draft::Patches(patches)) => limits
                .texture(grid, patches)
                .map_err(|illegal| illegal.to_string()),
            (Self::Shapes { shapes, .. }, Draft::Shapes(shares)) => shapes.texture(shares),
            _ => Err(Illegal::Nothing.to_string()),
        }
    }

    /// A draft for a start from a known one: a draft of patches has at least one; none if the known draft has
    /// no numbers to vary.
    pub(crate) fn near(&self, draft: &Draft, draws: &mut Draws) -> Option<Draft> {
        match (self, draft) {
            (Self::Patches { ranges, .. }, Draft::Patches(patches)) => {
                let mut patches = patches.clone();
                if patches.patches.is_empty() {
                    patches.patches.push(ranges.random_patch(Form::Rectangle, draws));
                }
                Some(Draft::Patches(patches))
            }
            (Self::Shapes { .. }, Draft::Shapes(shares)) if !shares.is_empty() => Some(draft.clone()),
            _ => None,
        }
    }

    /// A random draft. The first drafts of patches are strips with the largest coverage; later ones include
    /// cavities, and sometimes a smaller coverage. The first draft of shapes is the middle of all ranges.
    pub(crate) fn anywhere(&mut self, draws: &mut Draws) -> Draft {
        match self {
            Self::Patches {
                limits,
                ranges,
                n_anywhere,
                ..
            } => {
                let is_first = *n_anywhere == 0;
                let most = limits.max_features.unwrap_or(usize::MAX);
                // Limits without any feature allow no texture, but a draft still needs numbers.
                let n = PATCHES[*n_anywhere % PATCHES.len()].min(most).max(1);
                *n_anywhere += 1;
                let patches = (0..n).map(|_| {
                    let is_strip = is_first || draws.uniform() < 0.8;
                    let form = if is_strip { Form::Rectangle } else { Form::Ellipse };
                    ranges.random_patch(form, draws)
                });
                let patches = patches.collect();
                let [least, most] = limits.coverage;
                let is_full = is_first || draws.uniform() < 0.5;
                Draft::Patches(PatchDraft {
                    patches,
                    drawn: None,
                    percent: if is_full { most } else { draws.between(least, most) },
                })
            }
            Self::Shapes { shapes, n_anywhere } => {
                *n_anywhere += 1;
                let mut shares = shapes.middle();
                for _ in 0..TRIES {
                    if *n_anywhere > 1 {
                        shares.iter_mut().for_each(|share| *share = draws.uniform());
                    }
                    if *n_anywhere == 1 || shapes.texture(&shares).is_ok() {
                        break;
                    }
                }
                Draft::Shapes(shares)
            }
        }
    }

    /// Numbers of a draft, as shares of their ranges.
    pub(crate) fn numbers(&self, draft: &Draft) -> Vec<f64> {
        match (self, draft) {
            (Self::Patches { ranges, .. }, Draft::Patches(patches)) => ranges.numbers(patches),
            (_, Draft::Shapes(shares)) => shares.clone(),
            _ => Vec::new(),
        }
    }

    /// A draft like another, with these numbers; a number outside of its range is clamped to it.
    pub(crate) fn draft(&self, from: &Draft, numbers: &[f64]) -> Draft {
        match (self, from) {
            (Self::Patches { ranges, .. }, Draft::Patches(patches)) => {
                Draft::Patches(ranges.draft(patches, numbers))
            }
            _ => Draft::Shapes(numbers.iter().map(|share| share.clamp(0.0, 1.0)).collect()),
        }
    }

    /// Whether numbers are within their ranges. Angles of patches have no range, since they are periodic with
    /// half a turn.
    pub(crate) fn holds(&self, numbers: &[f64]) -> bool {
        let has_range = |k: usize| match self {
            Self::Patches { .. } => !is_angle(k),
            Self::Shapes { .. } => true,
        };
        let mut all = numbers.iter().enumerate();
        all.all(|(k, x)| !has_range(k) || (0.0..=1.0).contains(x))
    }

    /// Whether drafts with this standard deviation, as a share of their ranges, hardly differ.
    pub(crate) fn is_narrow(&self, deviation: f64) -> bool {
        match self {
            Self::Patches { ranges, .. } => deviation * ranges.side() < NARROW_BLOCKS,
            Self::Shapes { .. } => deviation < NARROW_SHARE,
        }
    }

    /// A draft of a texture that was drawn block by block.
    pub(crate) fn drawn(&self, textured: &[bool]) -> Draft {
        match self {
            Self::Patches { grid, .. } => Draft::Patches(PatchDraft::drawn(grid, textured)),
            // The numbers of such a texture are not known.
            Self::Shapes { .. } => Draft::Shapes(Vec::new()),
        }
    }
}
