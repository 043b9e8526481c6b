//! The springs between blocks (Eq. 3): forces and energy.

use std::ops::Range;

use super::rows::Rows;
use crate::forces::{part, part_mut};
use crate::lattice::{Bond, Edges, Lattice};
use crate::model::Model;
use crate::vector_field::VectorField;
use slipfront_kernel::fixed_point;

/// A connection between a block and its neighbour along a bond.
pub(super) trait Connection {
    /// The forces on consecutive blocks from their neighbours, which are all the same distance away in
    /// memory.
    fn forces(&self, bond: &Bond, blocks: &Range<usize>, neighbours: &Range<usize>, force: [&mut [f64]; 2]);
}

/// A spring, given displacements (Eq. 3): `k_ij (r_ij - d_ij) e_ij`.
pub(super) struct Spring<'a> {
    pub(super) u: &'a VectorField,
    pub(super) epsilon: f64,
}

/// A damper in parallel with a spring (Kelvin-Voigt), `tau_v k_ij (e_ij . (v_j - v_i)) e_ij`, given
/// displacements and the velocities half a step before.
pub(super) struct Damper<'a> {
    pub(super) u: &'a VectorField,
    pub(super) v: &'a VectorField,
    pub(super) epsilon: f64,
    /// The time `tau_v`.
    pub(super) time: f64,
}

impl Connection for Spring<'_> {
    #[inline(always)]
    fn forces(
        &self,
        bond: &Bond,
        blocks: &Range<usize>,
        neighbours: &Range<usize>,
        [fx, fy]: [&mut [f64]; 2],
    ) {
        let n = fx.len();
        let ([ux, uy], [next_ux, next_uy]) = (part(self.u, blocks), part(self.u, neighbours));
        let (ux, uy, next_ux, next_uy, fy) = (&ux[..n], &uy[..n], &next_ux[..n], &next_uy[..n], &mut fy[..n]);
        for k in 0..n {
            [fx[k], fy[k]] = bond.force([next_ux[k] - ux[k], next_uy[k] - uy[k]], self.epsilon);
        }
    }
}

impl Connection for Damper<'_> {
    #[inline(always)]
    fn forces(
        &self,
        bond: &Bond,
        blocks: &Range<usize>,
        neighbours: &Range<usize>,
        [fx, fy]: [&mut [f64]; 2],
    ) {
        let n = fx.len();
        let ([ux, uy], [next_ux, next_uy]) = (part(self.u, blocks), part(self.u, neighbours));
        let ([vx, vy], [next_vx, next_vy]) = (part(self.v, blocks), part(self.v, neighbours));
        let (ux, uy, next_ux, next_uy) = (&ux[..n], &uy[..n], &next_ux[..n], &next_uy[..n]);
        let (vx, vy, next_vx, next_vy, fy) = (&vx[..n], &vy[..n], &next_vx[..n], &next_vy[..n], &mut fy[..n]);
        for k in 0..n {
            let e = [next_ux[k] - ux[k], next_uy[k] - uy[k]];
            let w = [next_vx[k] - vx[k], next_vy[k] - vy[k]];
            let [x, y] = bond.damper_force(e, w, self.epsilon);
            [fx[k], fy[k]] = [self.time * x, self.time * y];
        }
    }
}

#[inline(always)]
fn difference(field: &VectorField, b: usize, other: usize) -> [f64; 2] {
    [field.x[other] - field.x[b], field.y[other] - field.y[b]]
}

/// Sums the forces of the connections of some blocks with their eight neighbours, every connection computed
/// once, times `relative`: stiffness of each spring over that of its bond, for a heterogeneous slider. Forces
/// along the `bonds` of the blocks before must be known.
#[inline(always)]
pub(super) fn sum_connections(
    rows: &Rows,
    blocks: &Range<usize>,
    connection: &impl Connection,
    relative: Option<&[Vec<f64>; 4]>,
    force: &mut VectorField,
    bonds: &mut [VectorField; 4],
) {
    let (lattice, [force_x, force_y]) = (&rows.lattice, part_mut(force, blocks));
    let (is_first, blocks) = (blocks.start == 0, &rows.among_all(blocks));
    // The springs that lead up from the row below also belong to another band: each band computes them
    // itself.
    let behind = is_first.then(|| rows.behind());
    for blocks in behind.iter().chain([blocks]) {
        for (number, along) in bonds.iter_mut().enumerate() {
            along_bond(lattice, blocks, &Bond::ALL[number], connection, along);
            if let Some(relative) = relative {
                let relative = &relative[number][blocks.clone()];
                for component in part_mut(along, blocks) {
                    let forces = component.iter_mut().zip(relative);
                    forces.for_each(|(force, relative)| *force *= relative);
                }
            }
        }
    }
    let [x, y] = [&*bonds; 2];
    sum_springs(lattice, blocks, x.each_ref().map(|along| &*along.x), force_x);
    sum_springs(lattice, blocks, y.each_ref().map(|along| &*along.y), force_y);
}

