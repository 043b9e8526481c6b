//! The springs between blocks (Eq. 3): forces and energy.

use crate::fixed_point;
use crate::lattice::{Bond, Edges, Lattice};
use crate::model::Model;
use crate::state::State;
use crate::vector_field::VectorField;

/// Eq. 3: `F_c = sum_j k_ij (r_ij - d_ij) e_ij` over the eight neighbours, every spring computed once.
#[inline(always)]
pub(super) fn lattice_forces(
    model: &Model,
    state: &State,
    force: &mut VectorField,
    springs: &mut [VectorField; 4],
) {
    let lattice = &model.lattice;
    for (bond, spring) in Bond::ALL.iter().zip(springs.iter_mut()) {
        spring_forces(lattice, bond, &state.displacement, model.epsilon, spring);
    }
    let [x, y] = [&*springs; 2];
    sum_springs(lattice, x.each_ref().map(|spring| &*spring.x), &mut force.x);
    sum_springs(lattice, y.each_ref().map(|spring| &*spring.y), &mut force.y);
}

/// Force on every block from its spring along `bond`; zero where a free edge leaves it out.
#[inline(always)]
fn spring_forces(lattice: &Lattice, bond: &Bond, u: &VectorField, epsilon: f64, spring: &mut VectorField) {
    // In block order the neighbours of all blocks are equally far away: one loop for all rows. What it finds at the ends of
    // the rows is replaced afterwards.
    let shift = lattice.shift(bond).min(lattice.n_blocks());
    let n = lattice.n_blocks() - shift;
    bond_forces(
        bond,
        epsilon,
        [&u.x[..n], &u.y[..n]],
        [&u.x[shift..shift + n], &u.y[shift..shift + n]],
        [&mut spring.x[..n], &mut spring.y[..n]],
    );
    let mut replace = |i: usize, j: usize| {
        let b = lattice.block(i, j);
        [spring.x[b], spring.y[b]] = match lattice.neighbour(i, j, bond.offset) {
            Some(other) => bond.force([u.x[other] - u.x[b], u.y[other] - u.y[b]], epsilon),
            None => [0.0, 0.0],
        };
    };
    match bond.offset[0] {
        1 => (0..lattice.ny).for_each(|j| replace(lattice.nx - 1, j)),
        -1 => (0..lattice.ny).for_each(|j| replace(0, j)),
        _ => {}
    }
    if bond.offset[1] == 1 {
        (0..lattice.nx).for_each(|i| replace(i, lattice.ny - 1));
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
    (0..lattice.nx).for_each(|i| replace(i, 0));
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

/// Energy of all springs between blocks at displacements `u`.
#[inline(always)]
pub(super) fn lattice_energy(lattice: &Lattice, u: &VectorField, epsilon: f64) -> f64 {
    let energy = |bond: &Bond, b: usize, n: usize| bond.energy([u.x[n] - u.x[b], u.y[n] - u.y[b]], epsilon);
    let row_energy = |bond: &Bond, j: usize| -> f64 {
        // One block of the row may have its neighbour beyond the end of the row. The neighbours of all others are equally far away.
        let (end, first) = match bond.offset[0] {
            1 => (Some(lattice.nx - 1), 0),
            -1 => (Some(0), 1),
            _ => (None, 0),
        };
        let beyond = end.and_then(|i| {
            Some(energy(
                bond,
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
            fixed_point::sum(inside, |k| energy(bond, block + k, neighbour + k))
        });
        along + beyond.unwrap_or(0.0)
    };
    Bond::ALL
        .iter()
        .map(|bond| (0..lattice.ny).map(|j| row_energy(bond, j)).sum::<f64>())
        .sum()
}
