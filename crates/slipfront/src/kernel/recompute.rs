//! Blocks as they are at the present instant, for kernels that keep displacements and velocities only: forces are found
//! anew.

use fearless_simd::{Level, dispatch};

use super::Block;
use crate::Model;
use crate::lattice::Bond;
use crate::vector_field::length;

/// Blocks that are looked at together, one after the other in the order of the lattice.
pub(crate) const CHUNK_BLOCKS: usize = 64;

/// Components x and y of so many displacements, and of one more at either end.
type Row = [[f64; CHUNK_BLOCKS + 2]; 2];

/// Blocks `first`, `first + 1`, ..., at most [`CHUNK_BLOCKS`], at `time_star`. `motion` gives displacement and velocity of a
/// block.
pub(super) fn read_blocks(
    model: &Model,
    time_star: f64,
    first: usize,
    blocks: &mut [Block],
    motion: impl Fn(usize) -> [[f64; 2]; 2],
) {
    let lattice = &model.lattice;
    // Seen as one long row, the rows below and above stand equally far away. Where a row of the lattice ends meanwhile, and
    // beyond the first and the last one, what they give is not used.
    let mut rows = [[[0.0; CHUNK_BLOCKS + 2]; 2]; 3];
    for (row, far) in rows.iter_mut().zip([-1, 0, 1]) {
        let begin = first as isize + far * lattice.nx as isize - 1;
        for (k, b) in (begin..begin + blocks.len() as isize + 2).enumerate() {
            if (0..lattice.n_blocks() as isize).contains(&b) {
                [row[0][k], row[1][k]] = motion(b as usize)[0];
            }
        }
    }
    let level = Level::new();
    let inside = dispatch!(level, _ => forces_inside(model.epsilon, &rows));
    for (k, block) in blocks.iter_mut().enumerate() {
        let b = first + k;
        let (i, j) = lattice.column_row(b);
        let [displacement, velocity] = motion(b);
        let at_edge = i == 0 || i + 1 == lattice.nx || j == 0 || j + 1 == lattice.ny;
        let force_lattice = if at_edge {
            force_at_edge(model, [i, j], displacement, |b| motion(b)[0])
        } else {
            [inside[0][k], inside[1][k]]
        };
        let force_drive = model.drive.force(displacement, time_star);
        *block = Block {
            displacement,
            velocity,
            force_drive,
            force_lattice,
            force_friction: friction(model, b, velocity, force_drive, force_lattice),
        };
    }
}

/// Eq. 3 for blocks with eight neighbours each, summed as the kernels do. Rows are those below, of the blocks, and above.
#[inline(always)]
fn forces_inside(epsilon: f64, rows: &[Row; 3]) -> [[f64; CHUNK_BLOCKS]; 2] {
    let [e, n, ne, nw] = Bond::ALL.each_ref().map(|bond| pairs_inside(bond, epsilon, rows));
    let mut forces = [[0.0; CHUNK_BLOCKS]; 2];
    for (axis, force) in forces.iter_mut().enumerate() {
        for k in 0..CHUNK_BLOCKS {
            force[k] = (e[axis][k] + n[axis][k]) + (ne[axis][k] + nw[axis][k]);
        }
    }
    forces
}

/// Along one bond: the spring to the neighbour ahead, less that of the neighbour behind.
#[inline(always)]
fn pairs_inside(bond: &Bond, epsilon: f64, rows: &[Row; 3]) -> [[f64; CHUNK_BLOCKS]; 2] {
    let [di, dj] = bond.offset;
    let from = |side: isize| {
        let [x, y] = &rows[(1 + side * dj) as usize];
        let first = (1 + side * di) as usize;
        [&x[first..first + CHUNK_BLOCKS], &y[first..first + CHUNK_BLOCKS]]
    };
    let ([ux, uy], [ax, ay], [bx, by]) = (from(0), from(1), from(-1));
    let mut pairs = [[0.0; CHUNK_BLOCKS]; 2];
    for k in 0..CHUNK_BLOCKS {
        let ahead = bond.force([ax[k] - ux[k], ay[k] - uy[k]], epsilon);
        let behind = bond.force([ux[k] - bx[k], uy[k] - by[k]], epsilon);
        (pairs[0][k], pairs[1][k]) = (ahead[0] - behind[0], ahead[1] - behind[1]);
    }
    pairs
}

/// Eq. 3 for a block some of whose neighbours are missing, or stand at the other end of the lattice.
fn force_at_edge(
    model: &Model,
    [i, j]: [usize; 2],
    u: [f64; 2],
    displacement: impl Fn(usize) -> [f64; 2],
) -> [f64; 2] {
    let pair = |bond: &Bond| {
        let [di, dj] = bond.offset;
        let ahead = model.lattice.neighbour(i, j, [di, dj]).map_or([0.0; 2], |other| {
            let v = displacement(other);
            bond.force([v[0] - u[0], v[1] - u[1]], model.epsilon)
        });
        let behind = model
            .lattice
            .neighbour(i, j, [-di, -dj])
            .map_or([0.0; 2], |other| {
                let v = displacement(other);
                bond.force([u[0] - v[0], u[1] - v[1]], model.epsilon)
            });
        [ahead[0] - behind[0], ahead[1] - behind[1]]
    };
    let [e, n, ne, nw] = Bond::ALL.each_ref().map(pair);
    [(e[0] + n[0]) + (ne[0] + nw[0]), (e[1] + n[1]) + (ne[1] + nw[1])]
}

/// `F_f` of the projection law, from the velocity that it left: against it, or balancing the other forces at rest.
fn friction(model: &Model, b: usize, velocity: [f64; 2], drive: [f64; 2], lattice: [f64; 2]) -> [f64; 2] {
    if velocity == [0.0, 0.0] {
        return [-(drive[0] + lattice[0]), -(drive[1] + lattice[1])];
    }
    let pull = model.surface.kinetic_force(b) / length(velocity);
    [-pull * velocity[0], -pull * velocity[1]]
}
