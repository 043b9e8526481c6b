//! Thresholds that change during a run, by the options of Coulomb's law.

use std::ops::Range;

use fearless_simd::{Select, Simd, SimdBase, SimdFloat};

use super::aligned::Aligned;
use super::step::Step;
use super::vector::{Chunks, ChunksMut, LANES, is_zero, load, load_vec2, splat, square};
use crate::friction::{SlipWeakening, Weakening};
use crate::model::Model;

/// Thresholds of the elements of a band at the latest sweep, where they change.
#[derive(Debug)]
pub(super) struct Thresholds {
    /// Kinetic impulses at the present speed or slip.
    kinetic_impulses: Aligned,
    law: ChangingLaw,
}

/// Law by which thresholds change.
#[derive(Debug)]
enum ChangingLaw {
    /// Kinetic friction falls with speed; adhesion does not.
    Speed { weakening: Weakening, adhesion: f64 },
    /// Strength falls with slip.
    Slip(Slipped),
}

/// Slip of the elements, with the memory of the law.
#[derive(Debug)]
struct Slipped {
    law: SlipWeakening,
    /// Kinetic impulses of the strength that falls with slip.
    drops: Aligned,
    slip: Aligned,
    /// t* of the last motion of an element, and the shares that it lost before it healed; present only with
    /// healing.
    healing: Option<[Aligned; 2]>,
}

impl Thresholds {
    /// Thresholds of a model in which they change; none for other models.
    pub(super) fn of(model: &Model, n_elements: usize) -> Option<Self> {
        let coulomb = model.friction.coulomb()?;
        let zeros = || Aligned::filled(n_elements, 0.0);
        let law = match (coulomb.weakening, coulomb.slip_weakening) {
            (Some(weakening), _) => ChangingLaw::Speed {
                weakening,
                adhesion: model.surface.adhesion().of_kinetic,
            },
            (None, Some(law)) => ChangingLaw::Slip(Slipped {
                law,
                drops: zeros(),
                slip: zeros(),
                healing: law.healing_time.map(|_| [zeros(), zeros()]),
            }),
            (None, None) => return None,
        };
        Some(Self {
            kinetic_impulses: Aligned::filled(n_elements, f64::INFINITY),
            law,
        })
    }

    /// Whether both thresholds of a block are its strength at its present slip.
    pub(super) fn follow_slip(&self) -> bool {
        matches!(self.law, ChangingLaw::Slip(_))
    }

    /// Sets the largest fall of friction of an element, as an impulse, from the threshold at which the
    /// element first slips.
    pub(super) fn set_drop(&mut self, k: usize, impulse: f64) {
        if let ChangingLaw::Slip(slipped) = &mut self.law {
            slipped.drops[k] = impulse;
        }
    }

    /// Finds the kinetic impulses of all elements at their slip, from those at rest, before the first sweep.
    pub(super) fn begin(&mut self, at_rest: &[f64]) {
        if let ChangingLaw::Slip(Slipped { law, drops, slip, .. }) = &self.law {
            for (k, impulse) in self.kinetic_impulses.iter_mut().enumerate() {
                *impulse = at_rest[k] + drops[k] * law.share_left(slip[k]);
            }
        }
    }

    /// Finds the kinetic impulses of some elements, which have moved at these velocities in the step that
    /// ends now, from the impulses of slow sliding without slip. If friction depends on speed, the inverse
    /// masses of the blocks are used.
    #[inline(always)]
    pub(super) fn update<S: Simd>(
        &mut self,
        simd: S,
        step: &Step,
        elements: &Range<usize>,
        velocity: [Chunks; 2],
        (at_rest, inverse_mass): (Chunks, Chunks),
    ) {
        let impulses = self.kinetic_impulses[elements.clone()].as_chunks_mut().0;
        match &mut self.law {
            ChangingLaw::Speed { weakening, adhesion } => {
                let adhesive = step.integrator.force_to_velocity * *adhesion;
                let at_rest = (at_rest, inverse_mass, adhesive);
                weaken(simd, weakening, velocity, at_rest, impulses);
            }
            ChangingLaw::Slip(slipped) => slipped.weaken(simd, step, elements, velocity, at_rest, impulses),
        }
    }

    /// Kinetic impulses of some elements at the latest sweep.
    #[inline(always)]
    pub(super) fn kinetic_impulses(&self, elements: Range<usize>) -> Chunks<'_> {
        self.kinetic_impulses[elements].as_chunks().0
    }

    /// Kinetic impulse of an element at the latest sweep.
    pub(super) fn kinetic_impulse(&self, k: usize) -> f64 {
        self.kinetic_impulses[k]
    }

    /// A column of a checkpoint, to be filled.
    pub(super) fn column_mut(&mut self, column: usize) -> Option<&mut [f64]> {
        let ChangingLaw::Slip(Slipped { slip, healing, .. }) = &mut self.law else {
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
    pub(super) fn memory(&self, column: usize, k: usize, is_moving: bool, time_star: f64) -> f64 {
        let ChangingLaw::Slip(Slipped {
            law, slip, healing, ..
        }) = &self.law
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
    /// Kinetic impulses at the slip of some elements: the operations of [`SlipWeakening::share_left`], eight
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

/// Kinetic impulses at these velocities, from the impulses of slow sliding: the operations of
/// [`Weakening::kinetic_force`]. `adhesive` is the impulse of adhesion on a block of mass 1. Elements that
/// are no blocks have infinite impulses, which become NaN and also keep them at rest.
#[inline(always)]
fn weaken<S: Simd>(
    simd: S,
    weakening: &Weakening,
    [vx, vy]: [Chunks; 2],
    (impulses, inverse_mass, adhesive): (Chunks, Chunks, f64),
    weakened: ChunksMut,
) {
    let n = weakened.len();
    let (vx, vy, impulses, inverse_mass) = (&vx[..n], &vy[..n], &impulses[..n], &inverse_mass[..n]);
    let [adhesive, zero] = [adhesive, 0.0].map(|number| splat(simd, number));
    let fall = splat(simd, 1.0 - weakening.ratio);
    let critical_speed = splat(simd, weakening.critical_speed);
    for c in 0..n {
        let speed = square(load_vec2(simd, [vx, vy], c)).sqrt();
        let lost = fall * (speed / (critical_speed + speed));
        let at_rest = load(simd, &impulses[c]);
        let of_load = (at_rest - adhesive * load(simd, &inverse_mass[c])).max(zero);
        (at_rest - lost * of_load).store_array(&mut weakened[c]);
    }
}
