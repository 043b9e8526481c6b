//! `[load]`: the normal load.

use serde::{Deserialize, Serialize};

use super::check::{Check, Checked};
use super::error::CaseError;
use super::key::{ARRAY, KeyKind, between, key, number, quantity, within};
use super::probe::names_of;
use super::values::word;
use crate::key_rows;
use crate::quantity::{Length, Pressure};

key_rows! {
    /// `[load]`: the normal load.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Load {
        /// Normal load over the whole area, textured or not.
        pub pressure: Pressure = key("\"100 kPa\"", quantity("Pa", within(1e-9, 1e15))).paper("P")
            .title("pressure", "P", "Pa"),
        /// Which blocks in contact carry the load of the textured ones: all of them in equal parts; with
        /// `within`, for each textured block those at most so far away; with `false` none, for comparison. In
        /// a bulk body `true` is a `within` of the pitch, and a texture without one needs a distance.
        pub redistribute: Redistribute = key("true", KeyKind::Special("`true`, `false`, or a distance such as `{ within = \"400 um\" }`, 1e-12 to 1e3 m"))
            .note("See [texture and load](../model.md#texture-and-load)."),
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
        check.value("redistribute", &self.redistribute)?;
        if let Some(profile) = &self.profile {
            check.value_of(&RELATIVE_SLOPE, "profile.relative_slope", &profile.relative_slope)?;
        }
        check.value("pressure_field", &self.pressure_field)
    }
}

/// The blocks in contact that carry the load of textured ones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "expected true, false, or a distance such as { within = \"400 um\" }"
)]
pub enum Redistribute {
    /// All blocks in contact, or none: then the load of textured blocks is lost.
    All(bool),
    /// The blocks in contact near each textured block.
    Near(Near),
}

/// Blocks in contact that are near a textured block.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Near {
    /// Largest distance between the centres.
    pub within: Length,
}

impl Checked for Redistribute {
    fn complaint(&self, _: &KeyKind) -> Option<String> {
        match self {
            Self::All(_) => None,
            Self::Near(Near { within: distance }) => distance.complaint(&quantity("m", within(1e-12, 1e3))),
        }
    }
}
