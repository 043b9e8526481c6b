//! Limits on the textures of a design, and the conversion of a draft to a legal texture.

use slipfront::block_sets;
use slipfront_base::number_format::{are, count as count_of, four_digits};

use crate::patch::PatchDraft;
use crate::slider_blocks::{SliderBlocks, count};

/// Limits of a design, in blocks.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// Least and largest share of the blocks that are textured, %.
    pub coverage: [f64; 2],
    /// Smallest width of a feature: of a shape as it is drawn. A mask rounds it up to whole blocks: every
    /// textured block belongs to a textured square of this many blocks along a side.
    pub feature: f64,
    /// Smallest width of a gap: every block in contact belongs to a square of this many blocks in contact
    /// along a side.
    pub gap: usize,
    /// Whether the left half mirrors the right one, and the lower half the upper one.
    pub mirror: [bool; 2],
    /// Numbers of equal cells into which the slider is divided along x and along y, all with one texture.
    pub copies: [usize; 2],
    /// Blocks that must be in contact, if there are any.
    pub forbidden: Option<Vec<bool>>,
    /// Largest number of features.
    pub max_features: Option<usize>,
}

impl Default for Limits {
    /// Limits that every texture satisfies.
    fn default() -> Self {
        Self {
            coverage: [0.0, 100.0],
            feature: 1.0,
            gap: 1,
            mirror: [false; 2],
            copies: [1; 2],
            forbidden: None,
            max_features: None,
        }
    }
}

/// Rounding of widths, in blocks.
const ROUNDING: f64 = 1e-6;

/// Reason why a texture is not legal.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum Illegal {
    #[error("no part of the texture is as wide as a feature and leaves gaps as wide as they must be")]
    Nothing,
    #[error("the texture covers {found:.2} % of the slider; {least} to {most} % are allowed")]
    Coverage { found: f64, least: f64, most: f64 },
    #[error("a feature is {} wide; the minimum is {}", blocks(*found), four_digits(*least))]
    Feature { found: f64, least: f64 },
    #[error("a gap between features, or between a feature and an edge, is {} wide; the minimum is {least}", count_of(*found, "block"))]
    Gap { found: usize, least: usize },
    #[error("the texture is not symmetric about the middle of {axis}")]
    Mirror { axis: char },
    #[error("the {columns} x {rows} cells of the slider do not all have the same texture")]
    Copies { columns: usize, rows: usize },
    #[error("{} textured in an area where texture is forbidden", are(*blocks, "block"))]
    Forbidden { blocks: usize },
    #[error("the texture has {found} features; at most {most} are allowed")]
    Features { found: usize, most: usize },
}

/// A width in whole blocks, rounded up.
pub(crate) fn whole_blocks(width: f64) -> usize {
    // A length that equals a whole number of blocks up to rounding must not gain a block.
    (width - ROUNDING).ceil().max(1.0) as usize
}

/// A width in blocks, in words.
fn blocks(width: f64) -> String {
    format!(
        "{} block{}",
        four_digits(width),
        if width == 1.0 { "" } else { "s" }
    )
}

impl Limits {
    /// Smallest side of a square of blocks within a feature of a mask.
    pub(crate) fn feature_blocks(&self) -> usize {
        whole_blocks(self.feature)
    }

    /// Checks that a texture is legal. If its shapes are known, `drawn` is the smallest width of them in
    /// blocks, which their blocks do not show: a disc 6 blocks across contains no square of 5 blocks.
    ///
    /// # Errors
    /// The first limit that it breaks.
    pub fn check(&self, grid: &SliderBlocks, textured: &[bool], drawn: Option<f64>) -> Result<(), Illegal> {
        let [least, most] = self.coverage;
        let found = grid.percent(textured);
        if !(least..=most).contains(&found) {
            return Err(Illegal::Coverage { found, least, most });
        }
        // Few drafts have parts that are too narrow, so the width is determined only for those.
        let narrow = |set: &[bool], least| {
            if block_sets::opened(&grid.lattice, set, least) == set {
                None
            } else {
                block_sets::width(&grid.lattice, set)
            }
        };
        let narrow_feature = match drawn {
            Some(drawn) => Some(drawn).filter(|drawn| *drawn < self.feature - ROUNDING),
            None => narrow(textured, self.feature_blocks()).map(|width| width as f64),
        };
        if let Some(found) = narrow_feature {
            let least = self.feature;
            return Err(Illegal::Feature { found, least });
        }
        if let Some(found) = narrow(&grid.others(textured), self.gap) {
            let least = self.gap;
            return Err(Illegal::Gap { found, least });
        }
        for (axis, name) in ['x', 'y'].into_iter().enumerate() {
            let differs = |block| textured[block] != textured[mirrored(grid, block, axis)];
            if self.mirror[axis] && (0..textured.len()).any(differs) {
                return Err(Illegal::Mirror { axis: name });
            }
        }
        if (0..textured.len()).any(|block| textured[block] != textured[self.in_first_cell(grid, block)]) {
            let [columns, rows] = self.copies;
            return Err(Illegal::Copies { columns, rows });
        }
        let forbidden = self.forbidden.iter().flatten().zip(textured);
        let blocks = forbidden
            .filter(|(forbidden, textured)| **forbidden && **textured)
            .count();
        if blocks > 0 {
            return Err(Illegal::Forbidden { blocks });
        }
        if let Some(most) = self.max_features {
            let found = block_sets::n_pieces(&grid.lattice, textured);
            if found > most {
                return Err(Illegal::Features { found, most });
            }
        }
        Ok(())
    }

