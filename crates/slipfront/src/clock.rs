//! The two times of a run: the time of the blocks, and the time of the drive, which stops while a held drive
//! waits.

use serde::{Deserialize, Serialize};

/// Criterion by which a held drive decides that slip has ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Rest {
    /// No block in contact slides.
    #[default]
    Exact,
    /// The force that keeps the blocks moving is negligible. Used in runs in which exact rest never came.
    ByForce {
        /// Whether this force is negligible at t_n.
        at_rest: bool,
    },
}

/// An instant t_n, as counts of steps. Times are products of these counts and the time step, so that rounding
/// errors do not add up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Clock {
    /// Number of the step, n.
    pub(crate) step: u64,
    /// Steps up to t_n in which the drive moved: n at constant loading.
    pub(crate) drive_steps: u64,
    /// Consecutive steps up to t_n in which the drive stood still.
    pub(crate) standing: u64,
    /// Criterion of rest under a held drive.
    pub(crate) rest: Rest,
    pub(crate) dt_star: f64,
}

impl Clock {
    /// The clock at t = 0.
    pub(crate) fn start(dt_star: f64) -> Self {
        Self {
            step: 0,
            drive_steps: 0,
            standing: 0,
            rest: Rest::Exact,
            dt_star,
        }
    }

    /// The next instant; the drive moves up to it or stands still.
    pub(crate) fn next(self, drive_moves: bool) -> Self {
        Self {
            step: self.step + 1,
            drive_steps: self.drive_steps + u64::from(drive_moves),
            standing: if drive_moves { 0 } else { self.standing + 1 },
            ..self
        }
    }

    /// Steps in which the drive had moved by the instant before, or by t = 0 if this is the start.
    pub(crate) fn drive_steps_before(&self) -> u64 {
        self.drive_steps.saturating_sub(u64::from(self.drive_moved()))
    }

    /// Whether the drive moved in the step that ends at t_n; true at t = 0.
    pub(crate) fn drive_moved(&self) -> bool {
        self.standing == 0
    }

    /// Time t*_n of the blocks.
    pub(crate) fn time_star(&self) -> f64 {
        self.step as f64 * self.dt_star
    }

    /// Time of the drive t*, on which its path depends.
    pub(crate) fn drive_time_star(&self) -> f64 {
        self.drive_steps as f64 * self.dt_star
    }

    /// Time of the drive t* at the instant before.
    pub(crate) fn drive_time_before(&self) -> f64 {
        self.drive_steps_before() as f64 * self.dt_star
    }
}