/// Blocks among `blocks` in column `i`.
#[inline(always)]
fn in_column(lattice: &Lattice, blocks: &Range<usize>, i: usize) -> impl Iterator<Item = usize> {
    let before = (blocks.start + lattice.nx - i - 1) / lattice.nx;
    (before * lattice.nx + i..blocks.end).step_by(lattice.nx)
}

/// The part of some blocks from `first` on and before `end`.
#[inline(always)]
fn between(blocks: &Range<usize>, first: usize, end: usize) -> Range<usize> {
    let end = end.min(blocks.end);
    first.max(blocks.start).min(end)..end
}

/// Force on some blocks along `bond`; zero for a block without neighbour beyond a free edge, as initially in
/// `force`.
#[inline(always)]
fn along_bond(
    lattice: &Lattice,
    blocks: &Range<usize>,
    bond: &Bond,
    connection: &impl Connection,
    force: &mut VectorField,
) {
    // In block order the neighbours of all blocks are the same distance away: one loop does all rows. Its
    // results at the ends of the rows are replaced afterwards.
    let (n, shift) = (lattice.n_blocks(), lattice.shift(bond));
    let inside = between(blocks, blocks.start, n.saturating_sub(shift));
    let neighbours = inside.start + shift..inside.end + shift;
    if !inside.is_empty() {
        connection.forces(bond, &inside, &neighbours, part_mut(force, &inside));
    }
    let column = match bond.offset[0] {
        1 => Some(lattice.nx - 1),
        -1 => Some(0),
        _ => None,
    };
    if let Some(i) = column {
        replace(lattice, in_column(lattice, blocks, i), bond, connection, force);
    }
    // Beyond a free edge there is no neighbour: the forces are zero there from the beginning, and no loop
    // overwrites them.
    if bond.offset[1] == 1 && lattice.edges[1] == Edges::Periodic {
        let top = between(blocks, lattice.block(0, lattice.ny - 1), n);
        replace(lattice, top, bond, connection, force);
    }
}

/// Forces along `bond` on blocks at the end of an axis. The loop over all rows used a block at the other end
/// of a row as the neighbour, since it is the same distance away in memory.
#[inline(always)]
fn replace(
    lattice: &Lattice,
    blocks: impl Iterator<Item = usize>,
    bond: &Bond,
    connection: &impl Connection,
    force: &mut VectorField,
) {
    for b in blocks {
        let (i, j) = lattice.column_row(b);
        match lattice.neighbour(i, j, bond.offset) {
            Some(other) => {
                let force = part_mut(force, &(b..b + 1));
                connection.forces(bond, &(b..b + 1), &(other..other + 1), force);
            }
            None => [force.x[b], force.y[b]] = [0.0, 0.0],
        }
    }
}

