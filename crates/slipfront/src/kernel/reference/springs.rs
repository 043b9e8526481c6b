//! The springs between blocks (Eq. 3): forces and energy.

use std::ops::Range;

use crate::communicator::Communicator;
use crate::fixed_point;
use crate::lattice::{Bond, Edges, Lattice};
use crate::model::Model;
use crate::state::State;
use crate::vector_field::VectorField;

/// Eq. 3: `F_c = sum_j k_ij (r_ij - d_ij) e_ij` over the eight neighbours, every spring computed once. `relative`: stiffness of each
/// over that of its bond, if they are not all alike.
#[inline(always)]
pub(super) fn lattice_forces(
    lattice: &Lattice,
    epsilon: f64,
    state: &State,
    relative: Option<&[Vec<f64>; 4]>,
    force: &mut VectorField,
    springs: &mut [VectorField; 4],
) {
    let u = &state.displacement;
    for (bond, spring) in Bond::ALL.iter().zip(springs.iter_mut()) {
        let all = |n: usize, shift: usize, force: [&mut [f64]; 2]| {
            let ahead = [&u.x[shift..shift + n], &u.y[shift..shift + n]];
            bond_forces(bond, epsilon, [&u.x[..n], &u.y[..n]], ahead, force);
        };
        let one = |b: usize, other: usize| bond.force([u.x[other] - u.x[b], u.y[other] - u.y[b]], epsilon);
        along_bond(lattice, bond, all, one, spring);
    }
    sum_all(lattice, relative, force, springs);
}

/// Forces of dampers beside all springs (Kelvin-Voigt), `F_v = sum_j tau_v k_ij (e_ij . (v_j - v_i)) e_ij`, of the velocities half a
/// step before.
#[inline(always)]
pub(super) fn damper_forces(
    lattice: &Lattice,
    model: &Model,
    state: &State,
    relative: Option<&[Vec<f64>; 4]>,
    force: &mut VectorField,
    dampers: &mut [VectorField; 4],
) {
    let (u, v) = (&state.displacement, &state.velocity);
    let (epsilon, time) = (model.epsilon, model.slider.viscosity_time);
    for (bond, damper) in Bond::ALL.iter().zip(dampers.iter_mut()) {
        let one = |b: usize, other: usize| {
            let e = [u.x[other] - u.x[b], u.y[other] - u.y[b]];
            let w = [v.x[other] - v.x[b], v.y[other] - v.y[b]];
            bond.damper_force(e, w, epsilon).map(|force| time * force)
        };
        let all = |n: usize, shift: usize, [fx, fy]: [&mut [f64]; 2]| {
            let fields = [&u.x, &u.y, &v.x, &v.y];
            let [ux, uy, vx, vy] = fields.map(|field| &field[..n]);
            let [next_ux, next_uy, next_vx, next_vy] = fields.map(|field| &field[shift..shift + n]);
            let (fx, fy) = (&mut fx[..n], &mut fy[..n]);
            for k in 0..n {
                let e = [next_ux[k] - ux[k], next_uy[k] - uy[k]];
                let w = [next_vx[k] - vx[k], next_vy[k] - vy[k]];
                [fx[k], fy[k]] = bond.damper_force(e, w, epsilon).map(|force| time * force);
            }
        };
        along_bond(lattice, bond, all, one, damper);
    }
    sum_all(lattice, relative, force, dampers);
}

/// Sums what acts along the bonds of every block, after it was made `relative` times as strong.
#[inline(always)]
fn sum_all(
    lattice: &Lattice,
    relative: Option<&[Vec<f64>; 4]>,
    force: &mut VectorField,
    springs: &mut [VectorField; 4],
) {
    for (relative, spring) in relative.into_iter().flatten().zip(springs.iter_mut()) {
        for component in [&mut spring.x, &mut spring.y] {
            component
                .iter_mut()
                .zip(relative)
                .for_each(|(force, relative)| *force *= relative);
        }
    }
    let [x, y] = [&*springs; 2];
    sum_springs(lattice, x.each_ref().map(|spring| &*spring.x), &mut force.x);
    sum_springs(lattice, y.each_ref().map(|spring| &*spring.y), &mut force.y);
}

