//! What a step of the fused kernel has in common for all blocks.

use crate::friction::Integrator;
use crate::model::{Drive, Model};

/// What is common to all blocks in a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// n.
    pub(super) number: u64,
    /// `t*` of the step.
    pub(super) time_star: f64,
    /// `dt*`.
    pub(super) dt_star: f64,
    /// Time for which displacements move before forces are evaluated: `dt*`, or 0 at the start.
    pub(super) move_dt: f64,
    pub(super) drive: Drive,
    /// Displacement of the driven ends of the drive springs.
    pub(super) drive_position: [f64; 2],
    pub(super) integrator: Integrator,
}

impl Step {
    pub(super) fn new(model: &Model, number: u64, dt_star: f64) -> Self {
        let time_star = number as f64 * dt_star;
        Self {
            number,
            time_star,
            dt_star,
            move_dt: dt_star,
            drive: model.drive,
            drive_position: model.drive.position(time_star),
            integrator: Integrator::new(model.damping, dt_star),
        }
    }

    /// The step before this one, of which there must be one.
    pub(super) fn before(&self) -> Self {
        let number = self.number - 1;
        let time_star = number as f64 * self.dt_star;
        Self {
            number,
            time_star,
            drive_position: self.drive.position(time_star),
            ..*self
        }
    }
}
