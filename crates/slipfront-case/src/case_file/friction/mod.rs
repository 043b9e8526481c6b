//! The table `[friction]`: the law, the local coefficients and their dependences.
//!
//! Each law is a file, with its keys, the words that people try for them, the law of the model that they make, and the
//! sentences about it. This file holds the common part, and a row for each law.

mod ageing;
mod contact_springs;
mod correlation;
mod rate_and_state;
mod slip_weakening;
mod weakening;

use std::ops::Bound::Included;

use serde::{Deserialize, Serialize};
use slipfront::{ContactSprings, Coulomb, FrictionLaw, Model, Scales};

pub use self::ageing::{Ageing, AgeingLaw};
pub use self::slip_weakening::SlipWeakeningLength;
pub use self::weakening::{Velocity, VelocityLaw};
use super::check::Check;
use super::choice::keys_with_choice;
use super::error::CaseError;
use super::key::{ARRAY, Key, KeyKind, above, count, joined, key, number, quantity, whole, within};
use super::length_of_a_block::LengthOfABlock;
use super::probe::names_of;
use super::values::word;
use crate::quantity::{Length, Pressure, StiffnessPerArea};
use slipfront_base::number_format::four_digits;

const SIGMA: KeyKind = number(
    within(0.0, 1.0),
    "it is relative to the mean coefficient, so that 0.05 is 5 percent",
);
const SHEAR_STRENGTH: KeyKind = quantity("Pa", within(0.0, 1e15));
/// TOML's largest integer.
const MAX_SEED: u64 = i64::MAX.unsigned_abs();
/// Largest mean kinetic over mean static coefficient.
const MAX_R_STAR: f64 = 10.0;

#[rustfmt::skip]
const COEFFICIENTS: &[Key] = &[
    key("law", "\"projection\"", KeyKind::Words(names_of::<Law>), "the reading of Eq. 4, or rate and state in its place"),
    key("mu_static", "1.0", number(above(0.0, 100.0), "it is the scale of all forces"), "mean static coefficient")
        .title("mean static coefficient", "\u{3bc}\u{209b}", ""),
    key("r_star", "0.5", number(within(0.0, MAX_R_STAR), "it is the kinetic over the static coefficient"),
        "mean kinetic over mean static coefficient").or("mu_kinetic").title("friction ratio", "R*", ""),
    key("mu_kinetic", "", KeyKind::Special("0 to 10 times `mu_static`"), "mean kinetic coefficient")
        .or("r_star").title("mean kinetic coefficient", "\u{3bc}\u{2096}", ""),
    key("sigma_static_star", "0.05", SIGMA, "standard deviation of the static coefficients over their mean")
        .title("spread of static coefficients", "\u{3c3}\u{209b}*", ""),
    key("sigma_kinetic_star", "0.05", SIGMA, "standard deviation of the kinetic coefficients over *their* mean")
        .title("spread of kinetic coefficients", "\u{3c3}\u{2096}*", ""),
    key("seed", "1", whole(0, MAX_SEED), "seed of the random coefficients").title("seed", "", ""),
    key("mu_static_field", "", ARRAY, "static coefficients block by block, in place of random ones"),
    key("mu_kinetic_field", "", ARRAY, "kinetic coefficients block by block, in place of random ones"),
    key("adhesion", "\"0 Pa\"", SHEAR_STRENGTH, "shear strength without load, added to the static threshold of the blocks in contact")
        .title("adhesion", "\u{3c4}\u{2090}", "Pa"),
    key("adhesion_kinetic", "\"0 Pa\"", SHEAR_STRENGTH, "the same, added to their kinetic friction")
        .title("kinetic adhesion", "\u{3c4}\u{2090}\u{2096}", "Pa"),
];

#[rustfmt::skip]
const CONTACT: &[Key] = &[
    key("contact", "\"rigid\"", KeyKind::Words(names_of::<ContactModel>), "what holds a block until its threshold"),
];

/// The keys of the coefficients and of every law, in the order of the documentation.
const LISTS: &[&[Key]] = &[
    COEFFICIENTS,
    correlation::KEYS,
    weakening::KEYS,
    ageing::KEYS,
    slip_weakening::KEYS,
    CONTACT,
    contact_springs::KEYS,
    rate_and_state::KEYS,
];
pub(super) const KEYS: &[Key] = &joined::<{ count(LISTS) }>(LISTS);

/// Words that people try first, each with the advice on it, by law.
pub(super) const SYNONYMS: &[&[(&str, &str)]] = &[
    correlation::SYNONYMS,
    weakening::SYNONYMS,
    ageing::SYNONYMS,
    slip_weakening::SYNONYMS,
    contact_springs::SYNONYMS,
    rate_and_state::SYNONYMS,
];

