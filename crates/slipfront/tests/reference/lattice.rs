//! Blocks of the slider and the springs between them, at rest.

use slipfront::{Edges, Model};

use super::vector::Vector;

/// The spring from a block to one of its eight neighbours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spring {
    /// The neighbour.
    pub(crate) to: usize,
    /// Vector **d** from the block to its neighbour at rest, in blocks.
    pub(crate) rest: Vector,
    /// Stiffness `k_ij`, in units of `E l`.
    pub(crate) stiffness: f64,
}

/// Whether block `b` exists; all blocks do without an outline.
pub(crate) fn exists(model: &Model, b: usize) -> bool {
    let outline = &model.slider().outline;
    outline.as_ref().is_none_or(|outline| outline.exists[b])
}

/// Mass `m_i = rho_i/rho`, in units of `rho l^3`.
pub(crate) fn mass(model: &Model, b: usize) -> f64 {
    model.slider().density.as_ref().map_or(1.0, |density| density[b])
}

/// Modulus `e_i = E_i/E`.
fn modulus(model: &Model, b: usize) -> f64 {
    model.slider().stiffness.as_ref().map_or(1.0, |moduli| moduli[b])
}

/// Position of the centre of block `b`, in blocks.
pub(crate) fn place(model: &Model, b: usize) -> Vector {
    let nx = model.lattice.nx;
    [(b % nx) as f64 + 0.5, (b / nx) as f64 + 0.5]
}

/// Coordinate `step` away from `from` on an axis of `count` blocks; none beyond a free edge.
fn beside(from: usize, step: i64, count: usize, edges: Edges) -> Option<usize> {
    let (to, count) = (from as i64 + step, count as i64);
    match edges {
        Edges::Periodic => Some(((to + count) % count) as usize),
        Edges::Free => (to >= 0 && to < count).then_some(to as usize),
    }
}

/// The springs of block `b`:
///
/// ```text
/// k_ij = k 2 e_i e_j/(e_i + e_j)     k_1 = 3/4, d = 1 (straight)     k_2 = k_1/2, d = sqrt(2) (diagonal)
/// ```
///
/// and half of this for springs along a free edge, if the slider halves these.
pub(crate) fn springs(model: &Model, b: usize) -> Vec<Spring> {
    let lattice = &model.lattice;
    let (i, j) = (b % lattice.nx, b / lattice.nx);
    let is_end = |place: usize, count: usize, edges| edges == Edges::Free && [0, count - 1].contains(&place);
    let mut springs = Vec::new();
    for [di, dj] in [
        [1, 0],
        [1, 1],
        [0, 1],
        [-1, 1],
        [-1, 0],
        [-1, -1],
        [0, -1],
        [1, -1],
    ] {
        let column = beside(i, di, lattice.nx, lattice.edges[0]);
        let row = beside(j, dj, lattice.ny, lattice.edges[1]);
        let (Some(column), Some(row)) = (column, row) else {
            continue;
        };
        let to = row * lattice.nx + column;
        if !exists(model, b) || !exists(model, to) {
            continue;
        }
        let straight = di == 0 || dj == 0;
        let k = if straight { 0.75 } else { 0.375 };
        let (here, there) = (modulus(model, b), modulus(model, to));
        let along_edge = (dj == 0 && is_end(j, lattice.ny, lattice.edges[1]))
            || (di == 0 && is_end(i, lattice.nx, lattice.edges[0]));
        let half = if model.slider().halves_edge_springs && along_edge {
            0.5
        } else {
            1.0
        };
        springs.push(Spring {
            to,
            rest: [di as f64, dj as f64],
            stiffness: half * k * 2.0 * here * there / (here + there),
        });
    }
    springs
}
