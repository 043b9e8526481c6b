//! `velocity`: kinetic friction that falls with speed.

use serde::{Deserialize, Serialize};
use slipfront::Weakening;

use crate::case_file::check::{Check, Checked};
use crate::case_file::error::CaseError;
use crate::case_file::key::{KeyKind, SPEED_STAR, StarUnit, key, number, within};
use crate::case_file::serde_names::names_of;
use crate::case_file::synonyms::{Synonyms, synonyms};
use crate::key_rows;
use slipfront_base::number_format::four_digits;

pub(super) const SYNONYMS: Synonyms = synonyms! {
    "weakening" "stribeck" "weakening_speed" "velocity_weakening" "critical_speed" "v_c" =>
        "velocity weakening is `friction.velocity` = { law = \"weakening\", v_c_star = 0.1, ratio = 0.5 }";
};

key_rows! {
    /// `velocity`: kinetic friction that falls with speed, mu_k [ratio + (1 - ratio)/(1 + v/v_c)].
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Velocity checked {
        /// The law.
        pub law: VelocityLaw = key("", KeyKind::Words(names_of::<VelocityLaw>)),
        /// Speed at which half of the fall is reached, in the unit of V*.
        pub v_c_star: f64 = key("", SPEED_STAR).star(StarUnit::Speed),
        /// Kinetic friction at high speed over that at rest.
        pub ratio: f64 = key("", number(within(0.0, 1.0),
            "it is the ratio of kinetic friction at high speed to kinetic friction at rest")),
    }
}

/// Dependence of kinetic friction on speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VelocityLaw {
    /// Friction that falls with speed.
    Weakening,
}

impl Checked for VelocityLaw {}

impl Velocity {
    /// The law of the model.
    pub(super) fn law(self) -> Weakening {
        Weakening {
            critical_speed: self.v_c_star,
            ratio: self.ratio,
        }
    }
}

/// The law in words, to end a sentence about static and kinetic friction.
pub(super) fn in_words(law: &Weakening) -> String {
    let (ratio, speed) = (four_digits(law.ratio), four_digits(law.critical_speed));
    format!(", falling to {ratio} mu_k above about V* = {speed}")
}
