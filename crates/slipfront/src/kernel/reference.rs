//! The reference kernel: one pass over the blocks per equation, to be read beside the paper.
//!
//! [`evaluate`] computes what happens at t_n (Eqs. 2-7), [`advance`] moves on to t_n+1 (Eq. 8). Opposite
//! neighbours are summed in pairs, straight ones before diagonal ones, so that a quarter turn or a mirror of
//! the whole problem mirrors the trajectory to the last bit.

use super::Forces;
use crate::friction::{self, Integrator, Law};
use crate::lattice::Bond;
use crate::width::widest;
use crate::{Contact, Edges, FrictionLaw, Lattice, Model, State, VectorField};

/// Forces on every block at `time_star`, and what friction makes of them over the coming step `dt_star`.
pub fn evaluate(model: &Model, state: &State, time_star: f64, dt_star: f64, forces: &mut Forces) {
    widest!(evaluate_at_any_width(model: &Model, state: &State, time_star: f64, dt_star: f64, forces: &mut Forces) -> ());
}

#[inline(always)]
fn evaluate_at_any_width(model: &Model, state: &State, time_star: f64, dt_star: f64, forces: &mut Forces) {
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
    widest!(move_blocks(state: &mut State, dt_star: f64) -> ());
}

#[inline(always)]
fn move_blocks(state: &mut State, dt_star: f64) {
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
#[inline(always)]
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
#[inline(always)]
fn lattice_forces(model: &Model, state: &State, force: &mut VectorField, springs: &mut [VectorField; 4]) {
    let lattice = &model.lattice;
    for (bond, spring) in Bond::ALL.iter().zip(springs.iter_mut()) {
        spring_forces(lattice, bond, &state.displacement, model.epsilon, spring);
    }
    let [x, y] = [&*springs; 2];
    sum_springs(
        lattice,
        x.each_ref().map(|spring| spring.x.as_slice()),
        &mut force.x,
    );
    sum_springs(
        lattice,
        y.each_ref().map(|spring| spring.y.as_slice()),
        &mut force.y,
    );
}

/// Force on every block from its spring along `bond`; zero where a free edge leaves it out.
#[inline(always)]
fn spring_forces(lattice: &Lattice, bond: &Bond, u: &VectorField, epsilon: f64, spring: &mut VectorField) {
    // Seen as one long row, the neighbour of every block stands equally far on: one loop without ends. Where the
    // row of the lattice ended meanwhile, what it gives is replaced.
    let shift = lattice.shift(bond).min(lattice.n_blocks());
    let n = lattice.n_blocks() - shift;
    pull(
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

/// Forces of one bond on the blocks at `u` from those at `v`.
#[inline(always)]
fn pull(bond: &Bond, epsilon: f64, u: [&[f64]; 2], v: [&[f64]; 2], force: [&mut [f64]; 2]) {
    let [fx, fy] = force;
    let n = fx.len();
    let (ux, uy, vx, vy, fy) = (&u[0][..n], &u[1][..n], &v[0][..n], &v[1][..n], &mut fy[..n]);
    for k in 0..n {
        [fx[k], fy[k]] = bond.force([vx[k] - ux[k], vy[k] - uy[k]], epsilon);
    }
}

/// Adds the eight springs of every block: along each bond its own, less that of the block behind it.
#[inline(always)]
fn sum_springs(lattice: &Lattice, springs: [&[f64]; 4], total: &mut [f64]) {
    // One long row again, from the first block that has all blocks behind it.
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
    // Free edges have springs of force zero, which the long row finds where a row ended; periodic ones wrap.
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

/// Eqs. 4-7: friction and damping, and the velocity half a step later.
#[inline(always)]
fn friction_forces<L: Law>(
    law: &L,
    model: &Model,
    state: &State,
    integrator: &Integrator,
    forces: &mut Forces,
) {
    let surface = &model.surface;
    let Forces {
        drive,
        lattice,
        friction,
        velocity_after,
        contact_after,
        ..
    } = forces;
    rub(
        law,
        integrator,
        [&surface.hold, &surface.slide],
        [&state.velocity.x, &state.velocity.y],
        [&drive.x, &drive.y, &lattice.x, &lattice.y],
        [&mut friction.x, &mut friction.y],
        [&mut velocity_after.x, &mut velocity_after.y],
        contact_after,
    );
}

/// The friction law on every block: thresholds, velocities and forces in; friction, velocities and contact out.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // One slice per array, known not to overlap: the loop is free of checks.
fn rub<L: Law>(
    law: &L,
    integrator: &Integrator,
    thresholds: [&[f64]; 2],
    velocity: [&[f64]; 2],
    forces: [&[f64]; 4],
    friction: [&mut [f64]; 2],
    after: [&mut [f64]; 2],
    contact: &mut [Contact],
) {
    let n = contact.len();
    let [hold, slide] = thresholds.map(|array| &array[..n]);
    let [vx, vy] = velocity.map(|array| &array[..n]);
    let [drive_x, drive_y, lattice_x, lattice_y] = forces.map(|array| &array[..n]);
    let [friction_x, friction_y] = friction.map(|array| &mut array[..n]);
    let [after_x, after_y] = after.map(|array| &mut array[..n]);
    for b in 0..n {
        let update = law.update(
            &friction::Block {
                velocity: [vx[b], vy[b]],
                force: [drive_x[b] + lattice_x[b], drive_y[b] + lattice_y[b]],
                hold: hold[b],
                slide: slide[b],
            },
            integrator,
        );
        [friction_x[b], friction_y[b]] = update.friction;
        [after_x[b], after_y[b]] = update.velocity;
        contact[b] = update.contact;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Coefficients, Distribution, Load};
    use crate::{Drive, Edges, Simulation, Surface};

    /// The same bits whether the loops were compiled for the widest registers at hand or for the plainest.
    #[test]
    fn bits_do_not_depend_on_the_width() {
        let spread = Distribution {
            mean: 1.0,
            deviation: 0.3,
        };
        for (nx, ny, edges) in [
            (13, 11, Edges::Free),
            (9, 16, Edges::Periodic),
            (1, 20, Edges::Free),
        ] {
            let lattice = Lattice::with_edges(nx, ny, [edges; 2]);
            let n = lattice.n_blocks();
            let drawn = Coefficients::draw(
                n,
                spread,
                Distribution {
                    mean: 0.5,
                    deviation: 0.1,
                },
                5,
            );
            let surface = Surface::new(drawn, vec![false; n], Load::Redistributed, 1.0).unwrap();
            let drive = Drive::at_angle(0.05, 20.0);
            let model = Model::new(lattice, surface, drive, 0.1, 1e-3, FrictionLaw::Projection);
            let mut simulation = Simulation::at_rest(&model, 0.1);
            // Through the onset, where blocks stick and slip at once.
            for _ in 0..600 {
                simulation.step();
            }
            let (state, time) = (simulation.state(), simulation.time_star());
            let (mut wide, mut plain) = (Forces::zeros(n), Forces::zeros(n));
            evaluate(&model, state, time, 0.1, &mut wide);
            evaluate_at_any_width(&model, state, time, 0.1, &mut plain);
            assert!(wide.contact_after.contains(&Contact::Sliding));
            assert_eq!(wide, plain);
        }
    }
}
