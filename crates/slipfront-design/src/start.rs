//! A start of a search: drafts drawn around a mean that moves towards the better ones.

use std::f64::consts::PI;

use crate::limits::Limits;
use crate::patch::{Draft, Form, Patch};
use crate::slider_blocks::SliderBlocks;
use slipfront_study::adaptation::Adaptation;
use slipfront_study::draws::Draws;

/// Number of drafts whose losses adapt the distribution of the next ones. More would tell the better
/// directions more exactly, in fewer steps.
pub(crate) const GENERATION: usize = 8;

/// Generations without a loss that is lower by [`PROGRESS`] after which a start ends.
const PATIENCE: usize = 25;

/// Loss by which drafts must become better.
const PROGRESS: f64 = 1e-4;

/// Deviation in blocks below which drafts hardly differ.
const NARROW: f64 = 0.1;

/// Number of times that numbers are drawn until all lie within their ranges.
const TRIES: usize = 50;

/// Numbers of a patch: its centre along x and y, half length, half width and angle.
const OF_PATCH: usize = 5;

/// A start of a search.
#[derive(Debug)]
pub(crate) struct Start {
    /// Number of the start.
    pub(crate) number: usize,
    /// Draft whose numbers change.
    from: Draft,
    ranges: Ranges,
    adaptation: Adaptation,
    /// Losses since the distribution was adapted, each with the standard normal numbers that made the draft.
    told: Vec<(f64, Vec<f64>)>,
    /// Generations since drafts have become better.
    idle: usize,
    /// Least loss when drafts last became better.
    reached: f64,
}

impl Start {
    /// Drafts around one, of which every number deviates by this share of its range.
    pub(crate) fn new(number: usize, from: Draft, spread: f64, ranges: Ranges) -> Self {
        Self {
            number,
            adaptation: Adaptation::new(ranges.numbers(&from), spread),
            from,
            ranges,
            told: Vec::new(),
            idle: 0,
            reached: f64::INFINITY,
        }
    }

    /// A draft, and the standard normal numbers that made it. Numbers that leave their ranges are drawn anew.
    pub(crate) fn draw(&self, draws: &mut Draws) -> (Draft, Vec<f64>) {
        let mut drawn = self.adaptation.draw(draws);
        for _ in 1..TRIES {
            if Ranges::hold(&drawn.1) {
                break;
            }
            drawn = self.adaptation.draw(draws);
        }
        let (normal, numbers) = drawn;
        (self.ranges.draft(&self.from, &numbers), normal)
    }

    /// Takes the loss of a draft of this start.
    pub(crate) fn tell(&mut self, loss: f64, normal: &[f64]) {
        self.told.push((loss, normal.to_vec()));
        // Adaptation compares drafts of one distribution, so that it stays until all of a generation are
        // told.
        if self.told.len() < GENERATION {
            return;
        }
        let mut told = std::mem::take(&mut self.told);
        told.sort_by(|a, b| a.0.total_cmp(&b.0));
        if told[0].0 < self.reached - PROGRESS {
            (self.reached, self.idle) = (told[0].0, 0);
        } else {
            self.idle += 1;
        }
        let normal: Vec<&[f64]> = told.iter().map(|(_, normal)| normal.as_slice()).collect();
        self.adaptation.adapt(&normal);
    }

    /// Forgets losses, because later ones are measured otherwise; the distribution stays as it is.
    pub(crate) fn forget_losses(&mut self) {
        self.told.clear();
        (self.reached, self.idle) = (f64::INFINITY, 0);
    }

    /// Whether there is little more to find.
    pub(crate) fn has_ended(&self) -> bool {
        // Steps are shares of ranges, of which that of the longer side is the largest in blocks.
        let side = self.ranges.size[0].max(self.ranges.size[1]);
        self.idle > PATIENCE || self.adaptation.step() * side < NARROW
    }
}

/// Ranges of the numbers of a draft, each of which is told as a share of its range.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ranges {
    /// Blocks along x and y.
    size: [f64; 2],
    /// Largest half length and half width of a patch before it grows, in blocks: those of a strip across the
    /// slider that covers all it may.
    half: [f64; 2],
    /// Least and largest coverage, %.
    coverage: [f64; 2],
}