/// Force on every block along `bond`; zero where a free edge leaves its neighbour out. `all` finds the forces on the first blocks,
/// given their number and how far away the neighbours of all of them are; `one` the force on a block from its neighbour.
#[inline(always)]
fn along_bond(
    lattice: &Lattice,
    bond: &Bond,
    all: impl FnOnce(usize, usize, [&mut [f64]; 2]),
    one: impl Fn(usize, usize) -> [f64; 2],
    force: &mut VectorField,
) {
    // In block order the neighbours of all blocks are equally far away: one loop for all rows. What it finds at the ends of
    // the rows is replaced afterwards.
    let shift = lattice.shift(bond).min(lattice.n_blocks());
    let n = lattice.n_blocks() - shift;
    all(n, shift, [&mut force.x[..n], &mut force.y[..n]]);
    let mut replace = |i: usize, j: usize| {
        let b = lattice.block(i, j);
        [force.x[b], force.y[b]] = match lattice.neighbour(i, j, bond.offset) {
            Some(other) => one(b, other),
            None => [0.0, 0.0],
        };
    };
    match bond.offset[0] {
        1 => (0..lattice.ny).for_each(|j| replace(lattice.nx - 1, j)),
        -1 => (0..lattice.ny).for_each(|j| replace(0, j)),
        _ => {}
    }
    if bond.offset[1] == 1 {
        match lattice.edges[1] {
            Edges::Periodic => (0..lattice.nx).for_each(|i| replace(i, lattice.ny - 1)),
            Edges::Free => {
                let top = lattice.block(0, lattice.ny - 1);
                force.x[top..].fill(0.0);
                force.y[top..].fill(0.0);
            }
        }
    }
}

/// Forces along one bond on blocks displaced by `u`, from their neighbours displaced by `v`.
#[inline(always)]
fn bond_forces(bond: &Bond, epsilon: f64, u: [&[f64]; 2], v: [&[f64]; 2], force: [&mut [f64]; 2]) {
    let [fx, fy] = force;
    let n = fx.len();
    let (ux, uy, vx, vy, fy) = (&u[0][..n], &u[1][..n], &v[0][..n], &v[1][..n], &mut fy[..n]);
    for k in 0..n {
        [fx[k], fy[k]] = bond.force([vx[k] - ux[k], vy[k] - uy[k]], epsilon);
    }
}

/// Adds the eight springs of every block: along each bond that to the neighbour ahead, less that of the neighbour behind.
#[inline(always)]
fn sum_springs(lattice: &Lattice, springs: [&[f64]; 4], total: &mut [f64]) {
    // One loop for all rows again, from the first block whose neighbours behind it all have indices from 0.
    let first = lattice.shift(&Bond::NORTH_EAST).min(lattice.n_blocks());
    let n = lattice.n_blocks() - first;
    let own = springs.map(|spring| &spring[first..]);
    let mut behind = springs;
    for (spring, bond) in behind.iter_mut().zip(&Bond::ALL) {
        let from = first - lattice.shift(bond).min(first);
        *spring = &spring[from..from + n];
    }
    add_pairs(own, behind, &mut total[first..]);
    if lattice.edges[1] == Edges::Free {
        // Below the bottom row there is nothing, and the neighbour behind along the row is the block before.
        let row = springs.map(|spring| &spring[1..lattice.nx]);
        add_bottom_row(row, &springs[0][..lattice.nx - 1], &mut total[1..lattice.nx]);
    }
    let mut replace = |i: usize, j: usize| {
        let pair = |bond: usize| {
            let Bond { offset: [di, dj], .. } = Bond::ALL[bond];
            let behind = lattice
                .neighbour(i, j, [-di, -dj])
                .map_or(0.0, |b| springs[bond][b]);
            springs[bond][lattice.block(i, j)] - behind
        };
        total[lattice.block(i, j)] = (pair(0) + pair(1)) + (pair(2) + pair(3));
    };
    replace(0, 0);
    if lattice.edges[1] == Edges::Periodic {
        (1..lattice.nx).for_each(|i| replace(i, 0));
    }
    // At free edges the loop found springs of force zero, which is right; along a periodic axis neighbours wrap around.
    (1..lattice.ny).for_each(|j| replace(0, j));
    if lattice.edges[0] == Edges::Periodic {
        (1..lattice.ny).for_each(|j| replace(lattice.nx - 1, j));
    }
}

