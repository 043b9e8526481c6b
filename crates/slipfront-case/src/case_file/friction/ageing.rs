//! `ageing`: static friction that grows while a block sticks.

use serde::{Deserialize, Serialize};
use slipfront::Ageing as Law;

use crate::case_file::check::Check;
use crate::case_file::error::CaseError;
use crate::case_file::key::{KeyKind, StarUnit, TIME_STAR, key, number, within};
use crate::case_file::probe::names_of;
use crate::case_file::values::word;
use crate::key_rows;
use slipfront_base::number_format::four_digits;

pub(super) const SYNONYMS: &[(&str, &str)] =
    &[("aging", ADVICE), ("healing", ADVICE), ("strengthening", ADVICE)];
const ADVICE: &str =
    "ageing of static friction is `friction.ageing` = { law = \"logarithmic\", beta = 0.02, time_star = 1 }";

key_rows! {
    /// `ageing`: static friction that grows while a block is stuck, mu_s [1 + beta ln(1 + t/time)].
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Ageing {
        /// The law.
        #[serde(deserialize_with = "word")]
        pub law: AgeingLaw = key("", KeyKind::Words(names_of::<AgeingLaw>)),
        /// Growth per unit of the logarithm.
        pub beta: f64 = key("", BETA),
        /// Time after which the growth shows, t*.
        pub time_star: f64 = key("", TIME_STAR).star(StarUnit::Time),
    }
}

/// Kind of the key `beta`: growth with age.
const BETA: KeyKind = number(
    within(0.0, 10.0),
    "it is the growth per unit of the logarithm of the age",
);

/// Dependence of static friction on age.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AgeingLaw {
    /// Growth with the logarithm of the age.
    Logarithmic,
}

impl Ageing {
    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        check.value_of(&BETA, "ageing.beta", &self.beta)?;
        check.value_of(&TIME_STAR, "ageing.time_star", &self.time_star)
    }

    /// The law of the model.
    pub(super) fn law(self) -> Law {
        Law {
            beta: self.beta,
            time: self.time_star,
        }
    }
}

/// The law in words, to end a sentence about static and kinetic friction.
pub(super) fn in_words(law: &Law) -> String {
    let (beta, time) = (four_digits(law.beta), four_digits(law.time));
    format!(", ageing by {beta} ln(1 + t*/{time})")
}
