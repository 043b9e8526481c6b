//! Thresholds that change during a run, by the options of Coulomb's law.

use std::ops::Range;

use fearless_simd::{Select, Simd, SimdBase, SimdFloat};

use super::aligned::Aligned;
use super::step::Step;
use super::vector::{Chunks, ChunksMut, LANES, is_zero, load, load_vec2, splat, square};

/// Thresholds of the elements of a band at the latest sweep, where they change.
#[derive(Debug)]
pub struct Thresholds {
    /// Kinetic impulses at the present speed or slip.
    kinetic_impulses: Aligned,
    state: Changing,
}

/// Law by which thresholds change.
#[derive(Clone, Copy, Debug)]
pub enum ChangingLaw {
    /// Kinetic friction falls with speed.
    Speed(FallWithSpeed),
    /// Strength falls with slip.
    Slip(FallWithSlip),
}

/// Kinetic friction that falls with speed, while adhesion does not: `K - s (K - tau l^2)` with the share
/// `s = (1 - ratio) |v|/(v_c + |v|)`.
#[derive(Clone, Copy, Debug)]
pub struct FallWithSpeed {
    /// Speed `v_c` at which half of the fall is reached.
    pub critical_speed: f64,
    /// Kinetic friction at high speed over that at rest.
    pub ratio: f64,
    /// Adhesion `tau l^2` of a block.
    pub adhesion: f64,
}

/// Strength that falls linearly: after a slip `s` since it last had its full strength, a block bears
///
/// ```text
/// f(s) = K + (S - K) max(0, 1 - s/D_c)
/// ```
///
/// while it slides or is about to, with its full static and kinetic thresholds `S` and `K`. Where `K >= S`
/// strength does not fall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallWithSlip {
    /// Slip `D_c` over which strength falls, in units of `P mu_s l^2/(E h)`.
    pub length: f64,
    /// Time t* after which a stuck block has its full strength again; if there is none, no block heals.
    pub healing_time: Option<f64>,
}

impl FallWithSlip {
    /// Share of the fall of strength that is left after a slip, `max(0, 1 - s/D_c)`.
    ///
    /// ```
    /// let law = slipfront_kernel::FallWithSlip { length: 0.5, healing_time: None };
    /// assert_eq!([0.0, 0.25, 0.5, 2.0].map(|slip| law.share_left(slip)), [1.0, 0.5, 0.0, 0.0]);
    /// ```
    #[inline(always)]
    pub fn share_left(&self, slip: f64) -> f64 {
        (1.0 - slip * (1.0 / self.length)).max(0.0)
    }

    /// Share of the largest weakening energy, `(S - K) D_c/2`, that has been lost after a slip:
    ///
    /// ```text
    /// 1 - max(0, 1 - s/D_c)^2
    /// ```
    ///
    /// ```
    /// let law = slipfront_kernel::FallWithSlip { length: 0.5, healing_time: None };
    /// assert_eq!([0.0, 0.25, 0.5, 2.0].map(|slip| law.share_lost(slip)), [0.0, 0.75, 1.0, 1.0]);
    /// ```
    #[inline(always)]
    pub fn share_lost(&self, slip: f64) -> f64 {
        let left = self.share_left(slip);
        1.0 - left * left
    }

    /// Energy that weakening has dissipated in a block with a fall of strength of `drop = max(S - K, 0)`, the
    /// integral of `f - K` over its slip:
    ///
    /// ```text
    /// Phi = (S - K) D_c/2 (share lost by the present slip + shares lost before it healed)
    /// ```
    pub fn energy(&self, drop: f64, slip: f64, lost_before: f64) -> f64 {
        0.5 * drop * self.length * (lost_before + self.share_lost(slip))
    }

    /// Whether a stuck block that last moved at `moved_at` has its full strength again at `time_star`.
    #[inline(always)]
    pub fn heals(&self, moved_at: f64, time_star: f64) -> bool {
        self.healing_time
            .is_some_and(|healing_time| time_star - moved_at >= healing_time)
    }
}

/// State of the elements under a law that changes their thresholds.
#[derive(Debug)]
enum Changing {
    Speed(FallWithSpeed),
    Slip(Slipped),
}

/// Slip of the elements, with the memory of the law.
#[derive(Debug)]
struct Slipped {
    law: FallWithSlip,
    /// Kinetic impulses of the strength that falls with slip.
    drops: Aligned,
    slip: Aligned,
    /// t* of the last motion of an element, and the shares that it lost before it healed; present only with
    /// healing.
    healing: Option<[Aligned; 2]>,
}

