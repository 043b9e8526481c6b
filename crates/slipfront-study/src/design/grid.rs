//! Sets of blocks, and their widths: openings by squares, on a slider with edges.

use slipfront::Lattice;
use slipfront::lattice::Edges;
use slipfront_case::case::Case;

/// The blocks of a slider. Sets of them are row-major, the smallest y first.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// The blocks and their arrangement.
    pub lattice: Lattice,
    /// Marks of the blocks that exist: all, unless the slider has an outline.
    pub exists: Vec<bool>,
}

impl Grid {
    /// The blocks of the slider of a case.
    pub fn of(case: &Case) -> Self {
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

    /// Share of a set in the blocks that exist, %.
    pub fn percent(&self, set: &[bool]) -> f64 {
        100.0 * count(set) as f64 / self.n_blocks() as f64
    }

    /// The blocks that exist and are not in a set.
    pub fn others(&self, set: &[bool]) -> Vec<bool> {
        let pairs = self.exists.iter().zip(set);
        pairs.map(|(&exists, &is_in)| exists && !is_in).collect()
    }

    /// The opening of a set: all its squares of `side` x `side` blocks, each wholly in the set. Places outside of the slider
    /// are in no set, so that a strip along an edge is as narrow as it looks.
    pub fn opened(&self, set: &[bool], side: usize) -> Vec<bool> {
        if side <= 1 {
            return set.to_vec();
        }
        if (0..2).any(|axis| side > self.size()[axis]) {
            return vec![false; set.len()];
        }
        let mut found = set.to_vec();
        for axis in 0..2 {
            self.pass(&mut found, axis, side, Pass::AllAfter);
        }
        for axis in 0..2 {
            self.pass(&mut found, axis, side, Pass::AnyBefore);
        }
        found
    }

    /// The smallest width of a set: the largest side of a square by which it can be opened without losing a block; none for
    /// an empty set.
    pub fn width(&self, set: &[bool]) -> Option<usize> {
        if !set.contains(&true) {
            return None;
        }
        let most = self.size()[0].min(self.size()[1]);
        // A union of squares is one of smaller squares too.
        let (mut low, mut high) = (1, most);
        while low < high {
            let middle = (low + high).div_ceil(2);
            if self.opened(set, middle) == set {
                low = middle;
            } else {
                high = middle - 1;
            }
        }
        Some(low)
    }

    /// Number of pieces of a set whose blocks touch at an edge.
    pub fn n_pieces(&self, set: &[bool]) -> usize {
        let mut left = set.to_vec();
        let mut pieces = 0;
        let mut to_visit = Vec::new();
        for first in 0..left.len() {
            if !left[first] {
                continue;
            }
            pieces += 1;
            left[first] = false;
            to_visit.push(first);
            while let Some(block) = to_visit.pop() {
                let neighbours =
                    [[-1, 0], [1, 0], [0, -1], [0, 1]].map(|offset| self.neighbour(block, offset));
                for next in neighbours.into_iter().flatten() {
                    if std::mem::take(&mut left[next]) {
                        to_visit.push(next);
                    }
                }
            }
        }
        pieces
    }

    /// Replaces every block by whether all of the `side` blocks from it on are in the set, or any of the `side` blocks up to
    /// it.
    fn pass(&self, set: &mut [bool], axis: usize, side: usize, pass: Pass) {
        let n = self.size()[axis];
        let [stride, across] = [[1, self.size()[0]][axis], [self.size()[0], 1][axis]];
        let mut line = vec![false; n];
        for first in (0..self.size()[1 - axis]).map(|place| place * across) {
            for (place, value) in line.iter_mut().enumerate() {
                *value = set[first + place * stride];
            }
            // How many of the blocks that end here are in the set, one after the other, and how many are not.
            let (mut inside, mut outside) = (0, side);
            let turns = if self.is_periodic(axis) { 2 } else { 1 };
            for place in (0..turns * n).map(|place| place % n) {
                (inside, outside) = if line[place] {
                    (inside + 1, 0)
                } else {
                    (0, outside + 1)
                };
                match pass {
                    Pass::AllAfter => {
                        // A line that does not wrap has no square before its first block.
                        let start = (place + n + 1 - side) % n;
                        set[first + start * stride] = inside >= side;
                    }
                    Pass::AnyBefore => set[first + place * stride] = outside < side,
                }
            }
            if pass == Pass::AllAfter && !self.is_periodic(axis) {
                for place in n + 1 - side..n {
                    set[first + place * stride] = false;
                }
            }
        }
    }
}

/// Rule of a pass over a line.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pass {
    AllAfter,
    AnyBefore,
}