    /// The texture of a draft: the blocks inside its patches, after all patches have grown by the same
    /// distance to the largest legal texture within the coverage of the draft.
    ///
    /// # Errors
    /// A limit that it breaks.
    pub(crate) fn texture(&self, grid: &SliderBlocks, draft: &PatchDraft) -> Result<Vec<bool>, Illegal> {
        let growth = self.growth(grid, draft);
        let mut levels: Vec<f64> = growth.iter().copied().filter(|level| level.is_finite()).collect();
        levels.sort_unstable_by(f64::total_cmp);
        levels.dedup();
        let share = 0.01 * draft.percent.min(self.coverage[1]);
        let most = (share * grid.n_blocks() as f64 + 1e-9) as usize;
        let grown = |level: f64| {
            let held: Vec<bool> = growth.iter().map(|&growth| growth <= level).collect();
            self.smoothed(grid, &held)
        };
        // Bisection: the coverage increases with the growth.
        let (mut low, mut high) = (0, levels.len());
        let mut largest = None;
        while low < high {
            let middle = low + (high - low) / 2;
            let texture = grown(levels[middle]);
            if count(&texture) <= most {
                low = middle + 1;
                largest = Some(texture);
            } else {
                high = middle;
            }
        }
        let largest = largest.filter(|texture| texture.contains(&true));
        let texture = largest.ok_or(Illegal::Nothing)?;
        self.check(grid, &texture, None)?;
        Ok(texture)
    }

    /// Growth at which a draft contains each block, equal in all cells and mirrored halves; infinite where a
    /// block must be in contact.
    fn growth(&self, grid: &SliderBlocks, draft: &PatchDraft) -> Vec<f64> {
        let of_draft = draft.growth(grid);
        let mut growth = vec![f64::INFINITY; of_draft.len()];
        for (block, value) in of_draft.into_iter().enumerate() {
            let cell = self.in_first_cell(grid, block);
            growth[cell] = growth[cell].min(value);
        }
        for block in 0..growth.len() {
            growth[block] = growth[self.in_first_cell(grid, block)];
        }
        for axis in (0..2).filter(|&axis| self.mirror[axis]) {
            growth = (0..growth.len())
                .map(|block| growth[block].min(growth[mirrored(grid, block, axis)]))
                .collect();
        }
        let never_textured = self.never_textured(grid);
        for block in (0..growth.len()).filter(|&block| never_textured[block]) {
            growth[block] = f64::INFINITY;
        }
        growth
    }

    /// Blocks that no legal texture contains: those that do not exist, those that must be in contact, and all
    /// copies and mirror images of these.
    fn never_textured(&self, grid: &SliderBlocks) -> Vec<bool> {
        let n = grid.exists.len();
        let is_own = |block: usize| {
            !grid.exists[block] || self.forbidden.as_ref().is_some_and(|forbidden| forbidden[block])
        };
        let mut in_cell = vec![false; n];
        for block in (0..n).filter(|&block| is_own(block)) {
            in_cell[self.in_first_cell(grid, block)] = true;
        }
        let mut never_textured: Vec<bool> = (0..n)
            .map(|block| in_cell[self.in_first_cell(grid, block)])
            .collect();
        for axis in (0..2).filter(|&axis| self.mirror[axis]) {
            never_textured = (0..n)
                .map(|block| never_textured[block] || never_textured[mirrored(grid, block, axis)])
                .collect();
        }
        never_textured
    }

    /// A set after too narrow parts are removed and too narrow gaps are filled.
    fn smoothed(&self, grid: &SliderBlocks, set: &[bool]) -> Vec<bool> {
        let opened = block_sets::opened(&grid.lattice, set, self.feature_blocks());
        if self.gap <= 1 {
            return opened;
        }
        let contact = block_sets::opened(&grid.lattice, &grid.others(&opened), self.gap);
        let closed = grid.others(&contact);
        if closed == opened {
            return opened;
        }
        block_sets::opened(&grid.lattice, &closed, self.feature_blocks())
    }

    /// The block at the same place in the first cell.
    fn in_first_cell(&self, grid: &SliderBlocks, block: usize) -> usize {
        let [nx, ny] = grid.size();
        let [columns, rows] = self.copies;
        block / nx % (ny / rows) * nx + block % nx % (nx / columns)
    }
}

