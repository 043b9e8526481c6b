//! Coulomb's law for some of the blocks.

use std::ops::Range;

use super::law_readings::{BlockState, LawReading};
use crate::forces::{Forces, part, part_mut, values_of, values_of_mut};
use crate::state::State;
use slipfront_kernel::Integrator;

/// Applies the friction law to some blocks: finds friction, velocities and the blocks that slide from
/// thresholds, velocities and forces.
#[inline(always)]
pub(super) fn friction_forces<L: LawReading>(
    law: &L,
    integrator: impl Fn(usize) -> Integrator,
    blocks: &Range<usize>,
    thresholds: [&[f64]; 2],
    state: &State,
    forces: &mut Forces,
) {
    apply_friction(
        law,
        integrator,
        thresholds.map(|array| values_of(array, blocks)),
        part(&state.velocity, blocks),
        [part(&forces.drive, blocks), part(&forces.lattice, blocks)],
        part_mut(&mut forces.friction, blocks),
        part_mut(&mut forces.velocity, blocks),
        values_of_mut(&mut forces.slides, blocks),
    );
}

/// Applies the friction law to blocks that are given as separate slices.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // Separate slices are known not to overlap, so that the loop is vectorised.
fn apply_friction<L: LawReading>(
    law: &L,
    integrator: impl Fn(usize) -> Integrator,
    thresholds: [&[f64]; 2],
    velocity: [&[f64]; 2],
    forces: [[&[f64]; 2]; 2],
    friction: [&mut [f64]; 2],
    after: [&mut [f64]; 2],
    slides: &mut [bool],
) {
    let n = slides.len();
    let [static_limit, kinetic_force] = thresholds.map(|array| &array[..n]);
    let [vx, vy] = velocity.map(|array| &array[..n]);
    let [[drive_x, drive_y], [lattice_x, lattice_y]] = forces.map(|force| force.map(|array| &array[..n]));
    let [friction_x, friction_y] = friction.map(|array| &mut array[..n]);
    let [after_x, after_y] = after.map(|array| &mut array[..n]);
    for k in 0..n {
        let update = law.update(
            &BlockState {
                velocity: [vx[k], vy[k]],
                force: [drive_x[k] + lattice_x[k], drive_y[k] + lattice_y[k]],
                static_limit: static_limit[k],
                kinetic_force: kinetic_force[k],
            },
            &integrator(k),
        );
        [friction_x[k], friction_y[k]] = update.friction;
        [after_x[k], after_y[k]] = update.velocity;
        slides[k] = update.slides;
    }
}