/// Adds the eight springs of some blocks: along each bond the force of the neighbour ahead, less the force of
/// the spring of the neighbour behind.
#[inline(always)]
fn sum_springs(lattice: &Lattice, blocks: &Range<usize>, springs: [&[f64]; 4], total: &mut [f64]) {
    // Again one loop for all rows, from the first block with only valid indices for its neighbours behind.
    let inside = between(blocks, lattice.shift(&Bond::NORTH_EAST), blocks.end);
    let (own, mut behind) = (springs.map(|spring| &spring[inside.clone()]), springs);
    for (spring, bond) in behind.iter_mut().zip(&Bond::ALL) {
        let from = inside.start - lattice.shift(bond).min(inside.start);
        *spring = &spring[from..from + inside.len()];
    }
    add_pairs(own, behind, &mut total[inside.start - blocks.start..]);
    if lattice.edges[1] == Edges::Free {
        // There is no row below the bottom row, and the neighbour behind along the row is the block before.
        let bottom = between(blocks, 1, lattice.nx);
        if !bottom.is_empty() {
            let row = springs.map(|spring| &spring[bottom.clone()]);
            let before = &springs[0][bottom.start - 1..bottom.end - 1];
            add_bottom_row(
                row,
                before,
                &mut total[bottom.start - blocks.start..][..bottom.len()],
            );
        }
    }
    let mut replace = |b: usize| {
        let (i, j) = lattice.column_row(b);
        let pair = |bond: usize| {
            let Bond { offset: [di, dj], .. } = Bond::ALL[bond];
            let behind = lattice
                .neighbour(i, j, [-di, -dj])
                .map_or(0.0, |b| springs[bond][b]);
            springs[bond][b] - behind
        };
        total[b - blocks.start] = (pair(0) + pair(1)) + (pair(2) + pair(3));
    };
    if lattice.edges[1] == Edges::Periodic {
        between(blocks, 0, lattice.nx).for_each(&mut replace);
    }
    match lattice.edges[0] {
        // Beyond free edges the loop read zero forces, as it should; it begins after the first block of the
        // second row.
        Edges::Free => {
            let firsts = [0, lattice.nx].into_iter();
            firsts.filter(|b| blocks.contains(b)).for_each(replace);
        }
        Edges::Periodic => {
            in_column(lattice, blocks, 0).for_each(&mut replace);
            in_column(lattice, blocks, lattice.nx - 1).for_each(&mut replace);
        }
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

/// Energies of the springs between blocks at displacements `u`: along each bond one value for every row of
/// this band. `relative`: stiffness of each spring over that of its bond, for a heterogeneous slider. `row`:
/// room for the energies of a row.
#[inline(always)]
pub(super) fn row_energies(
    model: &Model,
    rows: &Rows,
    u: &VectorField,
    relative: Option<&[Vec<f64>; 4]>,
    row: &mut [f64],
) -> [Vec<f64>; 4] {
    let mut found = <[Vec<f64>; 4]>::default();
    for (number, of_rows) in found.iter_mut().enumerate() {
        let relative = relative.map(|relative| &*relative[number]);
        for j in rows.own_rows() {
            of_rows.push(row_energy(model, rows, u, relative, (number, j), row));
        }
    }
    found
}

/// Energy of the springs along one bond of one row. Contains no closures, since these might be compiled
/// without the vector instructions of the step.
#[inline(always)]
fn row_energy(
    model: &Model,
    rows: &Rows,
    u: &VectorField,
    relative: Option<&[f64]>,
    (number, j): (usize, usize),
    row: &mut [f64],
) -> f64 {
    let (lattice, bond) = (&rows.lattice, &Bond::ALL[number]);
    let epsilon = model.epsilon;
    // One block of the row may have its neighbour beyond the end of the row. The neighbours of all other
    // blocks are the same distance away.
    let (end, first) = match bond.offset[0] {
        1 => (Some(lattice.nx - 1), 0),
        -1 => (Some(0), 1),
        _ => (None, 0),
    };
    let beyond = end.and_then(|i| {
        let b = lattice.block(i, j);
        let energy = bond.energy(difference(u, b, lattice.neighbour(i, j, bond.offset)?), epsilon);
        Some(relative.map_or(energy, |relative| relative[b] * energy))
    });
    let inside = lattice.nx - usize::from(end.is_some());
    let neighbour = if inside > 0 {
        lattice.neighbour(first, j, bond.offset)
    } else {
        None
    };
    let mut along = 0.0;
    if let Some(neighbour) = neighbour {
        let (b, row) = (lattice.block(first, j), &mut row[..inside]);
        let (blocks, neighbours) = (b..b + inside, neighbour..neighbour + inside);
        energies(bond, epsilon, part(u, &blocks), part(u, &neighbours), row);
        if let Some(relative) = relative {
            let weighted = row.iter_mut().zip(&relative[blocks]);
            weighted.for_each(|(energy, relative)| *energy *= relative);
        }
        along = fixed_point::sum(inside, |k| row[k]);
    }
    along + beyond.unwrap_or(0.0)
}

/// Energies of the springs along one bond of blocks displaced by `u`, to their neighbours displaced by `v`.
#[inline(always)]
fn energies(bond: &Bond, epsilon: f64, u: [&[f64]; 2], v: [&[f64]; 2], energy: &mut [f64]) {
    let n = energy.len();
    let (ux, uy, vx, vy) = (&u[0][..n], &u[1][..n], &v[0][..n], &v[1][..n]);
    for k in 0..n {
        energy[k] = bond.energy([vx[k] - ux[k], vy[k] - uy[k]], epsilon);
    }
}
