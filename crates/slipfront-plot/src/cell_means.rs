//! Means over groups of blocks, used to draw large lattices.

/// Largest number of cells along a side; more blocks are averaged in groups.
const MAX_CELLS: usize = 256;

/// The mean of every cell of a lattice over its blocks that are not NaN. Values are summed as they arrive, so
/// the memory does not depend on the size of the lattice. A cell is a block, or a group of blocks along a
/// side with more than 256.
///
/// ```
/// let mut means = slipfront_plot::CellMeans::new(512, 1);
/// means.add((0..512).map(|block| block as f32));
/// assert_eq!(means.finish()[..3], [0.5, 2.5, 4.5]);
/// ```
#[derive(Clone, Debug)]
pub struct CellMeans {
    blocks: [usize; 2],
    /// The next block, along x and along y.
    next: [usize; 2],
    sums: Vec<f64>,
    counts: Vec<u32>,
}

impl CellMeans {
    /// Means without values yet, for a lattice with `nx` blocks along x and `ny` along y.
    pub fn new(nx: usize, ny: usize) -> Self {
        let [columns, rows] = Self::cells(nx, ny);
        Self {
            blocks: [nx, ny],
            // Rows without blocks count as complete from the beginning.
            next: [0, if nx == 0 { ny } else { 0 }],
            sums: vec![0.0; columns * rows],
            counts: vec![0; columns * rows],
        }
    }

    /// The means of a lattice from all its values at once.
    pub(crate) fn compute(nx: usize, ny: usize, values: impl Iterator<Item = f32>) -> Vec<f32> {
        let mut means = Self::new(nx, ny);
        means.add(values);
        means.finish()
    }

    /// Cells along x and along y.
    pub(crate) fn cells(nx: usize, ny: usize) -> [usize; 2] {
        [nx, ny].map(|blocks| blocks.min(MAX_CELLS))
    }

    /// Adds the values of the next blocks, row by row from y = 0; values beyond the last block are ignored.
    pub fn add(&mut self, values: impl Iterator<Item = f32>) {
        let ([nx, ny], [columns, rows]) = (self.blocks, Self::cells(self.blocks[0], self.blocks[1]));
        // The cell c of a side has the blocks from c * blocks / cells up to (c + 1) * blocks / cells.
        let cell_of = |block: usize, blocks: usize, cells: usize| ((block + 1) * cells - 1) / blocks;
        let [mut x, mut y] = self.next;
        let (mut cell, mut end) = (0, x);
        for value in values {
            if y == ny {
                break;
            }
            if x == end {
                let column = cell_of(x, nx, columns);
                (cell, end) = (
                    cell_of(y, ny, rows) * columns + column,
                    (column + 1) * nx / columns,
                );
            }
            if !value.is_nan() {
                self.sums[cell] += f64::from(value);
                self.counts[cell] += 1;
            }
            x += 1;
            if x == nx {
                (x, y, end) = (0, y + 1, 0);
            }
        }
        self.next = [x, y];
    }

    /// The means, row by row from y = 0; NaN for a cell without a value.
    pub fn finish(self) -> Vec<f32> {
        let cells = self.sums.iter().zip(&self.counts);
        cells
            .map(|(sum, count)| (sum / f64::from(*count)) as f32)
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_of_blocks_are_averaged_without_the_blank_ones() {
        // Groups of two by two blocks: one block of the first group is blank, all blocks of the second are.
        let [nx, ny] = [512, 512];
        let value = |block: usize| match (block % nx, block / nx) {
            (0, 0) => f32::NAN,
            (0 | 1, 0 | 1) => (block % nx + 10 * (block / nx)) as f32,
            (2 | 3, 0 | 1) => f32::NAN,
            _ => 0.25,
        };
        let means = CellMeans::compute(nx, ny, (0..nx * ny).map(value));
        // 1, 10 and 11.
        assert_eq!(means[0], 22.0f32 / 3.0);
        assert!(means[1].is_nan());
        assert!(means[2..].iter().all(|mean| *mean == 0.25));
        assert_eq!(means.len(), 256 * 256);
    }

    /// Every block counts once, in its own group, also along sides that are not a multiple of 256.
    #[test]
    fn groups_differ_by_a_block_at_most_and_miss_none() {
        for blocks in [1, 2, 255, 256, 257, 300, 511, 1000] {
            let cells = blocks.min(256);
            for [nx, ny] in [[blocks, 1], [1, blocks]] {
                let means = CellMeans::compute(nx, ny, (0..blocks).map(|block| block as f32));
                let of = |cell: usize| {
                    let group = cell * blocks / cells..(cell + 1) * blocks / cells;
                    let count = group.len();
                    (group.sum::<usize>() as f64 / count as f64) as f32
                };
                assert_eq!(means, (0..cells).map(of).collect::<Vec<f32>>(), "{nx} x {ny}");
            }
        }
    }

    #[test]
    fn pieces_of_any_length_give_the_same_means() {
        let values: Vec<f32> = (0..300 * 7).map(|block| (block % 97) as f32 / 7.0).collect();
        let whole = CellMeans::compute(300, 7, values.iter().copied());
        for length in [1, 3, 299, 300, 301, 1000] {
            let mut means = CellMeans::new(300, 7);
            values
                .chunks(length)
                .for_each(|piece| means.add(piece.iter().copied()));
            assert_eq!(means.finish(), whole, "{length}");
        }
    }
}