impl Thresholds {
    /// Thresholds of elements that have not slipped.
    pub(crate) fn new(law: ChangingLaw, n_elements: usize) -> Self {
        let zeros = || Aligned::filled(n_elements, 0.0);
        let state = match law {
            ChangingLaw::Speed(law) => Changing::Speed(law),
            ChangingLaw::Slip(law) => Changing::Slip(Slipped {
                law,
                drops: zeros(),
                slip: zeros(),
                healing: law.healing_time.map(|_| [zeros(), zeros()]),
            }),
        };
        Self {
            kinetic_impulses: Aligned::filled(n_elements, f64::INFINITY),
            state,
        }
    }

    /// Whether both thresholds of a block are its strength at its present slip.
    pub(crate) fn follow_slip(&self) -> bool {
        matches!(self.state, Changing::Slip(_))
    }

    /// Sets the largest fall of friction of an element, as an impulse, from the threshold at which the
    /// element first slips.
    pub(crate) fn set_drop(&mut self, k: usize, impulse: f64) {
        if let Changing::Slip(slipped) = &mut self.state {
            slipped.drops[k] = impulse;
        }
    }

    /// Finds the kinetic impulses of all elements at their slip, from those at rest, before the first sweep.
    pub(crate) fn begin(&mut self, at_rest: &[f64]) {
        if let Changing::Slip(Slipped { law, drops, slip, .. }) = &self.state {
            for (k, impulse) in self.kinetic_impulses.iter_mut().enumerate() {
                *impulse = at_rest[k] + drops[k] * law.share_left(slip[k]);
            }
        }
    }

    /// Finds the kinetic impulses of some elements, which have moved at these velocities in the step that
    /// ends now, from the impulses of slow sliding without slip. If friction depends on speed, the inverse
    /// masses of the blocks are used.
    #[inline(always)]
    pub(crate) fn update<S: Simd>(
        &mut self,
        simd: S,
        step: &Step,
        elements: &Range<usize>,
        velocity: [Chunks; 2],
        (at_rest, inverse_mass): (Chunks, Chunks),
    ) {
        let impulses = self.kinetic_impulses[elements.clone()].as_chunks_mut().0;
        match &mut self.state {
            Changing::Speed(law) => {
                let adhesive = step.integrator.force_to_velocity * law.adhesion;
                let at_rest = (at_rest, inverse_mass, adhesive);
                weaken(simd, law, velocity, at_rest, impulses);
            }
            Changing::Slip(slipped) => slipped.weaken(simd, step, elements, velocity, at_rest, impulses),
        }
    }

    /// Kinetic impulses of some elements at the latest sweep.
    #[inline(always)]
    pub(crate) fn kinetic_impulses(&self, elements: Range<usize>) -> Chunks<'_> {
        self.kinetic_impulses[elements].as_chunks().0
    }

    /// Kinetic impulse of an element at the latest sweep.
    pub(crate) fn kinetic_impulse(&self, k: usize) -> f64 {
        self.kinetic_impulses[k]
    }

    /// A column of a checkpoint, to be filled.
    pub fn column_mut(&mut self, column: usize) -> Option<&mut [f64]> {
        let Changing::Slip(Slipped { slip, healing, .. }) = &mut self.state else {
            return None;
        };
        match (column, healing) {
            (0, _) => Some(&mut slip[..]),
            (column, Some(healing)) => Some(&mut healing[column - 1][..]),
            (_, None) => None,
        }
    }

    /// Value of an element in a column of a checkpoint at t*; the element moves or is stuck. For an element
    /// that has healed since it was last swept, this is the value that its next sweep will find.
    pub fn memory(&self, column: usize, k: usize, is_moving: bool, time_star: f64) -> f64 {
        let Changing::Slip(Slipped {
            law, slip, healing, ..
        }) = &self.state
        else {
            return f64::NAN;
        };
        let slip = slip[k];
        let Some([moved_at, lost_before]) = healing else {
            return slip;
        };
        // Blocks at rest are not swept, so that their healing is not recorded. This finds in advance the
        // result of their next sweep.
        let heals = !is_moving && law.heals(moved_at[k], time_star);
        match column {
            0 if heals => 0.0,
            0 => slip,
            1 => moved_at[k],
            _ if heals => lost_before[k] + law.share_lost(slip),
            _ => lost_before[k],
        }
    }
}

