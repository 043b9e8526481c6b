//! Values of a step of the fused kernel that are common to all blocks.

use crate::clock::Clock;
use crate::friction::Integrator;
use crate::model::Model;

/// Values common to all blocks in a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// Number of the step, n.
    pub(super) number: u64,
    /// Time step `dt*`.
    pub(super) dt_star: f64,
    /// Time for which displacements move before forces are evaluated: `dt*`, or 0 at the start.
    pub(super) move_dt: f64,
    /// Stiffness of the drive springs.
    pub(super) k_drive: f64,
    /// Displacement of the driven ends of the drive springs.
    pub(super) drive_position: [f64; 2],
    /// Displacement of the driven ends of the drive springs at the step before.
    position_before: [f64; 2],
    /// The first step at which the speed of the drive may change next.
    pub(super) next_change: u64,
    /// Growth per time of the force of a drive spring on a block at rest, `k_s V`; a held drive loads more
    /// slowly.
    pub(super) force_growth: [f64; 2],
    /// Dead load on a block, to be multiplied by its relative load if it has one.
    pub(super) dead_load: [f64; 2],
    pub(super) integrator: Integrator,
}

impl Step {
    pub(super) fn new(model: &Model, clock: &Clock) -> Self {
        let (drive, dt_star) = (&model.drive, clock.dt_star);
        let (time_star, before) = (clock.drive_time_star(), clock.drive_time_before());
        // The drive moves at most once per step.
        let steps_until = |t: f64| (t / dt_star).round() as u64 - clock.drive_steps;
        Self {
            number: clock.step,
            dt_star,
            move_dt: dt_star,
            k_drive: drive.k_drive,
            drive_position: drive.position(time_star),
            position_before: drive.position(before),
            next_change: drive
                .next_change(time_star)
                .map_or(u64::MAX, |t| clock.step + steps_until(t)),
            force_growth: drive
                .direction
                .map(|d| drive.k_drive * drive.speed_after(time_star) * d),
            dead_load: model.dead_load.force,
            integrator: Integrator::new(model.damping, dt_star),
        }
    }

    /// Time `t*_n` of the blocks.
    pub(super) fn time_star(&self) -> f64 {
        self.number as f64 * self.dt_star
    }

    /// The step before this one, which must not be the first.
    pub(super) fn before(&self) -> Self {
        Self {
            number: self.number - 1,
            drive_position: self.position_before,
            ..*self
        }
    }

    /// Force of the drive spring on a block at displacement `u` (Eq. 2), with the dead load, given the
    /// relative drive spring and the relative load of the block.
    pub(super) fn drive_force(&self, u: [f64; 2], [drive_spring, load]: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| {
            let spring = self.k_drive * (self.drive_position[axis] - u[axis]);
            drive_spring * spring + load * self.dead_load[axis]
        })
    }
}
