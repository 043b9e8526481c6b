//! Positions of the blocks of the lattice in the arrays of the fused kernel.
//!
//! Rows follow one another in one array of elements, so that the neighbours of element e are always e + 1,
//! e + stride and e + stride +- 1 in every row. Vectors of eight elements may contain the end of a row.
//! Springs that do not exist at a free edge are masked. Along a periodic x axis every row has a ghost at
//! either end, a copy of the block at its other end. Elements that are no blocks never move, because their
//! threshold is infinite, and are excluded from all sums.

use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

use super::vector::LANES;
use crate::lattice::{Edges, Lattice};

/// Number of elements in a tile, which is scheduled as a whole.
pub const TILE: usize = 256;

/// Number of vectors in a tile: one bit each in a `u32`.
pub const VECTORS: usize = TILE / LANES;

/// Least number of elements in a row: a vector must not contain two blocks that a spring to the next row
/// joins.
const MIN_ROW_ELEMENTS: usize = 16;

/// Positions of the blocks of some rows of a lattice.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    lattice: Lattice,
    /// The first row of the lattice that is stored here.
    first_row: usize,
    /// Number of rows that are stored here.
    pub rows: usize,
    /// Number of elements from one row to the next.
    pub stride: usize,
    /// Ghosts before the first block of a row.
    ghosts: usize,
}

impl Layout {
    /// The layout of the given rows of a lattice.
    pub fn new(lattice: &Lattice, rows: &Range<usize>) -> Self {
        let ghosts = usize::from(lattice.edges[0] == Edges::Periodic);
        Self {
            lattice: *lattice,
            first_row: rows.start,
            rows: rows.len(),
            stride: (lattice.nx + 2 * ghosts).max(MIN_ROW_ELEMENTS),
            ghosts,
        }
    }

    /// Number of elements, up to the end of the last row.
    pub fn n_elements(&self) -> usize {
        self.rows * self.stride
    }

    /// Number of blocks of these rows.
    pub fn n_own_blocks(&self) -> usize {
        self.rows * self.lattice.nx
    }

    /// Number of tiles. The last is shorter; only its last vector is filled up with elements that are no
    /// blocks.
    pub fn n_tiles(&self) -> usize {
        self.n_elements().div_ceil(TILE)
    }

    /// Element of block (i, j).
    pub fn element(&self, i: usize, j: usize) -> usize {
        j * self.stride + self.ghosts + i
    }

    /// Element of the block with index `b` in the lattice.
    pub fn element_of(&self, b: usize) -> usize {
        let (i, j) = self.lattice.column_row(b);
        self.element(i, j)
    }

    /// Column of an element; none for an element that is no block.
    fn column(&self, element: usize) -> Option<usize> {
        let i = (element % self.stride).checked_sub(self.ghosts)?;
        (i < self.lattice.nx).then_some(i)
    }

    /// Index in the lattice of the block at an element, if there is one.
    pub fn block(&self, element: usize) -> Option<usize> {
        let j = element / self.stride;
        let i = self.column(element)?;
        (j < self.rows).then(|| self.lattice.block(i, j))
    }

    /// Row of the lattice that is stored as row `j`.
    pub fn lattice_row(&self, j: usize) -> usize {
        self.first_row + j
    }

    /// The ghosts of row `j`, each with the element that it copies.
    pub fn ghosts_of_row(&self, j: usize) -> [(usize, usize); 2] {
        let (first, last) = (self.element(0, j), self.element(self.lattice.nx - 1, j));
        [(first - 1, last), (last + 1, first)]
    }

    /// The blocks among these elements, row by row: the row, the column of the first block, and the elements
    /// of the blocks.
    pub fn rows_among(
        &self,
        elements: Range<usize>,
    ) -> impl Iterator<Item = (usize, usize, Range<usize>)> + use<> {
        let layout = *self;
        let rows = elements.start / self.stride..elements.end.div_ceil(self.stride).min(self.rows);
        rows.filter_map(move |j| {
            let first = layout.element(0, j);
            let (from, to) = (
                elements.start.max(first),
                elements.end.min(first + layout.lattice.nx),
            );
            (from < to).then(|| (j, from - first, from - elements.start..to - elements.start))
        })
    }

    /// Whether rows have ghosts at their ends.
    pub fn has_ghosts(&self) -> bool {
        self.ghosts > 0
    }

