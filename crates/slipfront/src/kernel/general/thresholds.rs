//! Thresholds of Coulomb's law that follow speed and age.

use std::ops::Range;

use super::forces::{Forces, part};
use crate::friction::{Ageing, Coulomb, FrictionLaw, Weakening};
use crate::state::State;
use crate::surface::Adhesion;
use crate::vector_field::{VectorField, dot, length};

/// Coulomb's law, with thresholds at the present step where they are not those of the surface.
#[derive(Debug)]
pub(super) struct Thresholds {
    pub(super) law: FrictionLaw,
    weakened: Option<Weakened>,
    pub(super) aged: Option<Aged>,
}

/// Kinetic friction at the present speeds.
#[derive(Debug)]
pub(super) struct Weakened {
    law: Weakening,
    adhesion: f64,
    kinetic_force: Vec<f64>,
}

/// Static thresholds at the present ages.
#[derive(Debug)]
pub(super) struct Aged {
    law: Ageing,
    adhesion: f64,
    static_limit: Vec<f64>,
    /// Whose thresholds these ages raise.
    is_old: Vec<bool>,
    /// When a block that is stuck has stopped, t*. The memory of the law.
    pub(super) stopped_at: Vec<f64>,
}

impl Thresholds {
    pub(super) fn new(coulomb: &Coulomb, adhesion: Adhesion, n_blocks: usize) -> Self {
        let zeros = || vec![0.0; n_blocks];
        Self {
            law: coulomb.law,
            weakened: coulomb.weakening.map(|law| Weakened {
                law,
                adhesion: adhesion.of_kinetic,
                kinetic_force: zeros(),
            }),
            aged: coulomb.ageing.map(|law| Aged {
                law,
                adhesion: adhesion.of_static,
                static_limit: zeros(),
                is_old: vec![false; n_blocks],
                stopped_at: zeros(),
            }),
        }
    }

    /// Finds the thresholds of some blocks at the present instant, from those of age 0 and at rest.
    #[inline(always)]
    pub(super) fn update(
        &mut self,
        blocks: &Range<usize>,
        young: &[f64],
        at_rest: &[f64],
        state: &State,
        forces: &Forces,
        time_star: f64,
    ) {
        if let Some(weakened) = &mut self.weakened {
            weakened.update(blocks, at_rest, &state.velocity);
        }
        if let Some(aged) = &mut self.aged {
            aged.update(
                blocks,
                young,
                &state.velocity,
                [&forces.drive, &forces.lattice],
                time_star,
            );
        }
    }

    /// Static and kinetic thresholds at the present instant.
    #[inline(always)]
    pub(super) fn now<'a>(&'a self, young: &'a [f64], at_rest: &'a [f64]) -> [&'a [f64]; 2] {
        let (aged, weakened) = (self.aged.as_ref(), self.weakened.as_ref());
        [
            aged.map_or(young, |aged| &aged.static_limit),
            weakened.map_or(at_rest, |weakened| &weakened.kinetic_force),
        ]
    }

    /// Notes those of some blocks that stop now, if their age matters.
    #[inline(always)]
    pub(super) fn note_stops(
        &mut self,
        blocks: &Range<usize>,
        state: &State,
        forces: &Forces,
        time_star: f64,
    ) {
        if let Some(aged) = &mut self.aged {
            aged.note_stops(blocks, &state.velocity, &forces.slides, time_star);
        }
    }
}

impl Weakened {
    /// Kinetic friction at the velocities half a step before.
    #[inline(always)]
    fn update(&mut self, blocks: &Range<usize>, at_rest: &[f64], velocity: &VectorField) {
        let (n, [vx, vy]) = (blocks.len(), part(velocity, blocks));
        let (at_rest, vx, vy) = (&at_rest[blocks.clone()][..n], &vx[..n], &vy[..n]);
        let kinetic_force = &mut self.kinetic_force[blocks.clone()][..n];
        for k in 0..n {
            kinetic_force[k] = self
                .law
                .kinetic_force(at_rest[k], self.adhesion, length([vx[k], vy[k]]));
        }
    }
}

impl Aged {
    /// Static thresholds of the blocks that are stuck and whose force exceeds what they had at age 0: only there does age matter.
    #[inline(always)]
    fn update(
        &mut self,
        blocks: &Range<usize>,
        young: &[f64],
        velocity: &VectorField,
        forces: [&VectorField; 2],
        time_star: f64,
    ) {
        let (n, [vx, vy], [[dx, dy], [lx, ly]]) = (
            blocks.len(),
            part(velocity, blocks),
            forces.map(|force| part(force, blocks)),
        );
        let (young, vx, vy) = (&young[blocks.clone()][..n], &vx[..n], &vy[..n]);
        let (dx, dy, lx, ly) = (&dx[..n], &dy[..n], &lx[..n], &ly[..n]);
        let (static_limit, is_old) = (
            &mut self.static_limit[blocks.clone()][..n],
            &mut self.is_old[blocks.clone()][..n],
        );
        for k in 0..n {
            let force = [dx[k] + lx[k], dy[k] + ly[k]];
            is_old[k] = (vx[k] == 0.0) & (vy[k] == 0.0) & (dot(force, force) > young[k] * young[k]);
            static_limit[k] = young[k];
        }
        // They are few, and have their logarithms one by one.
        for k in (0..n).filter(|&k| is_old[k]) {
            let age = time_star - self.stopped_at[blocks.start + k];
            static_limit[k] = self.law.static_limit(young[k], self.adhesion, age);
        }
    }

    /// Notes the blocks that stop now. Evaluated again from the same velocities, a step notes the same.
    #[inline(always)]
    fn note_stops(&mut self, blocks: &Range<usize>, before: &VectorField, slides: &[bool], time_star: f64) {
        let (n, [vx, vy]) = (blocks.len(), part(before, blocks));
        let (vx, vy, slides) = (&vx[..n], &vy[..n], &slides[blocks.clone()][..n]);
        let stopped_at = &mut self.stopped_at[blocks.clone()][..n];
        for k in 0..n {
            let stops = ((vx[k] != 0.0) | (vy[k] != 0.0)) & !slides[k];
            stopped_at[k] = if stops { time_star } else { stopped_at[k] };
        }
    }
}
