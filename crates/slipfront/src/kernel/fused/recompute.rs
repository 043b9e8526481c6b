//! The forces on one block at the present instant. A sweep keeps displacements and velocities only; when forces are read
//! they are found again, by the exact spring law whatever formula the sweep used. `field_rows.rs` does this for all blocks.

use crate::kernel::block::Block;
use crate::lattice::Bond;
use crate::model::Model;
use crate::vector_field::length;

/// Block `b` at `time_star`. `motion` gives displacement and velocity of a block.
pub(super) fn block(
    model: &Model,
    time_star: f64,
    b: usize,
    motion: impl Fn(usize) -> [[f64; 2]; 2],
) -> Block {
    let [displacement, velocity] = motion(b);
    let force_lattice = lattice_force(model, b, displacement, |b| motion(b)[0]);
    let force_drive = model.drive.force(displacement, time_star);
    Block {
        displacement,
        velocity,
        force_drive,
        force_lattice,
        force_friction: friction(model, b, velocity, force_drive, force_lattice),
    }
}

/// Eq. 3 for one block, its springs summed in the order of the sweep.
fn lattice_force(model: &Model, b: usize, u: [f64; 2], displacement: impl Fn(usize) -> [f64; 2]) -> [f64; 2] {
    let (i, j) = model.lattice.column_row(b);
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

/// `F_f` of the projection law: kinetic friction against the velocity that the update left, or for a stuck block minus the
/// sum of the other forces.
fn friction(model: &Model, b: usize, velocity: [f64; 2], drive: [f64; 2], lattice: [f64; 2]) -> [f64; 2] {
    if velocity == [0.0, 0.0] {
        return [-(drive[0] + lattice[0]), -(drive[1] + lattice[1])];
    }
    let per_velocity = model.surface.kinetic_force(b) / length(velocity);
    [-per_velocity * velocity[0], -per_velocity * velocity[1]]
}