    fn is_periodic_along_y(&self) -> bool {
        self.lattice.edges[1] == Edges::Periodic
    }

    /// Whether other ranks hold neighbouring rows below the first and above the last of the stored rows.
    pub fn has_neighbours(&self) -> [bool; 2] {
        if self.rows == self.lattice.ny {
            return [false; 2];
        }
        let end = self.first_row + self.rows;
        [self.first_row > 0, end < self.lattice.ny].map(|inside| inside || self.is_periodic_along_y())
    }

    /// Whether the last and the first of the stored rows are neighbours.
    pub fn wraps_along_y(&self) -> bool {
        self.is_periodic_along_y() && self.rows == self.lattice.ny
    }

    /// Row and column of an element, ghosts included; the row counts from the first stored row, the column
    /// from the first ghost.
    pub fn row_column(&self, element: isize) -> (isize, usize) {
        let stride = self.stride as isize;
        (element.div_euclid(stride), element.rem_euclid(stride) as usize)
    }

    /// Column and row of the lattice of the block `lanes` elements after a place of
    /// [`row_column`](Self::row_column), which is in the same row or the next.
    pub fn place_after(&self, row: usize, column: usize, lanes: usize) -> (usize, usize) {
        let column = column + lanes;
        match column.checked_sub(self.stride) {
            None => (column - self.ghosts, self.lattice_row(row)),
            Some(column) => (column - self.ghosts, self.lattice_row(row + 1)),
        }
    }

    /// Column and row of the lattice of the block at an element, or of the block that a ghost copies; none
    /// beyond a free edge or between the rows. The element may lie before the first or after the last row.
    pub fn place(&self, element: isize) -> Option<[usize; 2]> {
        let (nx, ny) = (self.lattice.nx, self.lattice.ny as isize);
        let (row, column) = self.row_column(element);
        let mut j = row + self.first_row as isize;
        if self.is_periodic_along_y() {
            j = j.rem_euclid(ny);
        }
        let is_stored = (0..ny).contains(&j) && column < nx + 2 * self.ghosts;
        is_stored.then(|| [(column + nx - self.ghosts) % nx, j as usize])
    }

    /// Whether the lattice has the springs of an element to the east, north, north-east and north-west. The
    /// element may lie before the first or after the last row.
    pub fn springs(&self, element: isize) -> [bool; 4] {
        let ghosts = self.ghosts as isize;
        let (nx, ny) = (self.lattice.nx as isize, self.lattice.ny as isize);
        let (row, column) = self.row_column(element);
        let (row, i) = (row + self.first_row as isize, column as isize - ghosts);
        let east = (-ghosts..nx + ghosts - 1).contains(&i);
        let west = (1 - ghosts..nx + ghosts).contains(&i);
        let north = self.is_periodic_along_y() || (0..ny - 1).contains(&row);
        // Elements between the rows have no springs.
        let is_stored = (-ghosts..nx + ghosts).contains(&i);
        [east, north && is_stored, north && east, north && west]
    }

    /// Pieces of the elements from `from` to `to`, each with its first element. Elements before the first row
    /// or after the last are left out, or taken from the other end if the axis is periodic.
    pub fn pieces(&self, from: isize, to: isize) -> impl Iterator<Item = (isize, Range<usize>)> + use<> {
        let (n, wraps) = (self.n_elements() as isize, self.wraps_along_y());
        let mut first = from;
        std::iter::from_fn(move || {
            loop {
                if first > to {
                    return None;
                }
                let wrapped = first.rem_euclid(n);
                let end = (first - wrapped + n).min(to + 1);
                let piece = wrapped as usize..(wrapped + end - first) as usize;
                let start = std::mem::replace(&mut first, end);
                if wrapped == start || wraps {
                    return Some((start, piece));
                }
            }
        })
    }

    /// Marks the vectors that contain the elements from `first` to `last` or neighbours of these: see
    /// `mark_vectors`. The elements may lie outside the rows.
    pub fn mark_around(&self, first: isize, last: isize, masks: &[AtomicU32]) {
        let (n, stride) = (self.n_elements() as isize, self.stride as isize);
        for row in [-stride, 0, stride] {
            let (from, to) = (first + row - 1, last + row + 1);
            if from >= 0 && to < n {
                mark_vectors(masks, from as usize..to as usize + 1);
            } else {
                self.pieces(from, to)
                    .for_each(|(_, piece)| mark_vectors(masks, piece));
            }
        }
    }
}

