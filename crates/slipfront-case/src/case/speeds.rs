//! Loading speeds of a slider: the run that each one takes, and its contribution to friction.

use slipfront::StopReason;
use slipfront::lattice::K_DRIVE;

use super::runnable::Case;
use crate::case_file::{DriveSpeed, TimeStep};

/// Difference of mu_s* between slow speeds, averaged over surfaces, in addition to the contribution of the
/// drive: the oscillation of blocks after each slip determines where the next slip begins. The drive may add
/// the same amount to mu_s* at a speed that counts as slow, and drag may add the same share to kinetic
/// friction.
const HALF_A_POINT: f64 = 0.005;

/// Expected number of steps of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedSteps {
    /// Fewest and most steps.
    pub steps: [f64; 2],
    /// V* N, the ratio of the time in which a slip front crosses the slider to the time of loading.
    pub front_ratio: f64,
    /// Whether a held drive stops for further steps. Their number is not known in advance.
    pub stands: bool,
}

impl ExpectedSteps {
    /// Steps for the same path at this multiple of the speed.
    fn at_speed(self, factor: f64) -> Self {
        Self {
            steps: self.steps.map(|steps| (steps / factor).ceil()),
            front_ratio: factor * self.front_ratio,
            ..self
        }
    }
}

/// A speed of the drive, with its run over the same path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadingSpeed {
    /// Speed relative to that of the case.
    pub over_given: f64,
    /// Expected steps, see [`Case::expected_steps`].
    pub steps: ExpectedSteps,
    /// Drag of the damping relative to kinetic friction without it, or to a tenth of static friction where
    /// that is larger.
    pub drag_share: f64,
    /// Whether drag is compared with a tenth of static friction.
    pub is_share_of_static: bool,
}

impl Case {
    /// Number of blocks of the slider along the drive, or along its longer side under torsion, after the
    /// symbol of this number.
    pub fn blocks_along_drive(&self) -> (&'static str, f64) {
        let (lattice, drive) = (&self.model.lattice, &self.model.drive);
        let [nx, ny] = [lattice.nx, lattice.ny].map(|blocks| blocks as f64);
        match drive.direction {
            _ if drive.rotation.is_some() => ("N", nx.max(ny)),
            [_, 0.0] => ("N_x", nx),
            [0.0, _] => ("N_y", ny),
            [along_x, along_y] => ("N", nx * along_x.abs() + ny * along_y.abs()),
        }
    }

    /// V* N, the ratio of the time in which a slip front crosses the slider to the time of loading.
    pub fn front_ratio(&self) -> f64 {
        self.model.speed_against_front() * self.blocks_along_drive().1
    }

    /// Rise of mu* in a step in which the drive moves and nothing slides: k_s V* dt* for a spring of
    /// stiffness k_s on each block.
    pub fn rise_per_step(&self) -> f64 {
        K_DRIVE * self.model.loading_speed() * self.time_plan.dt_star
    }

    /// Expected steps, without those in which a held drive stops: all steps, or those to the expected onset,
    /// within a tenth, where the onset ends the run.
    pub fn expected_steps(&self) -> ExpectedSteps {
        let plan = &self.time_plan;
        let last = plan.last_step as f64;
        let stands = self.model.drive.is_held();
        let steps = if self.file.time.stop != StopReason::Onset || stands {
            [last; 2]
        } else {
            let [early, late] = self.expected.onset_star;
            [0.9 * early, 1.1 * late].map(|star| (star / plan.dt_star).clamp(1.0, last))
        };
        ExpectedSteps {
            steps,
            front_ratio: self.front_ratio(),
            stands,
        }
    }

    /// The speed of the case and its costs. None for a single block, and where no other speed can replace
    /// that of the case: where the friction of the blocks depends on speed or time, the speed is a program,
    /// or the time step depends on the speed. Also none for a held drive, which loads slowly at any speed.
    pub fn loading_speed(&self) -> Option<LoadingSpeed> {
        let file = &self.file;
        let is_free = self.model.n_blocks() > 1
            && !file.friction.depends_on_time()
            && !matches!(file.drive.speed, DriveSpeed::Program(_))
            && file.time.step != TimeStep::Paper
            && !self.model.drive.is_held();
        let (level, drag) = (self.expected.steady_level, self.expected.steady_drag);
        let (kinetic, least) = (level - drag, 0.1 * self.model.surface.mean_static_force());
        is_free.then(|| LoadingSpeed {
            over_given: 1.0,
            steps: self.expected_steps(),
            drag_share: drag / kinetic.max(least),
            is_share_of_static: kinetic < least,
        })
    }
}

impl LoadingSpeed {
    /// Bound of the difference of mu_s* from its limit of slow loading, averaged over surfaces: the load k_2
    /// V* N that the drive adds while a front crosses the slider, and half a point. Measured on 29 sliders
    /// with and without texture, V* N from 0.005 to 3.
    pub fn static_bound(&self) -> f64 {
        self.added_static() + HALF_A_POINT
    }

    fn added_static(&self) -> f64 {
        K_DRIVE * self.steps.front_ratio
    }

    /// Factor to the speed at which the drive adds half a point to mu_s*, and drag adds no larger share to
    /// kinetic friction.
    pub fn factor_to_slow(&self) -> f64 {
        HALF_A_POINT / self.added_static().max(self.drag_share)
    }

    /// The speed multiplied by a factor.
    pub fn times(self, factor: f64) -> Self {
        Self {
            over_given: factor * self.over_given,
            steps: self.steps.at_speed(factor),
            drag_share: factor * self.drag_share,
            ..self
        }
    }
}
