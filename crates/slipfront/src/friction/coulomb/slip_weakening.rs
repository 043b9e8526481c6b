//! Strength that falls with slip, from the static threshold to kinetic friction.

use std::ops::Range;

pub use slipfront_kernel::FallWithSlip as SlipWeakening;

use crate::forces::{part, values_of, values_of_mut};
use crate::friction::needs::Needs;
use crate::vector_field::{VectorField, length};

/// Needs of slip weakening: the slip, both thresholds at present, and with healing the time of the last
/// motion and the share lost before it healed. The fused kernel keeps the fall of strength instead of the
/// static threshold.
pub(super) fn needs(law: SlipWeakening) -> Needs {
    Needs {
        columns: if law.healing_time.is_some() { 3 } else { 1 },
        weakens_with_slip: true,
        ..Needs::NONE
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
        let ([vx, vy], slip) = (part(velocity, blocks), values_of_mut(&mut self.slip, blocks));
        for k in 0..blocks.len() {
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
        let (whole, kinetic) = (values_of(whole, blocks), values_of(kinetic, blocks));
        let slip = values_of(&self.slip, blocks);
        let static_limit = values_of_mut(&mut self.static_limit, blocks);
        let kinetic_force = values_of_mut(&mut self.kinetic_force, blocks);
        for k in 0..blocks.len() {
            let drop = (whole[k] - kinetic[k]).max(0.0);
            kinetic_force[k] = kinetic[k] + drop * self.law.share_left(slip[k]);
            static_limit[k] = if drop > 0.0 { kinetic_force[k] } else { whole[k] };
        }
    }
}
