//! `[load]`, `[drive]` and `[friction]`: what acts on the slider.

use serde::{Deserialize, Serialize};

use slipfront::FrictionLaw;

use std::ops::Bound::Included;

use super::check::Check;
use super::error::CaseError;
use super::key_table::MAX_R_STAR;
use super::values::word;
use crate::quantity::{Pressure, Speed};

/// `[load]`: the normal load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Load {
    /// Pressure over the whole area (P), Pa.
    pub pressure: Pressure,
    /// Whether the blocks in contact carry the load of the textured ones; otherwise every block keeps P l^2.
    pub redistribute: bool,
}

impl Default for Load {
    fn default() -> Self {
        Self {
            pressure: Pressure::from_text("100 kPa", 1e5),
            redistribute: true,
        }
    }
}

impl Load {
    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        check.quantity("pressure", &self.pressure)
    }
}

/// `[drive]`: how the slider is pulled.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "DriveKeys", into = "DriveKeys")]
pub struct Drive {
    /// Speed of the drive: `v_star` or `speed`.
    pub speed: DriveSpeed,
    /// Direction of the drive (theta), degrees from x towards y, -360 to 360.
    pub direction: f64,
}

/// The speed of the drive.
#[derive(Clone, Debug, PartialEq)]
pub enum DriveSpeed {
    /// `v_star`: V* = sqrt(E rho) V/(P `mu_static`) (Eq. 11), more than 0, at most 10.
    VStar(f64),
    /// `speed`: V, m/s.
    Speed(Speed),
}

impl Default for Drive {
    fn default() -> Self {
        Self {
            speed: DriveSpeed::VStar(0.03),
            direction: 0.0,
        }
    }
}

impl Drive {
    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        match &self.speed {
            DriveSpeed::VStar(v_star) => check.number("v_star", *v_star)?,
            DriveSpeed::Speed(speed) => check.quantity("speed", speed)?,
        }
        check.number("direction", self.direction)
    }
}

/// The keys of `[drive]` as they stand in the file.
#[derive(Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct DriveKeys {
    v_star: Option<f64>,
    speed: Option<Speed>,
    direction: f64,
}

impl Default for DriveKeys {
    fn default() -> Self {
        // No speed here: either key replaces the default.
        let mut keys = Self::from(Drive::default());
        keys.v_star = None;
        keys
    }
}

impl From<DriveKeys> for Drive {
    fn from(keys: DriveKeys) -> Self {
        let speed = match (keys.speed, keys.v_star) {
            (Some(speed), _) => DriveSpeed::Speed(speed),
            (None, Some(v_star)) => DriveSpeed::VStar(v_star),
            (None, None) => Self::default().speed,
        };
        Self {
            speed,
            direction: keys.direction,
        }
    }
}

impl From<Drive> for DriveKeys {
    fn from(drive: Drive) -> Self {
        let (v_star, speed) = match drive.speed {
            DriveSpeed::VStar(v_star) => (Some(v_star), None),
            DriveSpeed::Speed(speed) => (None, Some(speed)),
        };
        Self {
            v_star,
            speed,
            direction: drive.direction,
        }
    }
}

/// `[friction]`: the law and the local coefficients (Eqs. 1 and 4).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "FrictionKeys", into = "FrictionKeys")]
pub struct Friction {
    /// Which reading of Eq. 4 is integrated.
    pub law: FrictionLaw,
    /// Mean of the local static coefficients, and the scale of all forces; more than 0, at most 100.
    pub mu_static: f64,
    /// Mean of the local kinetic coefficients: `r_star` or `mu_kinetic`.
    pub kinetic: KineticFriction,
    /// Standard deviation of the static coefficients over their mean, 0 to 1.
    pub sigma_static_star: f64,
    /// Standard deviation of the kinetic coefficients over *their* mean, 0 to 1.
    pub sigma_kinetic_star: f64,
    /// Seed of the random coefficients, 0 to 2^63 - 1.
    pub seed: u64,
    /// A file of static coefficients, block by block, in place of random ones: `.npy` or `.csv`, shape (ny, nx).
    pub mu_static_field: Option<String>,
    /// A file of kinetic coefficients, block by block, in place of random ones: `.npy` or `.csv`, shape (ny, nx).
    pub mu_kinetic_field: Option<String>,
}

