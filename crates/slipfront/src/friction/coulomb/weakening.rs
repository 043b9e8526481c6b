//! Kinetic friction that falls with speed.

use std::ops::Range;

use crate::forces::{part, values_of, values_of_mut};
use crate::friction::needs::Needs;
use crate::surface::Adhesion;
use crate::vector_field::{VectorField, length};

/// Velocity weakening: `mu_k(v) = mu_k [ratio + (1 - ratio)/(1 + |v|/v_c)]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weakening {
    /// Speed `v_c` at which half of the fall is reached, in units of `P mu_s/sqrt(E rho)`.
    pub critical_speed: f64,
    /// Kinetic friction at high speed over that at rest, 0 to 1.
    pub ratio: f64,
}

impl Weakening {
    /// Needs of velocity weakening: kinetic friction at the present speed.
    pub(super) const NEEDS: Needs = Needs {
        varies: true,
        ..Needs::NONE
    };

    /// Share of kinetic friction that is lost at a speed, in a form that is exactly 0 at rest:
    ///
    /// ```text
    /// 1 - mu_k(v)/mu_k = (1 - ratio) |v|/(v_c + |v|)
    /// ```
    ///
    /// ```
    /// // Half of the fall at v_c.
    /// let weakening = slipfront::Weakening { critical_speed: 0.1, ratio: 0.5 };
    /// assert_eq!((weakening.lost_share(0.0), weakening.lost_share(0.1)), (0.0, 0.25));
    /// ```
    #[inline(always)]
    pub fn lost_share(&self, speed: f64) -> f64 {
        (1.0 - self.ratio) * (speed / (self.critical_speed + speed))
    }

    /// Kinetic friction `mu_k(v) F_n + tau_ak l^2` at `speed`, from the kinetic friction `at_rest`. Adhesion
    /// does not weaken: the law applies to the coefficient.
    ///
    /// The operations have this order in every kernel: `x = v/(v_c + v)`, `s = (1 - ratio) x`,
    /// `m = max(K - tau_ak l^2, 0)`, `K - s m`.
    #[inline(always)]
    pub(super) fn kinetic_force(&self, at_rest: f64, adhesion: f64, speed: f64) -> f64 {
        at_rest - self.lost_share(speed) * (at_rest - adhesion).max(0.0)
    }
}

/// Kinetic friction of the blocks of a band at their present speeds.
#[derive(Debug)]
pub(super) struct Weakened {
    law: Weakening,
    adhesion: f64,
    pub(super) kinetic_force: Vec<f64>,
}

impl Weakened {
    pub(super) fn new(law: Weakening, adhesion: Adhesion, n_blocks: usize) -> Self {
        Self {
            law,
            adhesion: adhesion.of_kinetic,
            kinetic_force: vec![0.0; n_blocks],
        }
    }

    /// Finds kinetic friction from the velocities half a step before.
    #[inline(always)]
    pub(super) fn update(&mut self, blocks: &Range<usize>, at_rest: &[f64], velocity: &VectorField) {
        let ([vx, vy], at_rest) = (part(velocity, blocks), values_of(at_rest, blocks));
        let kinetic_force = values_of_mut(&mut self.kinetic_force, blocks);
        for k in 0..blocks.len() {
            kinetic_force[k] = self
                .law
                .kinetic_force(at_rest[k], self.adhesion, length([vx[k], vy[k]]));
        }
    }
}
