//! Ranges of the numbers of patches.

use std::f64::consts::PI;

use crate::limits::Limits;
use crate::patch::{Form, Patch, PatchDraft};
use crate::slider_blocks::SliderBlocks;
use slipfront_study::draws::Draws;

/// Numbers of a patch: its centre along x and y, half length, half width and angle.
const OF_PATCH: usize = 5;

/// Ranges of the numbers of a draft. Each number is given as a share of its range.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchRanges {
    /// Blocks along x and y.
    size: [f64; 2],
    /// Largest half length and half width of a patch before it grows, in blocks: those of a strip across the
    /// slider with the largest allowed coverage.
    half: [f64; 2],
    /// Least and largest coverage, %.
    coverage: [f64; 2],
}

impl PatchRanges {
    /// Ranges within the limits of a design.
    pub(crate) fn new(grid: &SliderBlocks, limits: &Limits) -> Self {
        let size = grid.size().map(|n| n as f64);
        let width = 0.01 * limits.coverage[1] * size[0].min(size[1]);
        Self {
            size,
            half: [
                0.35 * (size[0] + size[1]),
                0.5 * width.max(limits.feature_blocks() as f64),
            ],
            coverage: limits.coverage,
        }
    }

    /// The longer side of the slider, in blocks: the largest of the ranges.
    pub(crate) fn side(&self) -> f64 {
        self.size[0].max(self.size[1])
    }

    /// A patch anywhere within the ranges.
    pub(crate) fn random_patch(&self, form: Form, draws: &mut Draws) -> Patch {
        self.patch(&[(); OF_PATCH].map(|()| draws.uniform()), form)
    }

    fn patch(&self, numbers: &[f64], form: Form) -> Patch {
        Patch {
            center: [self.size[0] * numbers[0], self.size[1] * numbers[1]],
            half: [self.half[0] * numbers[2], self.half[1] * numbers[3]],
            angle: PI * numbers[4],
            form,
        }
    }

    /// Numbers of a draft: those of its patches, and then its coverage unless that is fixed to the largest. A
    /// number outside of its range is clamped to it.
    pub(crate) fn numbers(&self, draft: &PatchDraft) -> Vec<f64> {
        let of_patch = |patch: &Patch| {
            let [x, y] = patch.center;
            let [half_length, half_width] = patch.half;
            let shares = [
                x / self.size[0],
                y / self.size[1],
                half_length / self.half[0],
                half_width / self.half[1],
            ];
            let [x, y, half_length, half_width] = shares.map(|share| share.clamp(0.0, 1.0));
            [x, y, half_length, half_width, patch.angle / PI]
        };
        let [least, most] = self.coverage;
        let covered = (least < most && draft.percent < most)
            .then(|| ((draft.percent - least) / (most - least)).clamp(0.0, 1.0));
        draft.patches.iter().flat_map(of_patch).chain(covered).collect()
    }

    /// A draft with the forms of another and with these numbers; a number outside of its range is clamped to
    /// it.
    pub(crate) fn draft(&self, from: &PatchDraft, numbers: &[f64]) -> PatchDraft {
        let held: Vec<f64> = numbers
            .iter()
            .enumerate()
            .map(|(k, &x)| if is_angle(k) { x } else { x.clamp(0.0, 1.0) })
            .collect();
        let patches = held.chunks_exact(OF_PATCH).zip(&from.patches);
        let [least, most] = self.coverage;
        PatchDraft {
            patches: patches
                .map(|(numbers, patch)| self.patch(numbers, patch.form))
                .collect(),
            drawn: from.drawn.clone(),
            percent: match held.chunks_exact(OF_PATCH).remainder() {
                [share] => least + (most - least) * share,
                _ => from.percent,
            },
        }
    }
}

/// Whether this number of a draft is an angle.
pub(crate) fn is_angle(index: usize) -> bool {
    index % OF_PATCH == OF_PATCH - 1
}
