//! Values of a step of the fused kernel that are common to all blocks.

use crate::integrator::Integrator;

/// Values common to all blocks in a step.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Number of the step, n.
    pub number: u64,
    /// Time step `dt*`.
    pub dt_star: f64,
    /// Time for which displacements move before forces are evaluated: `dt*`, or 0 at the start.
    pub move_dt: f64,
    /// Stiffness of the drive springs.
    pub k_drive: f64,
    /// Displacement of the driven ends of the drive springs.
    pub drive_position: [f64; 2],
    /// Displacement of the driven ends of the drive springs at the step before.
    pub position_before: [f64; 2],
    /// The first step at which the speed of the drive may change next.
    pub next_change: u64,
    /// Growth per time of the force of a drive spring on a block at rest, `k_s V`; a held drive loads more
    /// slowly.
    pub force_growth: [f64; 2],
    /// Dead load on a block, to be multiplied by its relative load if it has one.
    pub dead_load: [f64; 2],
    /// Time step and damping.
    pub integrator: Integrator,
}

impl Step {
    /// Time `t*_n` of the blocks.
    pub(crate) fn time_star(&self) -> f64 {
        self.number as f64 * self.dt_star
    }

    /// The step before this one, which must not be the first.
    pub(crate) fn before(&self) -> Self {
        Self {
            number: self.number - 1,
            drive_position: self.position_before,
            ..*self
        }
    }

    /// Force of the drive spring on a block at displacement `u` (Eq. 2), with the dead load, given the
    /// relative drive spring and the relative load of the block.
    pub(crate) fn drive_force(&self, u: [f64; 2], [drive_spring, load]: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| {
            let spring = self.k_drive * (self.drive_position[axis] - u[axis]);
            drive_spring * spring + load * self.dead_load[axis]
        })
    }
}
