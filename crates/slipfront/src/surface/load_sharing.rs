//! The load of textured blocks, shared among nearby blocks in contact.

use std::ops::Range;

use crate::communicator::Communicator;
use crate::error::SurfaceError;
use crate::lattice::{Edges, Lattice};

/// Number of blocks with marks that fit into one word.
const MARKS: usize = u64::BITS as usize;

/// Pressures, over the mean pressure, of the blocks in some rows after the load of each textured block has
/// been shared in equal parts among the blocks in contact with centres at most `distance` blocks away. The
/// load of blocks in contact is divided by `factor`, by which
/// [`Load::Redistributed`](super::Load::Redistributed) multiplies it; textured blocks keep their pressure.
/// The total is exact except for the rounding of each load.
///
/// ```text
/// F_i = p_i + sum_j p_j/n_j   over textured blocks j near i,   n_j the number of blocks in contact near j
/// ```
///
/// `textured` and `exists` have a mark for every block of these rows, and `pressure` has their `p_i`; without
/// `exists` all blocks exist, and without `pressure` it is uniform. A block that does not exist bears no
/// load, whether it is textured or not. All `ranks` of a lattice must call this together. Results have the
/// same bits for any number of ranks.
///
/// # Errors
/// [`SurfaceError::NoContactNear`] if there is no block in contact near a textured block.
pub fn share_load(
    lattice: &Lattice,
    rows: &Range<usize>,
    textured: &[bool],
    exists: Option<&[bool]>,
    pressure: Option<Vec<f64>>,
    distance: f64,
    ranks: &dyn Communicator,
) -> Result<Vec<f64>, SurfaceError> {
    let own = lattice.blocks_of(rows);
    let n = lattice.n_blocks();
    let is_there = |b: usize| exists.is_none_or(|exists| exists[b]);
    let contact = of_all_ranks(n, &own, |b| !textured[b] && is_there(b), ranks);
    let lends = of_all_ranks(n, &own, |b| textured[b] && is_there(b), ranks);
    let pressures = pressure.map(|pressure| {
        let mut bits = vec![0; n];
        for (bits, value) in bits[own.clone()].iter_mut().zip(&pressure) {
            *bits = value.to_bits() as i64;
        }
        ranks.sum(&mut bits);
        bits.into_iter()
            .map(|bits| f64::from_bits(bits as u64))
            .collect::<Vec<f64>>()
    });
    let pressure = |b: usize| pressures.as_ref().map_or(1.0, |pressures| pressures[b]);
    let total: [f64; 2] = [&contact, &lends].map(|marks| {
        let marked = (0..n).filter(|&b| marks[b]);
        marked.map(pressure).sum()
    });
    let factor = (total[0] + total[1]) / total[0];
    let largest = (0..n).filter(|&b| lends[b]).map(pressure).fold(0.0, f64::max);
    let disc = Disc::new(lattice, distance);
    // Integers have the same sum in any order. The sum of a row is at most 2^62.
    let quantum = largest * lattice.nx as f64 / (1_u64 << 62) as f64;
    let counts = Rows::new(lattice, |b| i64::from(contact[b]));
    let mut shares = vec![0; n];
    for b in (0..n).filter(|&b| lends[b]) {
        let near = disc.sum(&counts, b);
        if near == 0 {
            let (i, j) = lattice.column_row(b);
            return Err(SurfaceError::NoContactNear { i, j, distance });
        }
        shares[b] = (pressure(b) / near as f64 / quantum) as i64;
    }
    let shares = Rows::new(lattice, |b| shares[b]);
    let after = |b: usize| {
        if contact[b] {
            (pressure(b) + quantum * disc.sum(&shares, b) as f64) / factor
        } else {
            pressure(b)
        }
    };
    Ok(own.map(after).collect())
}

/// Marks of all blocks of the lattice; each rank knows those of its own blocks.
fn of_all_ranks(
    n: usize,
    own: &Range<usize>,
    mark: impl Fn(usize) -> bool,
    ranks: &dyn Communicator,
) -> Vec<bool> {
    let mut words = vec![0_i64; n.div_ceil(MARKS)];
    for b in own.clone().filter(|b| mark(b - own.start)) {
        words[b / MARKS] |= 1 << (b % MARKS);
    }
    // No mark is set by two ranks.
    ranks.sum(&mut words);
    (0..n).map(|b| words[b / MARKS] >> (b % MARKS) & 1 == 1).collect()
}

/// Cumulative sums from the beginning of every row; their differences are sums over parts of rows.
struct Rows {
    nx: usize,
    sums: Vec<i64>,
}

impl Rows {
    fn new(lattice: &Lattice, value: impl Fn(usize) -> i64) -> Self {
        let mut sums = Vec::with_capacity(lattice.ny * (lattice.nx + 1));
        for j in 0..lattice.ny {
            let mut sum = 0;
            sums.push(0);
            for i in 0..lattice.nx {
                sum += value(lattice.block(i, j));
                sums.push(sum);
            }
        }
        Self { nx: lattice.nx, sums }
    }

    /// Sum over some columns of a row.
    fn sum(&self, j: usize, columns: Range<usize>) -> i64 {
        let row = &self.sums[j * (self.nx + 1)..];
        row[columns.end] - row[columns.start]
    }
}

/// The blocks near a block: those with centres within a disc about its own centre.
struct Disc<'a> {
    lattice: &'a Lattice,
    /// The number of columns on each side, for every distance in rows.
    reach: Vec<usize>,
}

impl<'a> Disc<'a> {
    fn new(lattice: &'a Lattice, distance: f64) -> Self {
        let most = distance.min((lattice.nx + lattice.ny) as f64);
        let reach = (0..=most as usize).map(|rows| (most * most - (rows * rows) as f64).sqrt() as usize);
        Self {
            lattice,
            reach: reach.collect(),
        }
    }

    /// Sum over the blocks near block `b`; the sum over several rows may exceed the limit for one row.
    fn sum(&self, rows: &Rows, b: usize) -> i128 {
        let mut sum = 0;
        self.for_each_part(b, |j, columns| sum += i128::from(rows.sum(j, columns)));
        sum
    }

    /// Visits each block near block `b` once, in parts of rows; parts beyond periodic edges are at the other
    /// side.
    fn for_each_part(&self, b: usize, mut visit: impl FnMut(usize, Range<usize>)) {
        let (i, j) = self.lattice.column_row(b);
        let Lattice { nx, ny, edges } = *self.lattice;
        let most = self.reach.len() - 1;
        // Counted from one lattice below, so that no number is negative.
        let rows = match edges[1] {
            Edges::Free => ny + j.saturating_sub(most)..ny + ny.min(j + most + 1),
            Edges::Periodic if 2 * most + 1 >= ny => ny..2 * ny,
            Edges::Periodic => ny + j - most..ny + j + most + 1,
        };
        for row in rows.map(|row| row % ny) {
            let apart = row.abs_diff(j);
            let apart = match edges[1] {
                Edges::Free => apart,
                Edges::Periodic => apart.min(ny - apart),
            };
            let Some(&reach) = self.reach.get(apart) else {
                continue;
            };
            if 2 * reach + 1 >= nx && edges[0] == Edges::Periodic {
                visit(row, 0..nx);
                continue;
            }
            let (from, end) = (i as isize - reach as isize, i + reach + 1);
            visit(row, from.max(0) as usize..end.min(nx));
            if edges[0] == Edges::Periodic {
                if from < 0 {
                    visit(row, (nx as isize + from) as usize..nx);
                }
                if end > nx {
                    visit(row, 0..end - nx);
                }
            }
        }
    }
}