/// Law of friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Law {
    /// Eq. 4, integrated implicitly.
    Projection,
    /// Eq. 4, explicit, for comparison.
    Reversal,
    /// Eq. 4 as printed, for comparison.
    Literal,
    /// Coefficients that follow speed and state.
    RateAndState,
}

/// Connection that holds a block until its threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactModel {
    /// Contact that does not yield.
    Rigid,
    /// Spring between block and substrate, which breaks.
    Springs,
}

/// `[friction]`: the law and the local coefficients (Eqs. 1 and 4).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "FrictionKeys", into = "FrictionKeys")]
pub struct Friction {
    /// Which reading of Eq. 4 is integrated, or rate and state in its place.
    pub law: Law,
    /// Mean of the local static coefficients, and the scale of all forces; more than 0, at most 100.
    pub mu_static: f64,
    /// Mean of the local kinetic coefficients: `r_star` or `mu_kinetic`.
    pub kinetic: KineticFriction,
    /// Standard deviation of the static coefficients over their mean, 0 to 1.
    pub sigma_static_star: f64,
    /// Standard deviation of the kinetic coefficients over the mean of the kinetic ones, 0 to 1.
    pub sigma_kinetic_star: f64,
    /// Seed of the random coefficients, 0 to 2^63 - 1.
    pub seed: u64,
    /// A file of static coefficients, block by block, in place of random ones: `.npy` or `.csv`, shape (ny, nx).
    pub mu_static_field: Option<String>,
    /// A file of kinetic coefficients, block by block, in place of random ones: `.npy` or `.csv`, shape (ny, nx).
    pub mu_kinetic_field: Option<String>,
    /// Shear strength of the contact without load (tau_a), which adds `tau_a l^2` to the static threshold, Pa.
    pub adhesion: Pressure,
    /// Shear strength of the sliding contact without load, which adds to the kinetic threshold, Pa.
    pub adhesion_kinetic: Pressure,
    /// Length over which random coefficients are alike (xi), m; every block draws its own if not given.
    pub correlation_length: Option<Length>,
    /// Kinetic friction that falls with speed.
    pub velocity: Option<Velocity>,
    /// Static friction that grows while a block is stuck.
    pub ageing: Option<Ageing>,
    /// Strength that falls with slip.
    pub slip_weakening: Option<SlipWeakeningLength>,
    /// Time for which a block must be stuck to be whole again, t*; never if not given.
    pub healing_time_star: Option<f64>,
    /// Connection that holds a block until its threshold.
    pub contact: ContactModel,
    /// Stiffness of the spring in the contact of a block over `young_modulus` times the thickness; for `contact` =
    /// "springs".
    pub contact_stiffness_star: Option<f64>,
    /// Stiffness of the springs in the contact per area, N/m^3; for `contact` = "springs".
    pub contact_stiffness_per_area: Option<StiffnessPerArea>,
    /// Whether a spring that forms again has another threshold.
    pub redraw: bool,
    /// Direct effect of rate and state.
    pub a: Option<f64>,
    /// Evolution effect of rate and state.
    pub b: Option<f64>,
    /// Slip over which the state of rate and state follows, in units of P mu_s l^2/(E h).
    pub d_c_star: Option<f64>,
    /// Reference speed of rate and state, in the unit of V*.
    pub v_0_star: Option<f64>,
    /// Coefficient of steady sliding of rate and state at the reference speed; `mu_static` if not given.
    pub mu_0: Option<f64>,
    /// State of rate and state at the start, t*; `d_c_star/v_0_star` if not given.
    pub theta_0_star: Option<f64>,
    /// Speed above which a block counts as sliding, in the unit of V*; a tenth of V* if not given.
    pub slip_speed_star: Option<f64>,
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
        check.value("adhesion_kinetic", &self.adhesion_kinetic)?;
        check.value("correlation_length", &self.correlation_length)?;
        if let Some(velocity) = &self.velocity {
            velocity.check(check)?;
        }
        if let Some(ageing) = &self.ageing {
            ageing.check(check)?;
        }
        if let Some(slip_weakening) = &self.slip_weakening {
            slip_weakening.check(check)?;
        }
        check.value("healing_time_star", &self.healing_time_star)?;
        check.value("contact_stiffness_star", &self.contact_stiffness_star)?;
        check.value("contact_stiffness_per_area", &self.contact_stiffness_per_area)?;
        for (key, value) in rate_and_state::KEYS.iter().zip(self.rate_and_state()) {
            check.value(key.name, &value)?;
        }
        self.check_together(check)
    }

    /// Whether friction has a static coefficient.
    pub fn has_static_coefficient(&self) -> bool {
        self.law != Law::RateAndState
    }

    /// Whether friction has a kinetic coefficient beside the static one.
    pub fn has_kinetic_coefficient(&self) -> bool {
        self.has_static_coefficient() && self.contact == ContactModel::Rigid
    }

    /// R*, the mean kinetic over the mean static coefficient; 0 where there is no kinetic one.
    pub fn mean_ratio(&self) -> f64 {
        match self.kinetic {
            _ if !self.has_kinetic_coefficient() => 0.0,
            KineticFriction::RStar(r_star) => r_star,
            KineticFriction::MuKinetic(mu) => mu / self.mu_static,
        }
    }

    /// Lengths of friction that equal the length of a block because no key gives them.
    pub(crate) fn lengths_of_a_block(&self) -> impl Iterator<Item = LengthOfABlock> {
        let falls_at_once =
            self.has_kinetic_coefficient() && self.slip_weakening.is_none() && self.mean_ratio() < 1.0;
        let is_drawn = |field: &Option<String>, sigma: f64| field.is_none() && sigma > 0.0;
        let draws_static =
            self.has_static_coefficient() && is_drawn(&self.mu_static_field, self.sigma_static_star);
        let draws_kinetic =
            self.has_kinetic_coefficient() && is_drawn(&self.mu_kinetic_field, self.sigma_kinetic_star);
        let drawn_by_block = self.correlation_length.is_none() && (draws_static || draws_kinetic);
        let slip = falls_at_once.then_some(LengthOfABlock {
            length: "the slip over which strength is lost",
            key: "friction.slip_weakening",
        });
        let coefficients = drawn_by_block.then_some(LengthOfABlock {
            length: "the length over which coefficients are alike",
            key: "friction.correlation_length",
        });
        slip.into_iter().chain(coefficients)
    }

    /// The law of the model that the keys, which fit each other, define at this V*.
    pub fn in_model(&self, v_star: f64, scales: &Scales) -> slipfront::Friction {
        let per_area = self.contact_stiffness_per_area.as_ref();
        let of_area = per_area.map(|per_area| scales.stiffness_of_area(per_area.si()));
        if let Some(stiffness) = self.contact_stiffness_star.or(of_area) {
            return slipfront::Friction::ContactSprings(ContactSprings {
                stiffness,
                redraw: self.redraw.then_some(self.seed),
            });
        }
        let reading = match self.law {
            Law::Projection => FrictionLaw::Projection,
            Law::Reversal => FrictionLaw::Reversal,
            Law::Literal => FrictionLaw::Literal,
            Law::RateAndState => {
                let law = rate_and_state::law(self.rate_and_state(), self.mu_static, v_star);
                return slipfront::Friction::RateAndState(law);
            }
        };
        slipfront::Friction::Coulomb(Coulomb {
            law: reading,
            weakening: self.velocity.map(Velocity::law),
            ageing: self.ageing.map(Ageing::law),
            slip_weakening: self
                .slip_weakening
                .as_ref()
                .map(|law| law.law(scales, self.healing_time_star)),
        })
    }

    /// The law of the model and its coefficients in words.
    pub fn in_words(&self, law: &slipfront::Friction) -> String {
        let spread = |field: &Option<String>, sigma: f64| match field {
            Some(file) => format!("from {file}"),
            None => format!("spread {}", four_digits(sigma)),
        };
        let coefficients = || {
            let mu_static = four_digits(self.mu_static);
            let of_static = spread(&self.mu_static_field, self.sigma_static_star);
            format!("mu_s = {mu_static} ({of_static})")
        };
        match law {
            slipfront::Friction::Coulomb(coulomb) => {
                let reading = match coulomb.law {
                    FrictionLaw::Projection => "",
                    FrictionLaw::Reversal => ", law \"reversal\" (for comparison)",
                    FrictionLaw::Literal => ", law \"literal\" (for comparison)",
                };
                let weakening = coulomb.weakening.as_ref().map(weakening::in_words);
                let ageing = coulomb.ageing.as_ref().map(ageing::in_words);
                let ratio = four_digits(self.mean_ratio());
                let of_kinetic = spread(&self.mu_kinetic_field, self.sigma_kinetic_star);
                let slip_weakening = coulomb.slip_weakening.as_ref().map(slip_weakening::in_words);
                let options: String = [weakening, ageing, slip_weakening]
                    .into_iter()
                    .flatten()
                    .collect();
                format!(
                    "{}, R* = {ratio} ({of_kinetic}), seed {}{reading}{options}",
                    coefficients(),
                    self.seed
                )
            }
            slipfront::Friction::RateAndState(law) => rate_and_state::in_words(law, self.mu_static),
            slipfront::Friction::ContactSprings(law) => {
                let springs = contact_springs::in_words(law);
                format!("{}, seed {}{springs}", coefficients(), self.seed)
            }
        }
    }

    /// A key that takes one rank, and the reason.
    pub fn takes_one_rank(&self) -> Option<(&'static str, &'static str)> {
        self.redraw
            .then_some(("friction.redraw", contact_springs::ONE_RANK))
    }

    /// The values of the keys of rate and state, in the order of the documentation.
    fn rate_and_state(&self) -> [Option<f64>; rate_and_state::KEYS.len()] {
        [
            self.a,
            self.b,
            self.d_c_star,
            self.v_0_star,
            self.mu_0,
            self.theta_0_star,
            self.slip_speed_star,
        ]
    }

    /// Refuses keys that have no meaning beside each other.
    fn check_together(&self, check: &Check) -> Result<(), CaseError> {
        self.check_law(check)?;
        self.check_correlation(check)?;
        let [varying @ .., slip_weakening, healing] = self.options();
        match (slip_weakening.1, healing.1) {
            (true, _) => refuse_set(check, &varying, slip_weakening::ALONE)?,
            (false, true) => refuse_set(check, &[healing], slip_weakening::ELSEWHERE)?,
            (false, false) => {}
        }
        let springs = [
            ("contact_stiffness_star", self.contact_stiffness_star.is_some()),
            (
                "contact_stiffness_per_area",
                self.contact_stiffness_per_area.is_some(),
            ),
            ("redraw", self.redraw),
        ];
        let has_stiffness = springs[..2].iter().any(|(_, is_set)| *is_set);
        match (self.contact, has_stiffness) {
            (ContactModel::Rigid, _) => refuse_set(check, &springs, contact_springs::ELSEWHERE),
            (ContactModel::Springs, false) => check.refuse("contact", contact_springs::without_stiffness),
            (ContactModel::Springs, true) => {
                refuse_set(check, &self.options(), contact_springs::ALONE)?;
                refuse_set(check, &self.of_kinetic(), contact_springs::ALONE)
            }
        }
    }

    /// Refuses keys that have no meaning under a drive that stands while a block slides.
    pub(super) fn check_held(&self, check: &Check) -> Result<(), CaseError> {
        let [_, ageing, _, healing] = self.options();
        refuse_set(check, &[ageing, healing], HELD_IN_TIME)?;
        let springs = ("contact", self.contact == ContactModel::Springs);
        refuse_set(check, &[("law", self.law != Law::Projection), springs], HELD)
    }

    /// Refuses a correlation length where no coefficient is drawn from a field.
    fn check_correlation(&self, check: &Check) -> Result<(), CaseError> {
        let is_correlated = self.correlation_length.is_some();
        let draws_kinetic = self.has_kinetic_coefficient() && self.mu_kinetic_field.is_none();
        let all_given = self.mu_static_field.is_some() && !draws_kinetic;
        refuse_set(
            check,
            &[("correlation_length", is_correlated && all_given)],
            correlation::GIVEN,
        )?;
        refuse_set(
            check,
            &[("redraw", is_correlated && self.redraw)],
            correlation::REDRAW,
        )
    }

    /// Refuses keys that have no meaning under the law.
    fn check_law(&self, check: &Check) -> Result<(), CaseError> {
        let springs = ("contact", self.contact == ContactModel::Springs);
        let values = rate_and_state::KEYS.iter().zip(self.rate_and_state());
        let mut of_state = values.map(|(key, value)| (key.name, value.is_some()));
        match self.law {
            Law::Projection => {}
            Law::Reversal | Law::Literal => {
                let why = "`law` = \"reversal\" and \"literal\" are other readings of Eq. 4, for comparison with it alone; \
                           take `law` = \"projection\"";
                refuse_set(check, &self.options(), why)?;
                refuse_set(check, &[springs], why)?;
            }
            Law::RateAndState => {
                let others = [
                    ("sigma_static_star", is_spread(self.sigma_static_star)),
                    ("mu_static_field", self.mu_static_field.is_some()),
                    ("correlation_length", self.correlation_length.is_some()),
                    ("adhesion", self.adhesion.si() != 0.0),
                    springs,
                ];
                let without = [&self.options()[..], &self.of_kinetic(), &others].concat();
                refuse_set(check, &without, rate_and_state::ALONE)?;
                let mut needed = of_state.take(rate_and_state::NEEDED);
                return match needed.find(|(_, is_set)| !is_set) {
                    Some((key, _)) => check.refuse("law", |path| rate_and_state::without_key(path, key)),
                    None => Ok(()),
                };
            }
        }
        let set = of_state.find(|(_, is_set)| *is_set);
        set.map_or(Ok(()), |set| refuse_set(check, &[set], rate_and_state::ELSEWHERE))
    }

    /// Options of thresholds, and whether each is set.
    fn options(&self) -> [(&'static str, bool); 4] {
        [
            ("velocity", self.velocity.is_some()),
            ("ageing", self.ageing.is_some()),
            ("slip_weakening", self.slip_weakening.is_some()),
            ("healing_time_star", self.healing_time_star.is_some()),
        ]
    }

    /// The keys of kinetic friction, and whether they are set. Defaults are no contradiction where there is no kinetic
    /// coefficient.
    fn of_kinetic(&self) -> [(&'static str, bool); 5] {
        [
            (
                "r_star",
                matches!(self.kinetic, KineticFriction::RStar(r_star) if r_star != DEFAULT_R_STAR),
            ),
            (
                "mu_kinetic",
                matches!(self.kinetic, KineticFriction::MuKinetic(_)),
            ),
            ("sigma_kinetic_star", is_spread(self.sigma_kinetic_star)),
            ("mu_kinetic_field", self.mu_kinetic_field.is_some()),
            ("adhesion_kinetic", self.adhesion_kinetic.si() != 0.0),
        ]
    }
}

/// A warning about the law of a model.
pub(crate) fn friction_warning(model: &Model) -> Option<String> {
    match &model.friction {
        slipfront::Friction::RateAndState(law) => rate_and_state::warning(law, model),
        slipfront::Friction::Coulomb(_) | slipfront::Friction::ContactSprings(_) => None,
    }
}

/// Refuses the first of some keys that are set and must not be.
fn refuse_set(check: &Check, keys: &[(&str, bool)], why: &str) -> Result<(), CaseError> {
    let set = keys.iter().find(|(_, is_set)| *is_set);
    set.map_or(Ok(()), |(key, _)| {
        check.refuse(key, |path| format!("`{path}` has no meaning here: {why}"))
    })
}

/// Reason for which laws that depend on time have no meaning under a held drive.
const HELD_IN_TIME: &str = "with `drive.loading` = \"held\" the drive waits for slip to end, and loads as slowly as you like: no time passes in which \
                            contacts could grow stronger; leave one of them out";

/// Reason for which other laws have no meaning under a held drive.
const HELD: &str = "with `drive.loading` = \"held\" the drive moves while all blocks in contact are stuck, as they are by \
                    `law` = \"projection\" and `contact` = \"rigid\" alone; take these, or `drive.loading` = \"constant\"";

/// Whether a spread is set; 0 and the default are no contradiction where there are no coefficients that it spreads.
fn is_spread(sigma: f64) -> bool {
    sigma != 0.0 && sigma != DEFAULT_SIGMA
}

/// Default spread, which a printed case has even where it has no meaning.
const DEFAULT_SIGMA: f64 = 0.05;
const DEFAULT_R_STAR: f64 = 0.5;

keys_with_choice! {
    Friction: FrictionKeys {
        #[serde(deserialize_with = "word")]
        law: Law,
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
        #[serde(skip_serializing_if = "Option::is_none")]
        correlation_length: Option<Length>,
        #[serde(skip_serializing_if = "Option::is_none")]
        velocity: Option<Velocity>,
        #[serde(skip_serializing_if = "Option::is_none")]
        ageing: Option<Ageing>,
        #[serde(skip_serializing_if = "Option::is_none")]
        slip_weakening: Option<SlipWeakeningLength>,
        #[serde(skip_serializing_if = "Option::is_none")]
        healing_time_star: Option<f64>,
        #[serde(deserialize_with = "word")]
        contact: ContactModel,
        #[serde(skip_serializing_if = "Option::is_none")]
        contact_stiffness_star: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        contact_stiffness_per_area: Option<StiffnessPerArea>,
        redraw: bool,
        #[serde(skip_serializing_if = "Option::is_none")]
        a: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        b: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        d_c_star: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        v_0_star: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        mu_0: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        theta_0_star: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        slip_speed_star: Option<f64>,
    }
}
