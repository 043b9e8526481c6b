//! Static friction that grows while a block is stuck.

use std::ops::Range;

use crate::forces::{part, values_of, values_of_mut};
use crate::friction::needs::Needs;
use crate::surface::Adhesion;
use crate::vector_field::{VectorField, dot};

/// Logarithmic ageing: `mu_s(t) = mu_s [1 + beta ln(1 + t_stuck/tau)]`, with age 0 at t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ageing {
    /// Factor `beta` of the logarithm.
    pub beta: f64,
    /// Time `tau`, t*.
    pub time: f64,
}

impl Ageing {
    /// Needs of ageing: the threshold at the present age, whether age counts, and the time at which the block
    /// stopped, which is stored.
    pub(super) const NEEDS: Needs = Needs {
        is_fused: false,
        columns: 1,
        ..Needs::NONE
    };

    /// Static friction over that of age 0, less 1: `beta ln(1 + age/tau)`. The logarithm is that of `libm`.
    ///
    /// ```
    /// let ageing = slipfront::Ageing { beta: 0.1, time: 2.0 };
    /// assert_eq!(ageing.growth(0.0), 0.0);
    /// assert!((ageing.growth(2.0) - 0.1 * 2.0_f64.ln()).abs() < 1e-16);
    /// ```
    #[inline(always)]
    pub fn growth(&self, age: f64) -> f64 {
        self.beta * libm::log1p(age / self.time)
    }

    /// Static threshold `mu_s(t) F_n + tau_a l^2` of a block that has been stuck for `age`, from the
    /// threshold at age 0. Adhesion does not age: the law applies to the coefficient.
    ///
    /// The operations have this order in every kernel: `x = age/tau`, `g = beta log1p(x)`,
    /// `m = max(S - tau_a l^2, 0)`, `S + g m`.
    #[inline(always)]
    fn static_limit(&self, young: f64, adhesion: f64, age: f64) -> f64 {
        young + self.growth(age) * (young - adhesion).max(0.0)
    }

    /// Pull at which a block slips if it has been stuck since the pull was 0, the pull rises at `rate`, and
    /// the threshold exceeds kinetic friction.
    pub(super) fn first_slip_pull(&self, young: f64, adhesion: f64, rate: f64) -> f64 {
        // The threshold grows more slowly than the pull, so that each round comes nearer to the fixed point.
        let aged = |pull: f64| self.static_limit(young, adhesion, pull / rate);
        (0..MAX_ROUNDS).fold(young, |pull, _| aged(pull))
    }
}

/// Number of rounds of the fixed-point iteration: if each at least halves the error, the result is exact to
/// the last bit.
const MAX_ROUNDS: usize = 60;

/// Static thresholds of the blocks of a band at their present ages.
#[derive(Debug)]
pub(super) struct Aged {
    law: Ageing,
    adhesion: f64,
    pub(super) static_limit: Vec<f64>,
    /// Blocks with thresholds that are raised by their ages.
    is_old: Vec<bool>,
    /// Time t* at which a stuck block has stopped: the memory of the law.
    pub(super) stopped_at: Vec<f64>,
}

impl Aged {
    pub(super) fn new(law: Ageing, adhesion: Adhesion, n_blocks: usize) -> Self {
        Self {
            law,
            adhesion: adhesion.of_static,
            static_limit: vec![0.0; n_blocks],
            is_old: vec![false; n_blocks],
            stopped_at: vec![0.0; n_blocks],
        }
    }

    /// Finds the static thresholds of stuck blocks with a force that exceeds the threshold at age 0: only
    /// there does age matter.
    #[inline(always)]
    pub(super) fn update(
        &mut self,
        blocks: &Range<usize>,
        young: &[f64],
        velocity: &VectorField,
        forces: [&VectorField; 2],
        time_star: f64,
    ) {
        let (n, young, [vx, vy]) = (blocks.len(), values_of(young, blocks), part(velocity, blocks));
        let [[dx, dy], [lx, ly]] = forces.map(|force| part(force, blocks));
        let static_limit = values_of_mut(&mut self.static_limit, blocks);
        let is_old = values_of_mut(&mut self.is_old, blocks);
        for k in 0..n {
            let force = [dx[k] + lx[k], dy[k] + ly[k]];
            is_old[k] = (vx[k] == 0.0) & (vy[k] == 0.0) & (dot(force, force) > young[k] * young[k]);
            static_limit[k] = young[k];
        }
        // There are few of them, and their logarithms are computed one by one.
        for k in (0..n).filter(|&k| is_old[k]) {
            let age = time_star - self.stopped_at[blocks.start + k];
            static_limit[k] = self.law.static_limit(young[k], self.adhesion, age);
        }
    }

    /// Stores the time for blocks that stop now. A step that is evaluated again from the same velocities
    /// finds the same blocks.
    #[inline(always)]
    pub(super) fn note_stops(
        &mut self,
        blocks: &Range<usize>,
        before: &VectorField,
        slides: &[bool],
        time_star: f64,
    ) {
        let ([vx, vy], slides) = (part(before, blocks), values_of(slides, blocks));
        let stopped_at = values_of_mut(&mut self.stopped_at, blocks);
        for k in 0..blocks.len() {
            let stops = ((vx[k] != 0.0) | (vy[k] != 0.0)) & !slides[k];
            stopped_at[k] = if stops { time_star } else { stopped_at[k] };
        }
    }
}
