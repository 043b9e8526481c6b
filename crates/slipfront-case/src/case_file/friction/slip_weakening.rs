//! `slip_weakening`: strength that falls with slip.

use serde::{Deserialize, Serialize};
use slipfront::{Scales, SlipWeakening};

use crate::case_file::check::{Check, Checked};
use crate::case_file::error::CaseError;
use crate::case_file::key::{KeyKind, SLIP_STAR, StarUnit, key, quantity, within};
use crate::case_file::synonyms::{Synonyms, synonyms};
use crate::key_rows;
use crate::quantity::Length;
use slipfront_base::number_format::four_digits;

pub(super) const SYNONYMS: Synonyms = synonyms! {
    "slip_weakening_length" "weakening_length" "fracture_energy" =>
        "slip weakening is `friction.slip_weakening` = { length = \"0.5 um\" }, with the fracture energy (S \
        - K) length/2 of a block";
    "healing_time" => "the time of healing is `friction.healing_time_star`, in t*";
};

/// Reason why other laws cannot be combined with slip weakening.
pub(super) const ALONE: &str = "it cannot be combined with `slip_weakening`; leave one of them out";

/// Reason why healing needs slip weakening.
pub(super) const ELSEWHERE: &str = "it belongs to `slip_weakening`; set that, or leave it out";

key_rows! {
    /// `slip_weakening`: the slip over which strength falls from the static to the kinetic threshold.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct SlipWeakeningLength checked {
        /// Slip D_c, m.
        pub length: Option<Length> = key("", quantity("m", within(1e-18, 1e3))),
        /// Slip D_c in units of P mu_s l^2/(E h).
        pub length_star: Option<f64> = key("", SLIP_STAR).star(StarUnit::Displacement),
    }
}

impl SlipWeakeningLength {
    /// Refuses no length, and two.
    pub(super) fn expect_one_length(&self, check: &Check) -> Result<(), CaseError> {
        if self.length.is_some() == self.length_star.is_some() {
            return check.refuse("slip_weakening", |key| {
                format!("`{key}` needs one length: `length` with its unit, or `length_star`")
            });
        }
        Ok(())
    }

    /// The law of the model.
    pub(super) fn law(&self, scales: &Scales, healing_time: Option<f64>) -> SlipWeakening {
        let in_units = self
            .length
            .as_ref()
            .map(|length| length.si() / scales.displacement());
        SlipWeakening {
            // One of the two is given.
            length: in_units.or(self.length_star).unwrap_or(f64::INFINITY),
            healing_time,
        }
    }
}

/// The law in words, to end a sentence about static and kinetic friction.
pub(super) fn in_words(law: &SlipWeakening) -> String {
    let healing = law.healing_time.map_or(String::new(), |time| {
        format!(", full strength again after t* = {} at rest", four_digits(time))
    });
    format!(
        ", slip weakening over D_c* = {}{healing}",
        four_digits(law.length)
    )
}
