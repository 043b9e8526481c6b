//! The blocks of a slider, and shares of sets of them.

use slipfront::Lattice;
use slipfront::lattice::Edges;
use slipfront_case::case::Case;

/// The blocks of a slider. Sets of them are row-major, the smallest y first.
#[derive(Clone, Debug, PartialEq)]
pub struct SliderBlocks {
    /// The blocks and their arrangement.
    pub lattice: Lattice,
    /// Marks of the blocks that exist: all, unless the slider has an outline.
    pub exists: Vec<bool>,
}

impl SliderBlocks {
    /// The blocks of the slider of a case.
    pub fn from_case(case: &Case) -> Self {
        let lattice = case.model.lattice;
        let slider = case.model.slider();
        Self {
            lattice,
            exists: (0..lattice.n_blocks()).map(|b| slider.exists(b)).collect(),
        }
    }

    /// Blocks along x and along y.
    pub fn size(&self) -> [usize; 2] {
        [self.lattice.nx, self.lattice.ny]
    }

    /// Whether the last block along an axis is the neighbour of the first.
    pub(crate) fn is_periodic(&self, axis: usize) -> bool {
        self.lattice.edges[axis] == Edges::Periodic
    }

    /// The block at an offset from another, each component -1, 0 or 1; none beyond a free edge.
    pub(crate) fn neighbour(&self, block: usize, offset: [isize; 2]) -> Option<usize> {
        let (i, j) = self.lattice.column_row(block);
        self.lattice.neighbour(i, j, offset)
    }

    /// Number of blocks that exist.
    pub fn n_blocks(&self) -> usize {
        count(&self.exists)
    }

    /// Size of a set as a share of the blocks that exist, %.
    pub fn percent(&self, set: &[bool]) -> f64 {
        100.0 * count(set) as f64 / self.n_blocks() as f64
    }

    /// The blocks that exist and are not in a set.
    pub fn others(&self, set: &[bool]) -> Vec<bool> {
        let pairs = self.exists.iter().zip(set);
        pairs.map(|(&exists, &is_in)| exists && !is_in).collect()
    }
}

/// Number of blocks in a set.
pub(crate) fn count(set: &[bool]) -> usize {
    set.iter().filter(|&&is_in| is_in).count()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A grid in which all blocks exist.
    pub(crate) fn whole([nx, ny]: [usize; 2], periodic: [bool; 2]) -> SliderBlocks {
        let edges = periodic.map(|is_periodic| if is_periodic { Edges::Periodic } else { Edges::Free });
        SliderBlocks {
            lattice: Lattice::with_edges(nx, ny, edges),
            exists: vec![true; nx * ny],
        }
    }

    /// A grid, and a set that is drawn with `#`, with the largest y first.
    pub(crate) fn drawn(rows: &[&str], periodic: [bool; 2]) -> (SliderBlocks, Vec<bool>) {
        let set: Vec<bool> = rows
            .iter()
            .rev()
            .flat_map(|row| row.bytes().map(|byte| byte == b'#'))
            .collect();
        (whole([rows[0].len(), rows.len()], periodic), set)
    }
}
