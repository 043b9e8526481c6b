//! `[load]`: the normal load.

use serde::{Deserialize, Serialize};

use super::check::Check;
use super::error::CaseError;
use super::key::{ARRAY, KeyKind, between, key, number, quantity, within};
use super::probe::names_of;
use super::values::word;
use crate::key_rows;
use crate::quantity::Pressure;

key_rows! {
    /// `[load]`: the normal load.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Load {
        /// Normal load over the whole area, textured or not.
        pub pressure: Pressure = key("\"100 kPa\"", quantity("Pa", within(1e-9, 1e15))).paper("P")
            .title("pressure", "P", "Pa"),
        /// Whether the blocks in contact carry the load of the textured ones; `false` leaves P l^2 to each,
        /// for comparison.
        pub redistribute: bool = key("true", KeyKind::Switch),
        /// A pressure that rises along x or y, with the mean `pressure`: p = P (1 + slope (2 x/L - 1)).
        #[serde(skip_serializing_if = "Option::is_none")]
        pub profile: Option<Profile> =
            key("", KeyKind::Table("{ along = \"x\", relative_slope = 0.5 }", Profile::KEYS))
                .or("pressure_field"),
        /// Local pressure over `pressure`, block by block, in place of `profile`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub pressure_field: Option<String> = key("", ARRAY).or("profile"),
    }
}

key_rows! {
    /// A profile along an axis, `1 + relative_slope (2 x/L - 1)` times the mean.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Profile {
        /// The axis.
        #[serde(deserialize_with = "word")]
        pub along: Along = key("", KeyKind::Words(names_of::<Along>)),
        /// Half the difference between both ends over the mean.
        pub relative_slope: f64 = key("", RELATIVE_SLOPE),
    }
}

const RELATIVE_SLOPE: KeyKind = number(between(-1.0, 1.0), "1 would leave no load on an edge");

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
