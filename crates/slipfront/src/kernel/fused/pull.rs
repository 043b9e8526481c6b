//! The pull of the drive, or of the sheet above, on blocks.

use fearless_simd::Simd;

use super::step::Step;
use super::vector::{Chunks, Vec2x8, add, load_vec2, scale, splat, subtract};

/// Force of the drive springs (Eq. 2), `F_s = k_s (V t - u)`, with any constant force.
#[inline(always)]
pub(super) fn pull<S: Simd>(simd: S, step: Step, u: Vec2x8<S>) -> Vec2x8<S> {
    let ([x, y], [fx, fy]) = (step.drive_position, step.constant_force);
    let stretch = subtract([splat(simd, x), splat(simd, y)], u);
    add(
        scale(splat(simd, step.k_drive), stretch),
        [splat(simd, fx), splat(simd, fy)],
    )
}

/// Blocks of the sheet above some blocks; none where the drive springs pull these.
#[derive(Clone, Copy, Default)]
pub(super) struct Above<'a> {
    /// Stiffness `g` of the springs to them.
    pub(super) coupling: f64,
    pub(super) displacement: [Chunks<'a>; 2],
}

impl Above<'_> {
    /// The first `n` vectors, if there are any.
    #[inline(always)]
    pub(super) fn first<const HAS_ABOVE: bool>(self, n: usize) -> Self {
        let n = if HAS_ABOVE { n } else { 0 };
        let [x, y] = self.displacement;
        Self {
            displacement: [&x[..n], &y[..n]],
            ..self
        }
    }
}

/// Force from above on eight blocks at displacement `u`: of the springs to the sheet there,
/// `g (u_k+1 - u_k)`, or of the drive springs (Eq. 2), with any constant force.
#[inline(always)]
pub(super) fn pull_from_above<S: Simd, const HAS_ABOVE: bool>(
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

/// Force of springs of the given stiffness from blocks to those above them.
#[inline(always)]
pub(super) fn coupling_force<S: Simd>(
    simd: S,
    coupling: f64,
    above: Vec2x8<S>,
    below: Vec2x8<S>,
) -> Vec2x8<S> {
    scale(splat(simd, coupling), subtract(above, below))
}
