//! The reference kernel: one pass over the blocks per equation, to be read beside the paper.
//!
//! [`evaluate`] computes what happens at t_n (Eqs. 2-7), [`advance`] moves on to t_n+1 (Eq. 8). Opposite
//! neighbours are summed in pairs, straight ones before diagonal ones, so that a quarter turn or a mirror of
//! the whole problem mirrors the trajectory to the last bit.

use super::Forces;
use crate::friction::{self, Integrator, Law};
use crate::lattice::Bond;
use crate::vector_field::add;
use crate::{FrictionLaw, Lattice, Model, State, VectorField};

/// Forces on every block at `time_star`, and what friction makes of them over the coming step `dt_star`.
pub fn evaluate(model: &Model, state: &State, time_star: f64, dt_star: f64, forces: &mut Forces) {
    drive_forces(model, state, time_star, &mut forces.drive);
    lattice_forces(model, state, &mut forces.lattice, &mut forces.springs);
    let integrator = Integrator::new(model.damping, dt_star);
    match model.law {
        FrictionLaw::Projection => friction_forces(&friction::Projection, model, state, &integrator, forces),
        FrictionLaw::Reversal => friction_forces(&friction::Reversal, model, state, &integrator, forces),
        FrictionLaw::Literal => friction_forces(&friction::Literal, model, state, &integrator, forces),
    }
}

/// Eq. 8: `u(t + dt) = u(t) + dt v(t + dt/2)`.
pub fn advance(state: &mut State, dt_star: f64, forces: &mut Forces) {
    std::mem::swap(&mut state.velocity, &mut forces.velocity_after);
    std::mem::swap(&mut state.contact, &mut forces.contact_after);
    let State {
        displacement,
        velocity,
        ..
    } = state;
    displacement
        .x
        .iter_mut()
        .zip(&velocity.x)
        .for_each(|(u, v)| *u += dt_star * v);
    displacement
        .y
        .iter_mut()
        .zip(&velocity.y)
        .for_each(|(u, v)| *u += dt_star * v);
}

/// Eq. 2: `F_s = k_s (V t - u)`.
fn drive_forces(model: &Model, state: &State, time_star: f64, force: &mut VectorField) {
    let drive = &model.drive;
    let reach = drive.reach(time_star);
    let pull = |force: &mut [f64], u: &[f64], axis: usize| {
        for (f, u) in force.iter_mut().zip(u) {
            *f = drive.k_drive * (reach[axis] - u) + drive.constant_force[axis];
        }
    };
    pull(&mut force.x, &state.displacement.x, 0);
    pull(&mut force.y, &state.displacement.y, 1);
}

/// Eq. 3: `F_c = sum_j k_ij (r_ij - d_ij) e_ij` over the eight neighbours, every spring computed once.
fn lattice_forces(model: &Model, state: &State, force: &mut VectorField, springs: &mut [VectorField; 2]) {
    let lattice = &model.lattice;
    force.x.fill(0.0);
    force.y.fill(0.0);
    for bonds in [[Bond::EAST, Bond::NORTH], [Bond::NORTH_EAST, Bond::NORTH_WEST]] {
        for (bond, spring) in bonds.iter().zip(springs.iter_mut()) {
            spring_forces(lattice, bond, &state.displacement, model.epsilon, spring);
        }
        let [one, other] = &*springs;
        for (total, one, other) in [(&mut force.x, &one.x, &other.x), (&mut force.y, &one.y, &other.y)] {
            add_spring_pairs(lattice, total, [(one, bonds[0].offset), (other, bonds[1].offset)]);
        }
    }
}

/// Force on every block from its spring along `bond`; zero where a free edge leaves it out.
fn spring_forces(lattice: &Lattice, bond: &Bond, u: &VectorField, epsilon: f64, spring: &mut VectorField) {
    let nx = lattice.nx;
    for j in 0..lattice.ny {
        let row = lattice.row(j);
        let Some(other_row) = lattice.row_beside(j, bond.offset[1]) else {
            spring.x[row.clone()].fill(0.0);
            spring.y[row].fill(0.0);
            continue;
        };
        let (here, there) = (row.start, lattice.row(other_row).start);
        // Columns whose neighbour stands in the same stretch of the other row: all but the one at an end.
        let (first, len, end) = match bond.offset[0] {
            0 => (0, nx, None),
            1 => (0, nx - 1, Some(nx - 1)),
            _ => (1, nx - 1, Some(0)),
        };
        let from = here + first;
        let to = there.wrapping_add_signed(first as isize + bond.offset[0]);
        let (ux, uy) = (&u.x[from..from + len], &u.y[from..from + len]);
        let (vx, vy) = (&u.x[to..to + len], &u.y[to..to + len]);
        let (fx, fy) = (&mut spring.x[from..from + len], &mut spring.y[from..from + len]);
        for k in 0..len {
            [fx[k], fy[k]] = bond.force([vx[k] - ux[k], vy[k] - uy[k]], epsilon);
        }
        if let Some(i) = end {
            let b = here + i;
            [spring.x[b], spring.y[b]] = match lattice.neighbour(i, j, bond.offset) {
                Some(n) => bond.force([u.x[n] - u.x[b], u.y[n] - u.y[b]], epsilon),
                None => [0.0, 0.0],
            };
        }
    }
}

/// Adds the two springs of every block along each of two bonds: its own, less that of the block behind it.
fn add_spring_pairs(lattice: &Lattice, total: &mut [f64], springs: [(&[f64], [isize; 2]); 2]) {
    let nx = lattice.nx;
    for j in 0..lattice.ny {
        let start = lattice.row(j).start;
        let behind =
            springs.map(|(_, [di, dj])| Some(lattice.row(lattice.row_beside(j, -dj)?).start as isize - di));
        // Blocks inside the row stand beside one stretch of each row behind; the others are looked up.
        let inside = match behind {
            [Some(one), Some(other)] if nx > 2 => {
                let stretch = |spring: usize, from: usize| &springs[spring].0[from..from + nx - 2];
                let (a, b) = (stretch(0, start + 1), stretch(0, (one + 1) as usize));
                let (c, d) = (stretch(1, start + 1), stretch(1, (other + 1) as usize));
                for (k, total) in total[start + 1..start + nx - 1].iter_mut().enumerate() {
                    *total += (a[k] - b[k]) + (c[k] - d[k]);
                }
                1..nx - 1
            }
            _ => 0..0,
        };
        let pair = |(spring, [di, dj]): (&[f64], [isize; 2]), i: usize| {
            spring[start + i] - lattice.neighbour(i, j, [-di, -dj]).map_or(0.0, |b| spring[b])
        };
        for i in (0..inside.start).chain(inside.end..nx) {
            total[start + i] += pair(springs[0], i) + pair(springs[1], i);
        }
    }
}

/// Eqs. 4-7: friction and damping, and the velocity half a step later.
fn friction_forces<L: Law>(
    law: &L,
    model: &Model,
    state: &State,
    integrator: &Integrator,
    forces: &mut Forces,
) {
    let surface = &model.surface;
    for b in 0..state.contact.len() {
        let update = law.update(
            &friction::Block {
                velocity: state.velocity.at(b),
                contact: state.contact[b],
                force: add(forces.drive.at(b), forces.lattice.at(b)),
                hold: surface.hold[b],
                slide: surface.slide[b],
            },
            integrator,
        );
        [forces.friction.x[b], forces.friction.y[b]] = update.friction;
        [forces.velocity_after.x[b], forces.velocity_after.y[b]] = update.velocity;
        forces.contact_after[b] = update.contact;
    }
}
