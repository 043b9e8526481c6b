//! `[load]`: the normal load, and a dead shear load.

use serde::{Deserialize, Serialize};
use slipfront::Scales;

use super::check::{Check, Checked};
use super::error::CaseError;
use super::key::{
    ARRAY, KeyKind, STIFFNESS_PER_AREA, StarUnit, above, between, key, number, quantity, within,
};
use super::serde_names::names_of;
use super::words::Motion;
use crate::key_rows;
use crate::quantity::{Length, Pressure, StiffnessPerArea};

key_rows! {
    /// `[load]`: the normal load, and a dead shear load.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Load checked {
        /// Normal load divided by the whole area, textured or not.
        pub pressure: Pressure = key("\"100 kPa\"", quantity("Pa", within(1e-9, 1e15))).paper("P")
            .title("pressure", "P", "Pa"),
        /// Which blocks in contact carry the load of the textured ones: all of them in equal parts; with
        /// `within`, for each textured block those at most so far away; with `false` none, for comparison. In
        /// a bulk body `true` is a `within` of the pitch, and a texture without one needs a distance.
        pub redistribute: Redistribute = key("true", KeyKind::Special("`true`, `false`, or a distance such as `{ within = \"400 um\" }`, 1e-12 to 1e3 m"))
            .note("See [texture and load](../model.md#texture-and-load)."),
        /// Pressure that rises linearly along x or y, with the mean `pressure`: p = P (1 + slope (2 x/L -
        /// 1)).
        pub profile: Option<Profile> =
            key("", KeyKind::Table("{ along = \"x\", relative_slope = 0.5 }", Profile::KEYS))
                .or(&["pressure_field"]),
        /// Local pressure relative to `pressure`, block by block, instead of `profile`.
        pub pressure_field: Option<String> = key("", ARRAY).or(&["profile"]),
        /// Dead shear load: a stress along the drive on every block, textured or not, that acts from the
        /// start on, whatever moves; of an upright sheet on its lowest row. Below 0 it acts against the
        /// drive.
        pub shear: Option<Pressure> = key("", quantity("Pa", within(-1e15, 1e15))).or(&["shear_star"])
            .title("shear load", "\u{3c4}\u{2080}", "Pa").note(DEAD_LOAD),
        /// Dead shear load over P mu_s, instead of `shear`: its contribution to mu\*.
        pub shear_star: Option<f64> = key("", number(within(-1e3, 1e3), "it is over P mu_s, of which blocks hold 1"))
            .star(StarUnit::One).or(&["shear"]).title("shear load", "\u{3c4}\u{2080}*", ""),
        /// Local shear load relative to `shear` or `shear_star`, block by block; it may be negative.
        pub shear_field: Option<String> = key("", ARRAY),
        /// Stiffness per area of the foundation along y under the blocks in contact of an upright sheet,
        /// which bears their load: normal forces follow it.
        pub foundation: Option<StiffnessPerArea> = key("", STIFFNESS_PER_AREA).or(&["foundation_star"])
            .title("stiffness of the foundation", "K\u{2099}", "N/m\u{b3}")
            .note("See [upright sheets](../model.md#an-upright-sheet)."),
        /// Stiffness of the foundation under a block in contact, relative to E h with the thickness h.
        pub foundation_star: Option<f64> = key("", number(above(0.0, 1e3),
            "it is relative to E h, with the thickness h, and a spring between blocks has 0.75"))
            .star(StarUnit::SpringOfBlock).or(&["foundation"])
            .title("stiffness of the foundation", "k\u{2099}*", ""),
    }
}

const DEAD_LOAD: &str = "See [dead loads](../model.md#dead-loads).";

key_rows! {
    /// A profile along an axis, `1 + relative_slope (2 x/L - 1)` times the mean.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Profile checked {
        /// The axis.
        pub along: Along = key("", KeyKind::Words(names_of::<Along>)),
        /// Half the difference between both ends over the mean.
        pub relative_slope: f64 = key("", number(between(-1.0, 1.0), "1 would leave no load on an edge")),
    }
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
        self.check_values(check)?;
        if self.shear_field.is_some() && self.shear_key().is_none() {
            return check.refuse("shear_field", |key| {
                format!("`{key}` is relative to `load.shear` or `load.shear_star`: give one of them")
            });
        }
        Ok(())
    }

    /// Name of the key that gives the shear load, if one does.
    pub fn shear_key(&self) -> Option<&'static str> {
        let of_star = self.shear_star.map(|_| "shear_star");
        self.shear.as_ref().map(|_| "shear").or(of_star)
    }

    /// Refuses a shear load with a drive for which none is derived.
    pub(super) fn check_shear(&self, check: &Check, motion: Motion) -> Result<(), CaseError> {
        let Some(key) = self.shear_key() else {
            return Ok(());
        };
        if motion != Motion::Rotation {
            return Ok(());
        }
        check.refuse(key, |key| {
            format!(
                "`{key}` does not go with `drive.motion` = \"rotation\": it acts along one direction, and this drive pulls every \
                 block another way; leave one of them out"
            )
        })
    }

    /// Stiffness of the foundation under a block in contact, in units of `E h`; 0 without one.
    pub(crate) fn foundation_of_a_block(&self, scales: &Scales) -> f64 {
        let per_area = self.foundation.as_ref();
        let of_area = per_area.map(|per_area| scales.stiffness_of_area(per_area.si()));
        self.foundation_star.or(of_area).unwrap_or(0.0)
    }
}

/// The blocks in contact that carry the load of textured blocks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "expected true, false, or a distance such as { within = \"400 um\" }"
)]
pub enum Redistribute {
    /// All blocks in contact, or none. With none, the load of textured blocks is lost.
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
