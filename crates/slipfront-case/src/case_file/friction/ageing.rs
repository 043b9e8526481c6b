//! `ageing`: static friction that grows while a block sticks.

use serde::{Deserialize, Serialize};
use slipfront::Ageing as Law;

use crate::case_file::check::{Check, Checked};
use crate::case_file::error::CaseError;
use crate::case_file::key::{KeyKind, StarUnit, TIME_STAR, key, number, within};
use crate::case_file::serde_names::names_of;
use crate::case_file::synonyms::{Synonyms, synonyms};
use crate::key_rows;
use slipfront_base::number_format::four_digits;

pub(super) const SYNONYMS: Synonyms = synonyms! {
    "aging" "healing" "strengthening" =>
        "ageing of static friction is `friction.ageing` = { law = \"logarithmic\", beta = 0.02, time_star = \
        1 }";
};

key_rows! {
    /// `ageing`: static friction that grows while a block is stuck, mu_s [1 + beta ln(1 + t/time)].
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Ageing checked {
        /// The law.
        pub law: AgeingLaw = key("", KeyKind::Words(names_of::<AgeingLaw>)),
        /// Growth per unit of the logarithm.
        pub beta: f64 = key("", number(within(0.0, 10.0), "it is the growth per unit of the logarithm of the age")),
        /// Time after which the growth shows, t*.
        pub time_star: f64 = key("", TIME_STAR).star(StarUnit::Time),
    }
}

/// Dependence of static friction on age.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AgeingLaw {
    /// Growth with the logarithm of the age.
    Logarithmic,
}

impl Checked for AgeingLaw {}

impl Ageing {
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
