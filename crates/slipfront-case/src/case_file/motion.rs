//! `[load]` and `[friction]`: what acts on the slider below.

use std::ops::Bound::Included;

use serde::{Deserialize, Serialize};
use slipfront::FrictionLaw;

use super::check::Check;
use super::choice::keys_with_choice;
use super::error::CaseError;
use super::key_table::{MAX_R_STAR, RELATIVE_SLOPE};
use super::values::word;
use crate::quantity::Pressure;

/// `[load]`: the normal load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Pressure over the whole area (P), Pa.
    pub pressure: Pressure,
    /// Whether the blocks in contact carry the load of the textured ones; otherwise every block keeps P l^2.
    pub redistribute: bool,
    /// A pressure that rises along an axis and has the mean `pressure`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub profile: Option<Profile>,
    /// A file of local pressures over `pressure`, block by block: `.npy` or `.csv`, shape (ny, nx).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pressure_field: Option<String>,
}

/// What rises along an axis, `1 + relative_slope (2 x/L - 1)` times its mean.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// The axis.
    #[serde(deserialize_with = "word")]
    pub along: Along,
    /// Half the difference between both ends over the mean; more than -1, less than 1.
    pub relative_slope: f64,
}

/// An axis of the lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Along {
    /// Along rows.
    X,
    /// Along columns.
    Y,
}

impl Load {
    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        check.value("pressure", &self.pressure)?;
        if let Some(profile) = &self.profile {
            check.value_of(&RELATIVE_SLOPE, "profile.relative_slope", &profile.relative_slope)?;
        }
        check.value("pressure_field", &self.pressure_field)
    }
}

/// `[friction]`: the law and the local coefficients (Eqs. 1 and 4).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "FrictionKeys", into = "FrictionKeys")]
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
    /// Shear strength of the contact without load (tau_a), which adds `tau_a l^2` to the static threshold, Pa.
    pub adhesion: Pressure,
    /// The same of kinetic friction, Pa.
    pub adhesion_kinetic: Pressure,
}

/// The mean kinetic coefficient.
#[derive(Clone, Debug, PartialEq)]
pub enum KineticFriction {
    /// `r_star`: R*, the mean kinetic over the mean static coefficient, 0 to 10.
    RStar(f64),
    /// `mu_kinetic`: the mean kinetic coefficient itself, 0 to 10 times `mu_static`.
    MuKinetic(f64),
}

impl Friction {
    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        check.value("mu_static", &self.mu_static)?;
        self.kinetic.check(check)?;
        if let KineticFriction::MuKinetic(mu_kinetic) = self.kinetic {
            let bounds = (Included(0.0), Included(MAX_R_STAR * self.mu_static));
            let remark = format!("at most {MAX_R_STAR} times `mu_static`");
            check.number_within("mu_kinetic", mu_kinetic, bounds, &remark)?;
        }
        check.value("sigma_static_star", &self.sigma_static_star)?;
        check.value("sigma_kinetic_star", &self.sigma_kinetic_star)?;
        check.value("seed", &self.seed)?;
        check.value("mu_static_field", &self.mu_static_field)?;
        check.value("mu_kinetic_field", &self.mu_kinetic_field)?;
        check.value("adhesion", &self.adhesion)?;
        check.value("adhesion_kinetic", &self.adhesion_kinetic)
    }
}

keys_with_choice! {
    Friction: FrictionKeys {
        #[serde(deserialize_with = "word")]
        law: FrictionLaw,
        mu_static: f64,
        (kinetic: KineticFriction {
            r_star: f64 => RStar,
            mu_kinetic: f64 => MuKinetic,
            _ => "friction needs `r_star` or `mu_kinetic`"
        }),
        sigma_static_star: f64,
        sigma_kinetic_star: f64,
        seed: u64,
        mu_static_field: Option<String>,
        mu_kinetic_field: Option<String>,
        adhesion: Pressure,
        adhesion_kinetic: Pressure,
    }
}
