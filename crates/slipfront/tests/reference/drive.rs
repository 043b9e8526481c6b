//! The drive: springs with far ends that move along a path X(t) (Eq. 2); and the dead load.

use slipfront::Model;

use super::lattice::{exists, place};
use super::vector::{Vector, difference, left_of, length, sum, times};

/// Path X of the far ends at `time`: `V t`, or the sum over the segments of a program.
pub(crate) fn path(model: &Model, time: f64) -> f64 {
    let Some(program) = &model.drive.program else {
        return model.drive.v_star * time;
    };
    let segments = program.segments();
    let mut path = 0.0;
    for (n, segment) in segments.iter().enumerate() {
        let end = segments.get(n + 1).map_or(time, |next| next.from_star.min(time));
        path += segment.v_star * (end - segment.from_star).max(0.0);
    }
    path
}

/// Centroid of all existing blocks, the centre of a rotation.
fn middle(model: &Model) -> Vector {
    let (mut total, mut count) = ([0.0, 0.0], 0.0);
    for b in (0..model.lattice.n_blocks()).filter(|&b| exists(model, b)) {
        total = sum(total, place(model, b));
        count += 1.0;
    }
    [total[0] / count, total[1] / count]
}

/// Arms **r** of all blocks in a rotation, from its axis to their centres; 0 for missing blocks.
fn arms(model: &Model) -> Vec<Vector> {
    let axis = middle(model);
    let arm = |b| {
        if exists(model, b) {
            difference(place(model, b), axis)
        } else {
            [0.0, 0.0]
        }
    };
    (0..model.lattice.n_blocks()).map(arm).collect()
}

/// Directions **g** of the far ends over all blocks: **d** for a translation, `z x r/r_max` for a rotation.
pub(crate) fn directions(model: &Model) -> Vec<Vector> {
    if model.drive.rotation.is_none() {
        return vec![model.drive.direction; model.lattice.n_blocks()];
    }
    let arms = arms(model);
    let largest = arms.iter().map(|&arm| length(arm)).fold(0.0, f64::max);
    arms.iter()
        .map(|&arm| left_of(times(1.0 / largest, arm)))
        .collect()
}

/// Stiffness of the drive spring of block `b` over `k_s`; 0 if there is none.
fn relative_stiffness(model: &Model, b: usize) -> f64 {
    match &model.slider().drive_springs {
        _ if !exists(model, b) => 0.0,
        Some(springs) => springs.relative[b],
        None => 1.0,
    }
}

/// Stiffness `k_s,i` of the drive spring of block `b`.
pub(crate) fn stiffness(model: &Model, b: usize) -> f64 {
    model.drive.k_drive * relative_stiffness(model, b)
}

/// Force of the drive spring (Eq. 2): `F_s = k_s,i (X g_i - u_i)`.
pub(crate) fn spring_force(stiffness: f64, path: f64, direction: Vector, displacement: Vector) -> Vector {
    times(stiffness, difference(times(path, direction), displacement))
}

/// The dead load `F_0,i` on block `b`: the common force, times that of the block if these differ.
pub(crate) fn dead_load(model: &Model, b: usize) -> Vector {
    let load = model.dead_load();
    let relative = match &load.field {
        _ if !exists(model, b) => 0.0,
        Some(field) => field.relative[b],
        None => 1.0,
    };
    times(relative, load.force)
}
