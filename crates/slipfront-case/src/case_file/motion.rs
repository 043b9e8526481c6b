//! `[load]`: the normal load.

use serde::{Deserialize, Serialize};

use super::check::Check;
use super::error::CaseError;
use super::key_table::RELATIVE_SLOPE;
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

/// A profile along an axis, `1 + relative_slope (2 x/L - 1)` times the mean.
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
    /// The axis along rows.
    X,
    /// The axis along columns.
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
