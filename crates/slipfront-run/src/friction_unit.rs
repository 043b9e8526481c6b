//! The unit of mu* in a laboratory.

use slipfront::{Model, Scales};

/// One unit of mu* of a whole slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum FrictionUnit {
    /// Unit of a force, N.
    Force(f64),
    /// Unit of a torque, N m, under a drive that rotates.
    Torque(f64),
}

impl FrictionUnit {
    pub(crate) fn new(scales: &Scales, model: &Model) -> Self {
        let force = scales.force() * model.mu_star_divisor();
        match &model.drive.rotation {
            None => Self::Force(force),
            Some(rotation) => Self::Torque(force * (rotation.radius * scales.block_size)),
        }
    }

    /// Friction in N; none for a drive that rotates.
    pub(crate) fn force(self, mu_star: f64) -> Option<f64> {
        match self {
            Self::Force(force) => Some(mu_star * force),
            Self::Torque(_) => None,
        }
    }

    /// Torque in N m; none for a drive that does not rotate.
    pub(crate) fn torque(self, mu_star: f64) -> Option<f64> {
        match self {
            Self::Force(_) => None,
            Self::Torque(torque) => Some(mu_star * torque),
        }
    }
}
