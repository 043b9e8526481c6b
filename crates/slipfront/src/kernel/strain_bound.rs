//! An upper bound on the strain of every spring, by which the fused kernel chooses how to compute spring forces.

use serde::{Deserialize, Serialize};

/// Bounds all differences of displacement: by the extent of the displacements when they were last measured, and by the
/// highest speeds since then. Part of a checkpoint, so that a resumed run chooses the same formula at every step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct StrainBound {
    /// Largest u_x, -u_x, u_y, -u_y at the latest measurement.
    pub(crate) extent: [f64; 4],
    /// By how much differences of displacement may have grown since.
    pub(crate) growth: f64,
    /// Highest speed after the latest sweep.
    pub(crate) speed: f64,
}

impl StrainBound {
    /// Largest possible `|eps s|/d^2` of a spring, with `s = (r^2 - d^2)/eps`.
    pub(crate) fn max_strain(&self, epsilon: f64) -> f64 {
        let [right, left, top, bottom] = self.extent;
        let (ex, ey) = (right + left + self.growth, top + bottom + self.growth);
        epsilon * (2.0 * (ex + ey) + epsilon * (ex * ex + ey * ey))
    }
}
