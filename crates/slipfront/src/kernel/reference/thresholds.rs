//! Thresholds of Coulomb's law that follow speed and age.

use super::forces::Forces;
use crate::friction::{Ageing, Coulomb, FrictionLaw, Weakening};
use crate::state::State;
use crate::surface::Adhesion;
use crate::vector_field::VectorField;

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
                stopped_at: zeros(),
            }),
        }
    }

    /// Finds the thresholds at the present instant, from those of age 0 and at rest.
    #[inline(always)]
    pub(super) fn update(
        &mut self,
        young: &[f64],
        at_rest: &[f64],
        state: &State,
        forces: &Forces,
        time_star: f64,
    ) {
        if let Some(weakened) = &mut self.weakened {
            weakened.update(at_rest, &state.velocity);
        }
        if let Some(aged) = &mut self.aged {
            aged.update(
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

    /// Notes the blocks that stop now, if their age matters.
    #[inline(always)]
    pub(super) fn note_stops(&mut self, state: &State, forces: &Forces, time_star: f64) {
        if let Some(aged) = &mut self.aged {
            aged.note_stops(&state.velocity, &forces.slides, time_star);
        }
    }
}

impl Weakened {
    /// Kinetic friction at the velocities half a step before.
    #[inline(always)]
    fn update(&mut self, at_rest: &[f64], velocity: &VectorField) {
        let n = self.kinetic_force.len();
        let (at_rest, vx, vy) = (&at_rest[..n], &velocity.x[..n], &velocity.y[..n]);
        for b in 0..n {
            let speed = (vx[b] * vx[b] + vy[b] * vy[b]).sqrt();
            self.kinetic_force[b] = self.law.kinetic_force(at_rest[b], self.adhesion, speed);
        }
    }
}

impl Aged {
    /// Static thresholds of the blocks that are stuck and whose force exceeds what they had at age 0: only there does age matter.
    #[inline(always)]
    fn update(&mut self, young: &[f64], velocity: &VectorField, forces: [&VectorField; 2], time_star: f64) {
        let n = self.static_limit.len();
        let (young, vx, vy) = (&young[..n], &velocity.x[..n], &velocity.y[..n]);
        let [[dx, dy], [lx, ly]] = forces.map(|force| [&force.x[..n], &force.y[..n]]);
        for b in 0..n {
            let [x, y] = [dx[b] + lx[b], dy[b] + ly[b]];
            let is_stuck = (vx[b] == 0.0) & (vy[b] == 0.0);
            self.static_limit[b] = if is_stuck & (x * x + y * y > young[b] * young[b]) {
                let age = time_star - self.stopped_at[b];
                self.law.static_limit(young[b], self.adhesion, age)
            } else {
                young[b]
            };
        }
    }

    /// Notes the blocks that stop now. Evaluated again from the same velocities, a step notes the same.
    #[inline(always)]
    fn note_stops(&mut self, before: &VectorField, slides: &[bool], time_star: f64) {
        let n = self.stopped_at.len();
        let (vx, vy, slides) = (&before.x[..n], &before.y[..n], &slides[..n]);
        for b in 0..n {
            let stops = ((vx[b] != 0.0) | (vy[b] != 0.0)) & !slides[b];
            self.stopped_at[b] = if stops { time_star } else { self.stopped_at[b] };
        }
    }
}