/// Sets the bits of the vectors that contain the elements of a piece: one mask per tile, one bit per vector.
fn mark_vectors(masks: &[AtomicU32], piece: Range<usize>) {
    // Several threads set bits. Most bits are set already, and reading is cheaper than writing.
    let set = |tile: usize, bits: u32| {
        if masks[tile].load(Ordering::Relaxed) & bits != bits {
            masks[tile].fetch_or(bits, Ordering::Relaxed);
        }
    };
    let (first, last) = (piece.start / LANES, (piece.end - 1) / LANES);
    let (mut tile, mut from) = (first / VECTORS, first % VECTORS);
    while tile < last / VECTORS {
        set(tile, u32::MAX << from);
        (tile, from) = (tile + 1, 0);
    }
    set(
        tile,
        (u32::MAX << from) & (u32::MAX >> (VECTORS - 1 - last % VECTORS)),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vectors around the elements of a vector, and around the ghosts of its blocks.
    fn vectors_around(layout: &Layout, vector: usize) -> Vec<u32> {
        let masks: Vec<AtomicU32> = (0..layout.n_tiles()).map(|_| AtomicU32::new(0)).collect();
        let (first, last) = (vector * LANES, vector * LANES + LANES - 1);
        let mark = |first: usize, last: usize| {
            layout.mark_around(first as isize, last as isize, &masks);
        };
        mark(first, last);
        if layout.has_ghosts() {
            let copies = (0..layout.rows).flat_map(|j| layout.ghosts_of_row(j));
            copies
                .filter(|(_, copied)| (first..=last).contains(copied))
                .for_each(|(ghost, _)| mark(ghost, ghost));
        }
        masks.into_iter().map(AtomicU32::into_inner).collect()
    }

    /// Compares the vectors with the neighbours in the lattice.
    #[test]
    fn neighbouring_vectors_hold_all_neighbouring_blocks() {
        use Edges::{Free, Periodic};
        for edges in [
            [Free, Free],
            [Periodic, Free],
            [Free, Periodic],
            [Periodic, Periodic],
        ] {
            for (nx, ny) in [(5, 7), (25, 40), (50, 50), (300, 5), (700, 4), (3, 400), (254, 5)] {
                let lattice = Lattice::with_edges(nx, ny, edges);
                let layout = Layout::new(&lattice, &(0..lattice.ny));
                for vector in 0..layout.n_elements().div_ceil(LANES) {
                    let masks = vectors_around(&layout, vector);
                    let is_marked =
                        |element: usize| masks[element / TILE] >> (element % TILE / LANES) & 1 == 1;
                    for element in vector * LANES..((vector + 1) * LANES).min(layout.n_elements()) {
                        assert!(is_marked(element));
                        let Some(b) = layout.block(element) else { continue };
                        let (i, j) = lattice.column_row(b);
                        for (di, dj) in [
                            (-1, -1),
                            (0, -1),
                            (1, -1),
                            (-1, 0),
                            (1, 0),
                            (-1, 1),
                            (0, 1),
                            (1, 1),
                        ] {
                            if let Some(other) = lattice.neighbour(i, j, [di, dj]) {
                                let other = layout.element_of(other);
                                assert!(is_marked(other), "{nx}x{ny} {edges:?} {vector} {other}");
                            }
                        }
                    }
                    let marked: u32 = masks.iter().map(|mask| mask.count_ones()).sum();
                    // Three rows of at most three vectors, twice for ghosts, and vectors split at a periodic
                    // edge.
                    assert!(
                        marked <= 24,
                        "{marked} vectors around {vector} of {nx}x{ny} {edges:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn blocks_and_elements_are_each_others_inverse() {
        let lattice = Lattice::with_edges(5, 4, [Edges::Periodic, Edges::Free]);
        let layout = Layout::new(&lattice, &(0..lattice.ny));
        for b in 0..lattice.n_blocks() {
            assert_eq!(layout.block(layout.element_of(b)), Some(b));
        }
        assert_eq!(
            (0..layout.n_elements())
                .filter(|&e| layout.block(e).is_some())
                .count(),
            20
        );
        for j in 0..4 {
            for (ghost, copied) in layout.ghosts_of_row(j) {
                assert!(layout.block(ghost).is_none() && layout.block(copied).is_some());
            }
        }
    }
}
