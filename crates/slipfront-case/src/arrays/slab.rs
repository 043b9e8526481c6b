//! The rows of a file that are read.

use std::ops::Range;

/// The rows of a lattice of `nx` x `ny` blocks that are read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Slab {
    /// Blocks along x.
    pub nx: usize,
    /// Blocks along y of the whole lattice.
    pub ny: usize,
    /// The rows.
    pub rows: Range<usize>,
}

impl Slab {
    /// All rows.
    pub fn whole(nx: usize, ny: usize) -> Self {
        Self { nx, ny, rows: 0..ny }
    }

    /// Number of blocks in the rows.
    pub fn n_blocks(&self) -> usize {
        self.nx * self.rows.len()
    }
}