impl Slipped {
    /// Kinetic impulses at the slip of some elements: the operations of [`FallWithSlip::share_left`], eight
    /// elements at a time.
    #[inline(always)]
    fn weaken<S: Simd>(
        &mut self,
        simd: S,
        step: &Step,
        elements: &Range<usize>,
        [vx, vy]: [Chunks; 2],
        at_rest: Chunks,
        weakened: ChunksMut,
    ) {
        let n = weakened.len();
        let (vx, vy, at_rest) = (&vx[..n], &vy[..n], &at_rest[..n]);
        let drops = &self.drops[elements.clone()].as_chunks::<LANES>().0[..n];
        let slip = &mut self.slip[elements.clone()].as_chunks_mut::<LANES>().0[..n];
        let dt = splat(simd, step.move_dt);
        for (c, slip) in slip.iter_mut().enumerate() {
            let speed = square(load_vec2(simd, [vx, vy], c)).sqrt();
            (load(simd, slip) + dt * speed).store_array(slip);
        }
        let [one, zero] = [1.0, 0.0].map(|number| splat(simd, number));
        let per_length = splat(simd, 1.0 / self.law.length);
        if let (Some([moved_at, lost_before]), Some(healing_time)) =
            (&mut self.healing, self.law.healing_time)
        {
            let moved_at = &mut moved_at[elements.clone()].as_chunks_mut::<LANES>().0[..n];
            let lost_before = &mut lost_before[elements.clone()].as_chunks_mut::<LANES>().0[..n];
            let [now, healing_time] = [step.time_star(), healing_time].map(|time| splat(simd, time));
            for c in 0..n {
                let is_stuck = is_zero(simd, load_vec2(simd, [vx, vy], c));
                let moved = is_stuck.select(load(simd, &moved_at[c]), now);
                moved.store_array(&mut moved_at[c]);
                let heals = is_stuck & (now - moved).simd_ge(healing_time);
                let left = (one - load(simd, &slip[c]) * per_length).max(zero);
                // Strength falls linearly with slip, so that the work that is left is proportional to the
                // square of the fall that is left.
                let lost = heals.select(one - left * left, zero);
                (load(simd, &lost_before[c]) + lost).store_array(&mut lost_before[c]);
                heals.select(zero, load(simd, &slip[c])).store_array(&mut slip[c]);
            }
        }
        // After healing, which may have set the slip to zero.
        for c in 0..n {
            let left = (one - load(simd, &slip[c]) * per_length).max(zero);
            (load(simd, &at_rest[c]) + load(simd, &drops[c]) * left).store_array(&mut weakened[c]);
        }
    }
}

/// Kinetic impulses at these velocities, from the impulses of slow sliding, by [`FallWithSpeed`]. `adhesive`
/// is the impulse of adhesion on a block of mass 1. Elements that are no blocks have infinite impulses, which
/// become NaN and also keep them at rest.
#[inline(always)]
fn weaken<S: Simd>(
    simd: S,
    law: &FallWithSpeed,
    [vx, vy]: [Chunks; 2],
    (impulses, inverse_mass, adhesive): (Chunks, Chunks, f64),
    weakened: ChunksMut,
) {
    let n = weakened.len();
    let (vx, vy, impulses, inverse_mass) = (&vx[..n], &vy[..n], &impulses[..n], &inverse_mass[..n]);
    let [adhesive, zero] = [adhesive, 0.0].map(|number| splat(simd, number));
    let fall = splat(simd, 1.0 - law.ratio);
    let critical_speed = splat(simd, law.critical_speed);
    for c in 0..n {
        let speed = square(load_vec2(simd, [vx, vy], c)).sqrt();
        let lost = fall * (speed / (critical_speed + speed));
        let at_rest = load(simd, &impulses[c]);
        let of_load = (at_rest - adhesive * load(simd, &inverse_mass[c])).max(zero);
        (at_rest - lost * of_load).store_array(&mut weakened[c]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The work of the fall up to a slip is the area between the strength and its level there, and all of it
    /// is done after the length of the fall.
    #[test]
    fn the_work_of_the_fall_is_the_area_below_it() {
        let law = FallWithSlip {
            length: 0.4,
            healing_time: None,
        };
        for slip in [0.0, 0.1, 0.25, 0.4, 3.0] {
            // The area of the trapezium between no slip and this one, over that of the whole triangle.
            let slipped = f64::min(slip, law.length);
            let area = 0.5 * (1.0 + law.share_left(slip)) * slipped;
            // Rounding of a few operations.
            assert!((law.share_lost(slip) - 2.0 * area / law.length).abs() < 1e-15);
        }
        assert_eq!((law.share_lost(0.1), law.share_left(0.1)), (0.4375, 0.75));
    }
}