impl Ranges {
    /// Ranges within the limits of a design.
    pub(crate) fn new(grid: &SliderBlocks, limits: &Limits) -> Self {
        let size = grid.size().map(|n| n as f64);
        let width = 0.01 * limits.coverage[1] * size[0].min(size[1]);
        Self {
            size,
            half: [0.35 * (size[0] + size[1]), 0.5 * width.max(limits.feature as f64)],
            coverage: limits.coverage,
        }
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

    /// Numbers of a draft: those of its patches, then of its coverage unless it is the most. What lies
    /// outside of its range counts as the nearest end.
    fn numbers(&self, draft: &Draft) -> Vec<f64> {
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

    /// A draft with the forms of another, and with other numbers; those outside of their ranges count as the
    /// nearest end.
    fn draft(&self, from: &Draft, numbers: &[f64]) -> Draft {
        let held: Vec<f64> = numbers
            .iter()
            .enumerate()
            .map(|(k, &x)| if is_angle(k) { x } else { x.clamp(0.0, 1.0) })
            .collect();
        let patches = held.chunks_exact(OF_PATCH).zip(&from.patches);
        let [least, most] = self.coverage;
        Draft {
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

    /// Whether numbers lie within their ranges. Angles have none: an angle and half a turn more are one.
    fn hold(numbers: &[f64]) -> bool {
        let mut all = numbers.iter().enumerate();
        all.all(|(k, x)| is_angle(k) || (0.0..=1.0).contains(x))
    }
}

/// Whether this number of a draft is an angle.
fn is_angle(index: usize) -> bool {
    index % OF_PATCH == OF_PATCH - 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slider_blocks::tests::whole;

    /// A draft is that of its own numbers, and what is drawn from it lies within the limits.
    #[test]
    fn a_draft_comes_back_from_its_numbers() {
        let grid = whole([40, 20], [false; 2]);
        let limits = Limits {
            coverage: [2.0, 10.0],
            ..Limits::default()
        };
        let ranges = Ranges::new(&grid, &limits);
        let mut draws = Draws::new(1);
        for percent in [10.0, 4.0] {
            let draft = Draft {
                patches: [Form::Rectangle, Form::Ellipse]
                    .map(|form| ranges.random_patch(form, &mut draws))
                    .to_vec(),
                drawn: None,
                percent,
            };
            let numbers = ranges.numbers(&draft);
            assert_eq!(numbers.len(), if percent < 10.0 { 11 } else { 10 });
            assert!(Ranges::hold(&numbers));
            let back = ranges.draft(&draft, &numbers);
            assert_eq!(ranges.numbers(&back), numbers);
            assert_eq!(back.percent, percent);
            let start = Start::new(1, draft, 0.5, ranges);
            for _ in 0..100 {
                let (drawn, _) = start.draw(&mut draws);
                for Patch { center: [x, y], .. } in drawn.patches {
                    assert!((0.0..=40.0).contains(&x), "{x}");
                    assert!((0.0..=20.0).contains(&y), "{y}");
                }
                assert!((2.0..=10.0).contains(&drawn.percent));
            }
        }
    }

    /// The loss is the distance of a patch from a place. The last draft lies within half a block of it, since
    /// a start ends when drafts deviate by a tenth of a block.
    #[test]
    fn drafts_become_better_until_the_start_ends() {
        let grid = whole([40, 40], [false; 2]);
        let ranges = Ranges::new(&grid, &Limits::default());
        let mut draws = Draws::new(2);
        let patch = ranges.random_patch(Form::Rectangle, &mut draws);
        let draft = Draft {
            patches: vec![patch],
            drawn: None,
            percent: 100.0,
        };
        let mut start = Start::new(1, draft, 0.2, ranges);
        let distance = |draft: &Draft| {
            let [x, y] = draft.patches[0].center;
            libm::hypot(x - 30.0, y - 7.0)
        };
        let mut asked = 0;
        let mut last = f64::INFINITY;
        while !start.has_ended() {
            let (drawn, normal) = start.draw(&mut draws);
            last = distance(&drawn);
            start.tell(last, &normal);
            asked += 1;
            assert!(asked < 5000);
        }
        assert!(last < 0.5, "{last} blocks from the best after {asked} drafts");
    }
}
