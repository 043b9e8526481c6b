//! Which textures a design may have, and the texture of a draft: legal as it is made.

use super::grid::{Grid, count};
use super::patch::Draft;

/// Limits of a design, in blocks.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// Least and largest share of the blocks that are textured, %.
    pub coverage: [f64; 2],
    /// Smallest width of a feature: every textured block is one of a textured square of so many blocks along a side.
    pub feature: usize,
    /// Smallest width of what touches between features: every block in contact is one of a square of so many in contact.
    pub gap: usize,
    /// Whether the left half mirrors the right one, and the lower half the upper one.
    pub mirror: [bool; 2],
    /// Into how many equal cells the slider is divided along x and along y, all with one texture.
    pub copies: [usize; 2],
    /// Blocks that must touch, if there are any.
    pub forbidden: Option<Vec<bool>>,
    /// Largest number of features.
    pub max_features: Option<usize>,
}

/// Why a texture is not legal.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum Illegal {
    #[error("the texture covers {found:.2} % of the slider, where {least} to {most} % are allowed")]
    Coverage { found: f64, least: f64, most: f64 },
    #[error("a feature is {found} blocks wide, where {least} are the least")]
    Feature { found: usize, least: usize },
    #[error("a gap between features, or between one and an edge, is {found} blocks wide, where {least} are the least")]
    Gap { found: usize, least: usize },
    #[error("the texture is not the mirror image of itself about the middle of {axis}")]
    Mirror { axis: char },
    #[error("the {columns} x {rows} cells of the slider have not all one texture")]
    Copies { columns: usize, rows: usize },
    #[error("{blocks} textured blocks lie where the texture is forbidden")]
    Forbidden { blocks: usize },
    #[error("the texture has {found} features, where {most} are allowed")]
    Features { found: usize, most: usize },
}

impl Limits {
    /// Why a texture is not legal, unless it is.
    ///
    /// # Errors
    /// The first limit that it breaks.
    pub fn check(&self, grid: &Grid, textured: &[bool]) -> Result<(), Illegal> {
        let [least, most] = self.coverage;
        let found = grid.percent(textured);
        if !(least..=most).contains(&found) {
            return Err(Illegal::Coverage { found, least, most });
        }
        let narrow = |set: &[bool], least| grid.width(set).filter(|&found| found < least);
        if let Some(found) = narrow(textured, self.feature) {
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
        let blocks = forbidden.filter(|(forbidden, textured)| **forbidden && **textured).count();
        if blocks > 0 {
            return Err(Illegal::Forbidden { blocks });
        }
        if let Some(most) = self.max_features {
            let found = grid.n_pieces(textured);
            if found > most {
                return Err(Illegal::Features { found, most });
            }
        }
        Ok(())
    }

    /// The texture of a draft: what its patches hold when they have grown, all alike, to the largest legal texture that covers no more than
    /// the draft is to cover; none if there is none.
    pub(crate) fn texture(&self, grid: &Grid, draft: &Draft) -> Option<Vec<bool>> {
        let growth = self.growth(grid, draft);
        let mut levels: Vec<f64> = growth.iter().copied().filter(|level| level.is_finite()).collect();
        levels.sort_unstable_by(f64::total_cmp);
        levels.dedup();
        let share = 0.01 * draft.percent.min(self.coverage[1]);
        let most = (share * grid.n_blocks() as f64 + 1e-9) as usize;
        let grown = |level: f64| {
            let held: Vec<bool> = growth.iter().map(|&growth| growth <= level).collect();
            self.smoothed(grid, held)
        };
        // What is covered rises with the growth.
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
        largest.filter(|texture| texture.contains(&true) && self.check(grid, texture).is_ok())
    }

    /// By how much a draft must grow until it holds each block, in every cell and half alike; endless where it must not.
    fn growth(&self, grid: &Grid, draft: &Draft) -> Vec<f64> {
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
        let is_barred = |block: usize| {
            !grid.exists[block] || self.forbidden.as_ref().is_some_and(|forbidden| forbidden[block])
        };
        for block in (0..growth.len()).filter(|&block| is_barred(block)) {
            growth[block] = f64::INFINITY;
        }
        growth
    }

    /// A set without what is too narrow, and without gaps that are.
    fn smoothed(&self, grid: &Grid, set: Vec<bool>) -> Vec<bool> {
        let opened = grid.opened(&set, self.feature);
        if self.gap <= 1 {
            return opened;
        }
        let contact = grid.opened(&grid.others(&opened), self.gap);
        let closed = grid.others(&contact);
        if closed == opened {
            return opened;
        }
        grid.opened(&closed, self.feature)
    }

    /// The block at this place of the first cell.
    fn in_first_cell(&self, grid: &Grid, block: usize) -> usize {
        let [nx, ny] = grid.size;
        let [columns, rows] = self.copies;
        block / nx % (ny / rows) * nx + block % nx % (nx / columns)
    }
}

/// The mirror image of a block about the middle of an axis.
fn mirrored(grid: &Grid, block: usize, axis: usize) -> usize {
    let [nx, ny] = grid.size;
    let [x, y] = [block % nx, block / nx];
    if axis == 0 {
        y * nx + nx - 1 - x
    } else {
        (ny - 1 - y) * nx + x
    }
}
