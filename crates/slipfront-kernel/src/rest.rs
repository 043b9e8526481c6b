//! Time for which blocks at rest will stay at rest.
//!
//! While a block and its neighbours are stuck, only the force of its drive spring grows, linearly:
//! `F(t) = F + k_s V t`, with the dead load in F. The block slips when `|F(t)|` exceeds its threshold
//! `T = max(mu_s, mu_k) F_n` (D12):
//!
//! ```text
//! c t^2 + 2 a t = T^2 - F^2,   a = F . k_s V,   c = (k_s V)^2
//! t = (sqrt(a^2 + c (T^2 - F^2)) - a)/c
//! ```

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, f64x8};

use super::pull::pull_of_differing;
use super::step::Step;
use super::vector::{Vec2x8, add, dot, lane_max, scale, splat, square};

/// Eight blocks with nothing moving in or around them.
pub(crate) struct RestingVector<S: Simd> {
    pub(crate) displacement: Vec2x8<S>,
    /// Lattice forces `F_c`.
    pub(crate) lattice: Vec2x8<S>,
    pub(crate) static_limit_square: f64x8<S>,
    pub(crate) kinetic_impulse: f64x8<S>,
    /// Relative stiffness of the drive springs, and masses, of a heterogeneous slider.
    pub(crate) variation: Option<[f64x8<S>; 2]>,
    /// Relative dead loads, where they differ.
    pub(crate) loads: Option<f64x8<S>>,
}

/// Number of steps from `step` until the first of the blocks can slip, or somewhat less.
///
/// For a drive at an angle it is zero if one component of the drive force on a block shrinks while the other
/// grows. Thus the contact stress of a skipped block is always largest at the first or at the last skipped
/// step.
#[inline(always)]
pub(crate) fn steps_until_slip<S: Simd>(simd: S, step: &Step, blocks: &RestingVector<S>) -> u64 {
    // The growth is valid until the speed of the drive changes next; callers look no further ahead.
    let [bx, by] = step.force_growth;
    let growth_square = bx * bx + by * by;
    // While the drive stands still nothing changes until a neighbour moves, which touches the vector.
    if growth_square == 0.0 {
        return u64::MAX;
    }
    let zero = splat(simd, 0.0);
    let one = splat(simd, 1.0);
    let [drive_spring, mass] = blocks.variation.unwrap_or([one; 2]);
    let growth = scale(drive_spring, [splat(simd, bx), splat(simd, by)]);
    let c = drive_spring * drive_spring * splat(simd, growth_square);
    let drive = pull_of_differing(simd, *step, drive_spring, blocks.loads, blocks.displacement);
    let force = add(drive, blocks.lattice);
    let velocity_to_force = mass * splat(simd, step.integrator.velocity_to_force);
    let kinetic_force = blocks.kinetic_impulse * velocity_to_force;
    // Where kinetic friction exceeds the static threshold, it holds the block beyond this threshold.
    let threshold_square = blocks.static_limit_square.max(kinetic_force * kinetic_force);
    let a = dot(force, growth);
    let room = threshold_square - square(force);
    let time = ((a * a + c * room).sqrt() - a) / c;
    let grows = if bx != 0.0 && by != 0.0 {
        (drive[0] * growth[0]).simd_ge(zero) & (drive[1] * growth[1]).simd_ge(zero)
    } else {
        room.simd_ge(zero)
    };
    // At the threshold, or if rounding makes the root NaN, the block may slip at once.
    let time = (grows & room.simd_ge(zero) & time.simd_ge(zero)).select(time, zero);
    // A block without drive spring waits for its neighbours.
    let waits = drive_spring.simd_eq(zero) & room.simd_gt(zero);
    let time = waits.select(splat(simd, f64::INFINITY), time);
    // Forces have rounding errors of some units in the last place. The result is shortened by the time in
    // which the load grows by this error, and by two steps for the rounding of the root and of the division.
    let distance = step.drive_position[0].abs() + step.drive_position[1].abs();
    let noise = 1e-13 * (1.0 + step.k_drive * distance) / growth_square.sqrt();
    let noise = waits.select(zero, splat(simd, noise) / drive_spring);
    let time = time * splat(simd, 1.0 - 1e-9) - noise;
    let soonest = -lane_max(-time);
    let steps = soonest / step.dt_star - 2.0;
    // The conversion saturates: at zero if negative, at the largest integer if too large.
    steps as u64
}
