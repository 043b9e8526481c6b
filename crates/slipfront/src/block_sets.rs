//! Widths and pieces of sets of blocks. A set has one mark per block, row-major, the smallest y first.

use slipfront_kernel::lattice::{Edges, Lattice};

/// The opening of a set: the union of all squares of `side` x `side` blocks that lie wholly in the set.
/// Places beyond free edges are in no set, so that a strip along an edge is as narrow as it looks.
///
/// ```
/// # use slipfront::{Lattice, block_sets};
/// let set = [true, true, false, true].repeat(2);
/// assert_eq!(block_sets::opened(&Lattice::free(4, 2), &set, 2), [true, true, false, false].repeat(2));
/// ```
pub fn opened(lattice: &Lattice, set: &[bool], side: usize) -> Vec<bool> {
    if side > lattice.nx.min(lattice.ny) {
        return vec![false; set.len()];
    }
    let mut found = set.to_vec();
    for axis in 0..2 {
        keep_starts(lattice, &mut found, axis, side);
    }
    for axis in 0..2 {
        extend(lattice, &mut found, axis, side);
    }
    found
}

/// The width of a set: the largest side of a square for which the opening loses no block; none for an
/// empty set.
pub fn width(lattice: &Lattice, set: &[bool]) -> Option<usize> {
    if !set.contains(&true) {
        return None;
    }
    // A union of squares is also a union of smaller squares.
    let (mut low, mut high) = (1, lattice.nx.min(lattice.ny));
    while low < high {
        let middle = (low + high).div_ceil(2);
        if opened(lattice, set, middle) == set {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    Some(low)
}

/// Number of pieces of a set, joined where blocks share an edge.
pub fn n_pieces(lattice: &Lattice, set: &[bool]) -> usize {
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
            let (i, j) = lattice.column_row(block);
            let neighbours = [[-1, 0], [1, 0], [0, -1], [0, 1]].map(|offset| lattice.neighbour(i, j, offset));
            for next in neighbours.into_iter().flatten() {
                if std::mem::take(&mut left[next]) {
                    to_visit.push(next);
                }
            }
        }
    }
    pieces
}

/// Keeps the blocks that begin a run of `side` blocks along an axis in the set.
fn keep_starts(lattice: &Lattice, set: &mut [bool], axis: usize, side: usize) {
    for step in doublings(side) {
        each_line(lattice, set, axis, step, |line, old, shift, wraps| {
            let (kept, last) = line.split_at_mut(old.len() - shift);
            for (block, further) in kept.iter_mut().zip(&old[shift..]) {
                *block &= further;
            }
            for (block, further) in last.iter_mut().zip(old) {
                *block &= *further && wraps;
            }
        });
    }
}

/// Adds to each block of a set the next `side - 1` blocks along an axis.
fn extend(lattice: &Lattice, set: &mut [bool], axis: usize, side: usize) {
    for step in doublings(side) {
        each_line(lattice, set, axis, step, |line, old, shift, wraps| {
            let (first, reached) = line.split_at_mut(shift);
            for (block, before) in reached.iter_mut().zip(old) {
                *block |= before;
            }
            for (block, before) in first.iter_mut().zip(&old[old.len() - shift..]) {
                *block |= *before && wraps;
            }
        });
    }
}

/// Calls a function on each line along an axis: on single rows along x, and on all rows at once along y.
/// Passes the line, a copy of it, the distance in it of `step` blocks along the axis, and whether its
/// last block is the neighbour of its first.
fn each_line(
    lattice: &Lattice,
    set: &mut [bool],
    axis: usize,
    step: usize,
    function: impl Fn(&mut [bool], &[bool], usize, bool),
) {
    let [length, shift] = [[lattice.nx, step], [set.len(), step * lattice.nx]][axis];
    let wraps = lattice.edges[axis] == Edges::Periodic;
    for line in set.chunks_exact_mut(length) {
        let old = line.to_vec();
        function(line, &old, shift, wraps);
    }
}

/// Shifts by which a set is joined with shifted copies of itself, one after the other, until `side` blocks
/// are joined: 1, 2, 4 and so on, and the rest.
fn doublings(side: usize) -> impl Iterator<Item = usize> {
    let mut joined = 1;
    std::iter::from_fn(move || {
        let step = joined.min(side.saturating_sub(joined));
        joined += step;
        (step > 0).then_some(step)
    })
}
