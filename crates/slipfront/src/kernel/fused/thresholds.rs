//! Thresholds that change within a run, as options of Coulomb's law say.

use std::ops::Range;

use fearless_simd::{Simd, SimdBase, SimdFloat};

use super::aligned::Aligned;
use super::vector::{Chunks, ChunksMut, load, load_vec2, splat, square};
use crate::friction::Weakening;
use crate::model::Model;

/// Thresholds of the elements of a band at the latest sweep, where they change.
#[derive(Debug)]
pub(super) struct Thresholds {
    /// Kinetic impulses: those of slow sliding, weakened by speed.
    kinetic_impulses: Aligned,
    weakening: Option<Weakening>,
    /// Kinetic adhesion, which does not weaken.
    adhesion: f64,
}

impl Thresholds {
    pub(super) fn new(model: &Model, n_elements: usize) -> Self {
        Self {
            kinetic_impulses: Aligned::filled(n_elements, f64::INFINITY),
            weakening: model.friction.coulomb().and_then(|law| law.weakening),
            adhesion: model.surface.adhesion().of_kinetic,
        }
    }

    /// Finds the kinetic impulses of some elements at these velocities, from those of slow sliding on blocks with these inverse masses.
    #[inline(always)]
    pub(super) fn update<S: Simd>(
        &mut self,
        simd: S,
        elements: &Range<usize>,
        velocity: [Chunks; 2],
        (at_rest, inverse_mass): (Chunks, Chunks),
        force_to_velocity: f64,
    ) {
        if let Some(weakening) = &self.weakening {
            let weakened = self.kinetic_impulses[elements.clone()].as_chunks_mut().0;
            let at_rest = (at_rest, inverse_mass, force_to_velocity * self.adhesion);
            weaken(simd, weakening, velocity, at_rest, weakened);
        }
    }

    /// Kinetic impulses of some elements at the latest sweep, from those of slow sliding.
    #[inline(always)]
    pub(super) fn kinetic_impulses<'a>(&'a self, elements: Range<usize>, at_rest: Chunks<'a>) -> Chunks<'a> {
        match self.weakening {
            Some(_) => self.kinetic_impulses[elements].as_chunks().0,
            None => at_rest,
        }
    }

    /// Kinetic impulse of an element at the latest sweep, if it is not that of slow sliding.
    pub(super) fn changed_impulse(&self, k: usize) -> Option<f64> {
        self.weakening.is_some().then(|| self.kinetic_impulses[k])
    }
}

/// Kinetic impulses at these velocities, from those of slow sliding: the operations of [`Weakening::kinetic_force`]. `adhesive` is
/// the impulse of adhesion on a block of mass 1. What is no block has an infinite impulse, which becomes no number, and moves as
/// little.
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