/// The mirror image of a block about the middle of an axis.
fn mirrored(grid: &SliderBlocks, block: usize, axis: usize) -> usize {
    let [nx, ny] = grid.size();
    let [x, y] = [block % nx, block / nx];
    if axis == 0 {
        y * nx + nx - 1 - x
    } else {
        (ny - 1 - y) * nx + x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::named_patterns::named;
    use crate::search::Search;
    use crate::slider_blocks::tests::{drawn, whole};
    use crate::space::Space;

    #[test]
    fn every_limit_is_told_by_what_breaks_it() {
        let rows = ["....", ".##.", ".##.", "...#"];
        let (grid, textured) = drawn(&rows, [false; 2]);
        let said = |limits: &Limits| limits.check(&grid, &textured, None);
        assert_eq!(said(&Limits::default()), Ok(()));
        let check = |change: &dyn Fn(&mut Limits)| {
            let mut changed = Limits::default();
            change(&mut changed);
            said(&changed).unwrap_err()
        };
        assert_eq!(
            check(&|limits| limits.coverage = [0.0, 30.0]),
            Illegal::Coverage {
                found: 31.25,
                least: 0.0,
                most: 30.0
            }
        );
        assert_eq!(
            check(&|limits| limits.feature = 2.0),
            Illegal::Feature {
                found: 1.0,
                least: 2.0
            }
        );
        assert_eq!(
            check(&|limits| limits.gap = 2),
            Illegal::Gap { found: 1, least: 2 }
        );
        assert_eq!(
            check(&|limits| limits.mirror = [true, false]),
            Illegal::Mirror { axis: 'x' }
        );
        assert_eq!(
            check(&|limits| limits.mirror = [false, true]),
            Illegal::Mirror { axis: 'y' }
        );
        let copies = check(&|limits| limits.copies = [2, 1]);
        assert_eq!(copies, Illegal::Copies { columns: 2, rows: 1 });
        let mut forbidden = vec![false; 16];
        forbidden[3] = true;
        let found = check(&|limits| limits.forbidden = Some(forbidden.clone()));
        assert_eq!(found, Illegal::Forbidden { blocks: 1 });
        let features = check(&|limits| limits.max_features = Some(1));
        assert_eq!(features, Illegal::Features { found: 2, most: 1 });
    }

    #[test]
    fn without_a_feature_nothing_is_asked_for() {
        let limits = Limits {
            max_features: Some(0),
            ..Limits::default()
        };
        let mut search = Search::new(
            Space::patches(whole([8, 8], [false; 2]), limits),
            1,
            1,
            Vec::new(),
        );
        assert!(search.ask(8, &|| false).is_empty());
    }

    /// Textures that a search proposes are legal and new, whatever the limits. The same losses lead to the
    /// same proposals.
    #[test]
    fn what_is_asked_for_is_legal_and_new() {
        let [nx, ny] = [24, 18];
        let mut corner = vec![false; nx * ny];
        corner[..6 * nx].fill(true);
        let side: Vec<bool> = (0..nx * ny).map(|block| block % nx < 4).collect();
        for (k, change) in [
            &(|_: &mut Limits| {}) as &dyn Fn(&mut Limits),
            &|limits| limits.feature = 4.0,
            &|limits| limits.mirror = [true, true],
            &|limits| limits.copies = [2, 3],
            &|limits| limits.forbidden = Some(corner.clone()),
            // Mirror images and copies of forbidden blocks are forbidden, too.
            &|limits| (limits.forbidden, limits.mirror) = (Some(corner.clone()), [false, true]),
            &|limits| (limits.forbidden, limits.copies) = (Some(side.clone()), [2, 1]),
            &|limits| limits.max_features = Some(1),
            &|limits| limits.coverage = [12.0, 30.0],
        ]
        .into_iter()
        .enumerate()
        {
            let mut limits = Limits {
                coverage: [0.0, 15.0],
                feature: 2.0,
                gap: 2,
                ..Limits::default()
            };
            change(&mut limits);
            let grid = whole([nx, ny], [k % 2 == 1, false]);
            let starts = || {
                named(&grid, &limits, &|| false)
                    .into_iter()
                    .map(|(named, _)| named)
                    .collect()
            };
            let mut twins =
                [0; 2].map(|_| Search::new(Space::patches(grid.clone(), limits.clone()), 2, 5, starts()));
            let mut seen = std::collections::HashSet::new();
            for _ in 0..4 {
                let [asked, again] = twins.each_mut().map(|search| search.ask(24, &|| false));
                assert!(!asked.is_empty(), "{limits:?}");
                for (one, other) in asked.iter().zip(&again) {
                    assert_eq!(one.texture, other.texture);
                    assert_eq!(limits.check(&grid, &one.texture, None), Ok(()), "{limits:?}");
                    assert!(seen.insert(one.texture.clone()));
                }
                // An arbitrary loss: the position of the texture along x.
                let rated: Vec<_> = asked
                    .into_iter()
                    .map(|proposal| {
                        let columns = (0..nx * ny).filter(|&block| proposal.texture[block]);
                        let loss = columns.map(|block| (block % nx) as f64).sum();
                        crate::search::RatedTexture { proposal, loss }
                    })
                    .collect();
                for search in &mut twins {
                    search.add_losses(&rated);
                }
            }
        }
    }
}
