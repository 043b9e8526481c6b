//! The pull of the drive, with the dead load, or of the sheet above, on blocks.

use fearless_simd::{Simd, f64x8};

use super::step::Step;
use super::vector::{Chunks, Vec2x8, add, load_vec2, scale, splat, subtract};

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

/// Blocks of the sheet above some blocks; none where the drive springs pull these blocks.
#[derive(Clone, Copy, Default)]
pub(crate) struct Above<'a> {
    /// Stiffness `g` of the springs to them.
    pub(crate) coupling: f64,
    pub(crate) displacement: [Chunks<'a>; 2],
}

impl Above<'_> {
    /// The first `n` vectors, if there are any.
    #[inline(always)]
    pub(crate) fn first<const HAS_ABOVE: bool>(self, n: usize) -> Self {
        let n = if HAS_ABOVE { n } else { 0 };
        let [x, y] = self.displacement;
        Self {
            displacement: [&x[..n], &y[..n]],
            ..self
        }
    }
}

/// Force from above on eight blocks at displacement `u`: from the springs to the sheet there,
/// `g (u_k+1 - u_k)`, or from the drive springs (Eq. 2), with the dead load.
#[inline(always)]
pub(crate) fn pull_from_above<S: Simd, const HAS_ABOVE: bool>(
    simd: S,
    step: Step,
    above: Above,
    chunk: usize,
    u: Vec2x8<S>,
) -> Vec2x8<S> {
    if HAS_ABOVE {
        coupling_force(
            simd,
            above.coupling,
            load_vec2(simd, above.displacement, chunk),
            u,
        )
    } else {
        pull(simd, step, u)
    }
}

/// Force of springs of the given stiffness between blocks and those above them.
#[inline(always)]
pub(crate) fn coupling_force<S: Simd>(
    simd: S,
    coupling: f64,
    above: Vec2x8<S>,
    below: Vec2x8<S>,
) -> Vec2x8<S> {
    scale(splat(simd, coupling), subtract(above, below))
}