/// The mean kinetic coefficient.
#[derive(Clone, Debug, PartialEq)]
pub enum KineticFriction {
    /// `r_star`: R*, the mean kinetic over the mean static coefficient, 0 to 10.
    RStar(f64),
    /// `mu_kinetic`: the mean kinetic coefficient itself, 0 to 10 times `mu_static`.
    MuKinetic(f64),
}

impl Default for Friction {
    fn default() -> Self {
        Self {
            law: FrictionLaw::Projection,
            mu_static: 1.0,
            kinetic: KineticFriction::RStar(0.5),
            sigma_static_star: 0.05,
            sigma_kinetic_star: 0.05,
            seed: 1,
            mu_static_field: None,
            mu_kinetic_field: None,
        }
    }
}

impl Friction {
    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        check.number("mu_static", self.mu_static)?;
        match self.kinetic {
            KineticFriction::RStar(r_star) => check.number("r_star", r_star)?,
            KineticFriction::MuKinetic(mu_kinetic) => {
                let bounds = (Included(0.0), Included(MAX_R_STAR * self.mu_static));
                let remark = format!("at most {MAX_R_STAR} times `mu_static`");
                check.number_within("mu_kinetic", mu_kinetic, bounds, &remark)?;
            }
        }
        check.number("sigma_static_star", self.sigma_static_star)?;
        check.number("sigma_kinetic_star", self.sigma_kinetic_star)?;
        check.whole("seed", self.seed)?;
        for (key, file) in [
            ("mu_static_field", &self.mu_static_field),
            ("mu_kinetic_field", &self.mu_kinetic_field),
        ] {
            if let Some(file) = file {
                check.file(key, file)?;
            }
        }
        Ok(())
    }
}

/// The keys of `[friction]` as they stand in the file.
#[derive(Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct FrictionKeys {
    #[serde(deserialize_with = "word")]
    law: FrictionLaw,
    mu_static: f64,
    r_star: Option<f64>,
    mu_kinetic: Option<f64>,
    sigma_static_star: f64,
    sigma_kinetic_star: f64,
    seed: u64,
    mu_static_field: Option<String>,
    mu_kinetic_field: Option<String>,
}

impl Default for FrictionKeys {
    fn default() -> Self {
        // No kinetic coefficient here: either key replaces the default.
        let mut keys = Self::from(Friction::default());
        keys.r_star = None;
        keys
    }
}

impl From<FrictionKeys> for Friction {
    fn from(keys: FrictionKeys) -> Self {
        let kinetic = match (keys.mu_kinetic, keys.r_star) {
            (Some(mu_kinetic), _) => KineticFriction::MuKinetic(mu_kinetic),
            (None, Some(r_star)) => KineticFriction::RStar(r_star),
            (None, None) => Self::default().kinetic,
        };
        Self {
            law: keys.law,
            mu_static: keys.mu_static,
            kinetic,
            sigma_static_star: keys.sigma_static_star,
            sigma_kinetic_star: keys.sigma_kinetic_star,
            seed: keys.seed,
            mu_static_field: keys.mu_static_field,
            mu_kinetic_field: keys.mu_kinetic_field,
        }
    }
}

impl From<Friction> for FrictionKeys {
    fn from(friction: Friction) -> Self {
        let (r_star, mu_kinetic) = match friction.kinetic {
            KineticFriction::RStar(r_star) => (Some(r_star), None),
            KineticFriction::MuKinetic(mu_kinetic) => (None, Some(mu_kinetic)),
        };
        Self {
            law: friction.law,
            mu_static: friction.mu_static,
            r_star,
            mu_kinetic,
            sigma_static_star: friction.sigma_static_star,
            sigma_kinetic_star: friction.sigma_kinetic_star,
            seed: friction.seed,
            mu_static_field: friction.mu_static_field,
            mu_kinetic_field: friction.mu_kinetic_field,
        }
    }
}
