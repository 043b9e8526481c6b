//! A start of a search: drafts that are drawn around a mean, which moves towards the better ones.

use crate::space::{Draft, Space};
use slipfront_study::adaptive_search::Adaptation;
use slipfront_study::draws::Draws;

/// Number of drafts in a generation, after which the distribution adapts to their losses. With more drafts,
/// the direction of each step is more accurate, but there are fewer steps.
pub(crate) const GENERATION: usize = 8;

/// Number of generations without a decrease of the loss by [`PROGRESS`] after which a start ends.
const PATIENCE: usize = 25;

/// Least decrease of the loss that counts as progress.
const PROGRESS: f64 = 1e-4;

/// Largest number of draws until all numbers are within their ranges.
const TRIES: usize = 50;

/// A start of a search.
#[derive(Debug)]
pub(crate) struct Start {
    /// Number of the start.
    pub(crate) number: usize,
    /// Draft that provides everything except the numbers.
    from: Draft,
    adaptation: Adaptation,
    /// Losses since the last adaptation of the distribution, each with the standard normal numbers of the
    /// draft.
    losses: Vec<(f64, Vec<f64>)>,
    /// Number of generations since the last progress.
    idle: usize,
    /// Least loss at the last progress.
    reached: f64,
}

impl Start {
    /// A start around a draft, with this standard deviation of every number as a share of its range.
    pub(crate) fn new(number: usize, from: Draft, spread: f64, space: &Space) -> Self {
        Self {
            number,
            adaptation: Adaptation::new(space.numbers(&from), spread),
            from,
            losses: Vec::new(),
            idle: 0,
            reached: f64::INFINITY,
        }
    }

    /// Draws a draft, and returns it with its standard normal numbers. If numbers are out of their ranges,
    /// all are drawn again.
    pub(crate) fn draw(&self, space: &Space, draws: &mut Draws) -> (Draft, Vec<f64>) {
        let mut drawn = self.adaptation.draw(draws);
        for _ in 1..TRIES {
            if space.holds(&drawn.1) {
                break;
            }
            drawn = self.adaptation.draw(draws);
        }
        let (normal, numbers) = drawn;
        (space.draft(&self.from, &numbers), normal)
    }

    /// Takes the loss of a draft of this start.
    pub(crate) fn add_loss(&mut self, loss: f64, normal: &[f64]) {
        self.losses.push((loss, normal.to_vec()));
        // Adaptation compares drafts of one distribution, which therefore stays fixed until all losses of a
        // generation are known.
        if self.losses.len() < GENERATION {
            return;
        }
        let mut losses = std::mem::take(&mut self.losses);
        losses.sort_by(|a, b| a.0.total_cmp(&b.0));
        if losses[0].0 < self.reached - PROGRESS {
            (self.reached, self.idle) = (losses[0].0, 0);
        } else {
            self.idle += 1;
        }
        let normal: Vec<&[f64]> = losses.iter().map(|(_, normal)| normal.as_slice()).collect();
        self.adaptation.adapt(&normal);
    }

    /// Discards losses, because later ones are measured differently; the distribution is unchanged.
    pub(crate) fn forget_losses(&mut self) {
        self.losses.clear();
        (self.reached, self.idle) = (f64::INFINITY, 0);
    }

    /// Whether the start has converged or makes no more progress.
    pub(crate) fn has_ended(&self, space: &Space) -> bool {
        self.idle > PATIENCE || space.is_narrow(self.adaptation.step())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::Limits;
    use crate::patch::{Form, Patch, PatchDraft};
    use crate::ranges::PatchRanges;
    use crate::slider_blocks::tests::whole;

    /// The numbers of a draft give the same draft, and drafts that are drawn around it are within the limits.
    #[test]
    fn a_draft_comes_back_from_its_numbers() {
        let grid = whole([40, 20], [false; 2]);
        let limits = Limits {
            coverage: [2.0, 10.0],
            ..Limits::default()
        };
        let ranges = PatchRanges::new(&grid, &limits);
        let space = Space::patches(grid, limits);
        let mut draws = Draws::new(1);
        for percent in [10.0, 4.0] {
            let draft = PatchDraft {
                patches: [Form::Rectangle, Form::Ellipse]
                    .map(|form| ranges.random_patch(form, &mut draws))
                    .to_vec(),
                drawn: None,
                percent,
            };
            let numbers = ranges.numbers(&draft);
            assert_eq!(numbers.len(), if percent < 10.0 { 11 } else { 10 });
            assert!(space.holds(&numbers));
            let back = ranges.draft(&draft, &numbers);
            assert_eq!(ranges.numbers(&back), numbers);
            assert_eq!(back.percent, percent);
            let start = Start::new(1, Draft::Patches(draft), 0.5, &space);
            for _ in 0..100 {
                let drawn = patches(start.draw(&space, &mut draws).0);
                for Patch { center: [x, y], .. } in drawn.patches {
                    assert!((0.0..=40.0).contains(&x), "{x}");
                    assert!((0.0..=20.0).contains(&y), "{y}");
                }
                assert!((2.0..=10.0).contains(&drawn.percent));
            }
        }
    }

    fn patches(draft: Draft) -> PatchDraft {
        match draft {
            Draft::Patches(patches) => patches,
            Draft::Shapes(shares) => panic!("{shares:?}"),
        }
    }

    /// The loss is the distance of a patch from a given position. The last draft is within half a block of
    /// it, since a start ends when the standard deviation of drafts is a tenth of a block.
    #[test]
    fn drafts_become_better_until_the_start_ends() {
        let grid = whole([40, 40], [false; 2]);
        let ranges = PatchRanges::new(&grid, &Limits::default());
        let space = Space::patches(grid, Limits::default());
        let mut draws = Draws::new(2);
        let patch = ranges.random_patch(Form::Rectangle, &mut draws);
        let draft = PatchDraft {
            patches: vec![patch],
            drawn: None,
            percent: 100.0,
        };
        let mut start = Start::new(1, Draft::Patches(draft), 0.2, &space);
        let distance = |draft: Draft| {
            let [x, y] = patches(draft).patches[0].center;
            libm::hypot(x - 30.0, y - 7.0)
        };
        let mut asked = 0;
        let mut last = f64::INFINITY;
        while !start.has_ended(&space) {
            let (drawn, normal) = start.draw(&space, &mut draws);
            last = distance(drawn);
            start.add_loss(last, &normal);
            asked += 1;
            assert!(asked < 5000);
        }
        assert!(last < 0.5, "{last} blocks from the best after {asked} drafts");
    }
}
