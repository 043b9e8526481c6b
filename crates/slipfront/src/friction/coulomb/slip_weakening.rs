//! Strength that falls with slip, from the static threshold to kinetic friction.

use std::ops::Range;

use slipfront_kernel::FallWithSlip;

use crate::forces::part;
use crate::friction::needs::Needs;
use crate::vector_field::{VectorField, length};

/// Linear slip weakening: after a slip `s` since it last had its full strength, a block bears
///
/// ```text
/// f(s) = K + (S - K) max(0, 1 - s/D_c)
/// ```
///
/// while it slides or is about to, with its full static and kinetic thresholds `S` and `K`. Where `K >= S`
/// strength does not fall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipWeakening {
    /// Slip `D_c` over which strength falls, in units of `P mu_s l^2/(E h)`.
    pub length: f64,
    /// Time t* after which a stuck block has its full strength again; if there is none, no block heals.
    pub healing_time: Option<f64>,
}

impl SlipWeakening {
    /// Needs of slip weakening: the slip, both thresholds at present, and with healing the time of the last
    /// motion and the share lost before it healed. The fused kernel keeps the fall of strength instead of the
    /// static threshold.
    pub(super) fn needs(&self) -> Needs {
        let columns = if self.healing_time.is_some() { 3 } else { 1 };
        Needs {
            columns,
            weakens_with_slip: true,
            ..Needs::NONE
        }
    }

    /// The law as the fused kernel knows it.
    #[inline(always)]
    pub(crate) fn fall(&self) -> FallWithSlip {
        FallWithSlip {
            length: self.length,
            healing_time: self.healing_time,
        }
    }

    /// Share of the fall of strength that is left after a slip, `max(0, 1 - s/D_c)`.
    ///
    /// ```
    /// let law = slipfront::SlipWeakening { length: 0.5, healing_time: None };
    /// assert_eq!([0.0, 0.25, 0.5, 2.0].map(|slip| law.share_left(slip)), [1.0, 0.5, 0.0, 0.0]);
    /// ```
    #[inline(always)]
    pub fn share_left(&self, slip: f64) -> f64 {
        self.fall().share_left(slip)
    }

    /// Share of the largest weakening energy, `(S - K) D_c/2`, that has been lost after a slip:
    ///
    /// ```text
    /// 1 - max(0, 1 - s/D_c)^2
    /// ```
    ///
    /// ```
    /// let law = slipfront::SlipWeakening { length: 0.5, healing_time: None };
    /// assert_eq!([0.0, 0.25, 0.5, 2.0].map(|slip| law.share_lost(slip)), [0.0, 0.75, 1.0, 1.0]);
    /// ```
    #[inline(always)]
    pub fn share_lost(&self, slip: f64) -> f64 {
        self.fall().share_lost(slip)
    }

    /// Energy that weakening has dissipated in a block with a fall of strength of `drop = max(S - K, 0)`, the
    /// integral of `f - K` over its slip:
    ///
    /// ```text
    /// Phi = (S - K) D_c/2 (share lost by the present slip + shares lost before it healed)
    /// ```
    pub(crate) fn energy(&self, drop: f64, slip: f64, lost_before: f64) -> f64 {
        0.5 * drop * self.length * (lost_before + self.share_lost(slip))
    }

    /// Whether a stuck block that last moved at `moved_at` has its full strength again at `time_star`.
    #[inline(always)]
    pub(crate) fn heals(&self, moved_at: f64, time_star: f64) -> bool {
        self.fall().heals(moved_at, time_star)
    }
}

/// Thresholds of the blocks of a band at their present slip, with the slip, which is the memory of the law.
#[derive(Debug)]
pub(super) struct Slipped {
    law: SlipWeakening,
    pub(super) static_limit: Vec<f64>,
    pub(super) kinetic_force: Vec<f64>,
    slip: Vec<f64>,
    /// Time t* of the last motion of each block, and the shares lost before it healed; present only with
    /// healing.
    healing: Option<[Vec<f64>; 2]>,
}

impl Slipped {
    pub(super) fn new(law: SlipWeakening, n_blocks: usize) -> Self {
        let zeros = || vec![0.0; n_blocks];
        Self {
            law,
            static_limit: zeros(),
            kinetic_force: zeros(),
            slip: zeros(),
            healing: law.healing_time.map(|_| [zeros(), zeros()]),
        }
    }

    /// Columns that a checkpoint keeps.
    pub(super) fn columns(&self) -> impl Iterator<Item = &[f64]> {
        [&self.slip]
            .into_iter()
            .chain(self.healing.iter().flatten())
            .map(Vec::as_slice)
    }

    /// Columns that a checkpoint keeps, to be filled.
    pub(super) fn columns_mut(&mut self) -> impl Iterator<Item = &mut [f64]> {
        let healing = self.healing.iter_mut().flatten();
        [&mut self.slip].into_iter().chain(healing).map(Vec::as_mut_slice)
    }

    /// Adds the slip of some blocks in the step that ends now, at these velocities.
    #[inline(always)]
    pub(super) fn add_slip(&mut self, blocks: &Range<usize>, velocity: &VectorField, dt_star: f64) {
        let (n, [vx, vy]) = (blocks.len(), part(velocity, blocks));
        let (vx, vy, slip) = (&vx[..n], &vy[..n], &mut self.slip[blocks.clone()][..n]);
        for k in 0..n {
            slip[k] += dt_star * length([vx[k], vy[k]]);
        }
    }

    /// Finds the thresholds at the present slip from those at full strength. A step that is evaluated again
    /// finds the same thresholds.
    #[inline(always)]
    pub(super) fn update(
        &mut self,
        blocks: &Range<usize>,
        [whole, kinetic]: [&[f64]; 2],
        velocity: &VectorField,
        time_star: f64,
    ) {
        if let Some([moved_at, lost_before]) = &mut self.healing {
            for b in blocks.clone() {
                let is_moving = velocity.at(b) != [0.0, 0.0];
                if is_moving {
                    moved_at[b] = time_star;
                } else if self.law.heals(moved_at[b], time_star) {
                    lost_before[b] += self.law.share_lost(self.slip[b]);
                    self.slip[b] = 0.0;
                }
            }
        }
        let n = blocks.len();
        let (whole, kinetic) = (&whole[blocks.clone()][..n], &kinetic[blocks.clone()][..n]);
        let slip = &self.slip[blocks.clone()][..n];
        let static_limit = &mut self.static_limit[blocks.clone()][..n];
        let kinetic_force = &mut self.kinetic_force[blocks.clone()][..n];
        for k in 0..n {
            let drop = (whole[k] - kinetic[k]).max(0.0);
            kinetic_force[k] = kinetic[k] + drop * self.law.share_left(slip[k]);
            static_limit[k] = if drop > 0.0 { kinetic_force[k] } else { whole[k] };
        }
    }
}