#[inline(always)]
fn add_pairs(own: [&[f64]; 4], behind: [&[f64]; 4], total: &mut [f64]) {
    let n = total.len();
    let [e, north, ne, nw] = own.map(|spring| &spring[..n]);
    let [w, s, sw, se] = behind.map(|spring| &spring[..n]);
    for k in 0..n {
        total[k] = ((e[k] - w[k]) + (north[k] - s[k])) + ((ne[k] - sw[k]) + (nw[k] - se[k]));
    }
}

#[inline(always)]
fn add_bottom_row(own: [&[f64]; 4], before: &[f64], total: &mut [f64]) {
    let n = total.len();
    let ([e, north, ne, nw], w) = (own.map(|spring| &spring[..n]), &before[..n]);
    for k in 0..n {
        total[k] = ((e[k] - w[k]) + north[k]) + (ne[k] + nw[k]);
    }
}

/// The rows of a lattice that this rank holds, of which `ranks` together hold `n_rows`.
pub(super) struct OwnRows<'a> {
    pub(super) ranks: &'a dyn Communicator,
    /// Of the whole lattice.
    pub(super) n_rows: usize,
    /// Number of the first in the whole lattice.
    pub(super) first_row: usize,
    /// In the lattice that springs are summed over, which may have rows of other ranks.
    pub(super) rows: Range<usize>,
}

impl OwnRows<'_> {
    /// Sum of numbers of all rows, of which `of_row` gives those of this rank: in the same order for any number of ranks, and so with
    /// the same bits.
    fn sum(&self, of_row: impl Fn(usize) -> f64) -> f64 {
        let mut bits = vec![0; self.n_rows];
        for (bits, j) in bits[self.first_row..].iter_mut().zip(self.rows.clone()) {
            *bits = of_row(j).to_bits() as i64;
        }
        self.ranks.sum(&mut bits);
        bits.into_iter().map(|bits| f64::from_bits(bits as u64)).sum()
    }
}

/// Energy of all springs between blocks at displacements `u`. `relative`: stiffness of each over that of its bond, if they are not
/// all alike.
#[inline(always)]
pub(super) fn lattice_energy(
    lattice: &Lattice,
    own: OwnRows,
    u: &VectorField,
    relative: Option<&[Vec<f64>; 4]>,
    epsilon: f64,
) -> f64 {
    let energy = |bond: &Bond, b: usize, n: usize| bond.energy([u.x[n] - u.x[b], u.y[n] - u.y[b]], epsilon);
    match relative {
        None => sum_energies(lattice, own, |bond, b, n| energy(&Bond::ALL[bond], b, n)),
        Some(relative) => sum_energies(lattice, own, |bond, b, n| {
            relative[bond][b] * energy(&Bond::ALL[bond], b, n)
        }),
    }
}

/// Sum of the energies of all springs, of which `energy` is given the number of the bond, the block and its neighbour.
#[inline(always)]
fn sum_energies(lattice: &Lattice, own: OwnRows, energy: impl Fn(usize, usize, usize) -> f64) -> f64 {
    let row_energy = |number: usize, j: usize| -> f64 {
        let bond = &Bond::ALL[number];
        // One block of the row may have its neighbour beyond the end of the row. The neighbours of all others are equally far away.
        let (end, first) = match bond.offset[0] {
            1 => (Some(lattice.nx - 1), 0),
            -1 => (Some(0), 1),
            _ => (None, 0),
        };
        let beyond = end.and_then(|i| {
            Some(energy(
                number,
                lattice.block(i, j),
                lattice.neighbour(i, j, bond.offset)?,
            ))
        });
        let inside = lattice.nx - usize::from(end.is_some());
        let neighbour = if inside > 0 {
            lattice.neighbour(first, j, bond.offset)
        } else {
            None
        };
        let along = neighbour.map_or(0.0, |neighbour| {
            let block = lattice.block(first, j);
            fixed_point::sum(inside, |k| energy(number, block + k, neighbour + k))
        });
        along + beyond.unwrap_or(0.0)
    };
    (0..Bond::ALL.len())
        .map(|bond| own.sum(|j| row_energy(bond, j)))
        .sum()
}
