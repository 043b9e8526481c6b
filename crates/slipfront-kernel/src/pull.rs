//! The pull of the drive, with the dead load, on blocks.

use fearless_simd::{Simd, f64x8};

use super::step::Step;
use super::vector::{Vec2x8, add, scale, splat, subtract};

/// Force of the drive springs (Eq. 2), `F_s = k_s (V t - u)`, with the dead load, on equal blocks.
#[inline(always)]
pub(crate) fn pull<S: Simd>(simd: S, step: Step, u: Vec2x8<S>) -> Vec2x8<S> {
    add(pull_of_springs(simd, step, u), dead_load(simd, step))
}

/// Force of the drive springs (Eq. 2), `F_s = k_s,i (V t - u)`, with the dead load, on blocks that differ,
/// given the relative stiffness of their drive springs, and their loads unless these are equal.
#[inline(always)]
pub(crate) fn pull_of_differing<S: Simd>(
    simd: S,
    step: Step,
    drive_springs: f64x8<S>,
    loads: Option<f64x8<S>>,
    u: Vec2x8<S>,
) -> Vec2x8<S> {
    let mut dead = dead_load(simd, step);
    if let Some(loads) = loads {
        dead = scale(loads, dead);
    }
    add(scale(drive_springs, pull_of_springs(simd, step, u)), dead)
}

#[inline(always)]
fn pull_of_springs<S: Simd>(simd: S, step: Step, u: Vec2x8<S>) -> Vec2x8<S> {
    let [x, y] = step.drive_position;
    let stretch = subtract([splat(simd, x), splat(simd, y)], u);
    scale(splat(simd, step.k_drive), stretch)
}

#[inline(always)]
fn dead_load<S: Simd>(simd: S, step: Step) -> Vec2x8<S> {
    step.dead_load.map(|force| splat(simd, force))
}