/// Number of blocks in a set.
pub(super) fn count(set: &[bool]) -> usize {
    set.iter().filter(|&&is_in| is_in).count()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A grid all of whose blocks exist.
    pub(in crate::design) fn whole([nx, ny]: [usize; 2], periodic: [bool; 2]) -> Grid {
        let edges = periodic.map(|is_periodic| if is_periodic { Edges::Periodic } else { Edges::Free });
        Grid {
            lattice: Lattice::with_edges(nx, ny, edges),
            exists: vec![true; nx * ny],
        }
    }

    /// A grid, and a set drawn with `#`, the largest y first.
    pub(in crate::design) fn drawn(rows: &[&str], periodic: [bool; 2]) -> (Grid, Vec<bool>) {
        let set: Vec<bool> = rows
            .iter()
            .rev()
            .flat_map(|row| row.bytes().map(|byte| byte == b'#'))
            .collect();
        (whole([rows[0].len(), rows.len()], periodic), set)
    }

    /// The definition of an opening, square by square.
    fn opened_by_squares(grid: &Grid, set: &[bool], side: usize) -> Vec<bool> {
        let [nx, ny] = grid.size();
        let mut found = vec![false; set.len()];
        for y in 0..ny {
            for x in 0..nx {
                if (!grid.is_periodic(0) && x + side > nx) || (!grid.is_periodic(1) && y + side > ny) {
                    continue;
                }
                let square: Vec<usize> = (0..side * side)
                    .map(|k| (y + k / side) % ny * nx + (x + k % side) % nx)
                    .collect();
                if square.iter().all(|&block| set[block]) {
                    for block in square {
                        found[block] = true;
                    }
                }
            }
        }
        found
    }

    #[test]
    fn an_opening_is_the_union_of_its_squares() {
        let mut draws = crate::draws::Draws::new(3);
        for trial in 0..200 {
            let size = [3 + draws.below(8), 3 + draws.below(8)];
            let n = size[0] * size[1];
            let grid = whole(size, [trial % 2 == 0, trial % 3 == 0]);
            let set: Vec<bool> = (0..n).map(|_| draws.uniform() < 0.8).collect();
            for side in 1..=4 {
                let expected = if side > size[0].min(size[1]) {
                    vec![false; n]
                } else {
                    opened_by_squares(&grid, &set, side)
                };
                assert_eq!(grid.opened(&set, side), expected, "{grid:?} {side}");
            }
        }
    }

    /// A strip of one block along an edge is one block wide, whatever may lie outside.
    #[test]
    fn slivers_at_edges_are_seen() {
        let rows = ["#....", "#....", "#.###", "#.###", "#.###"];
        let (grid, set) = drawn(&rows, [false; 2]);
        assert_eq!(grid.width(&set), Some(1));
        assert_eq!(grid.n_pieces(&set), 2);
        let opened = grid.opened(&set, 3);
        assert_eq!(
            opened,
            drawn(&[".....", ".....", "..###", "..###", "..###"], [false; 2]).1
        );
        assert_eq!(grid.width(&opened), Some(3));
        // Around a periodic axis, the strip is a part of what lies beyond.
        let (around, set) = drawn(&["##..#", "##..#", "##..#"], [true, false]);
        assert_eq!((around.width(&set), around.n_pieces(&set)), (Some(3), 1));
        assert_eq!(around.width(&[false; 15]), None);
    }
}
