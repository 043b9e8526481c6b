//! The table `[friction]`: the law, the local coefficients and their dependences.
//!
//! Each law has a file with its keys, the words that people try for them, the law of the model that they
//! define, and the sentences about it. This file has the common part, and one row per law.

mod ageing;
mod contact_springs;
mod correlation;
mod rate_and_state;
mod slip_weakening;
mod weakening;

use std::ops::Bound::Included;

use serde::{Deserialize, Serialize};
use slipfront::{ContactSprings, Coulomb, FrictionLaw, Interface, Model, Scales};

pub use self::ageing::{Ageing, AgeingLaw};
pub use self::slip_weakening::SlipWeakeningLength;
pub use self::weakening::{Velocity, VelocityLaw};
use super::check::Check;
use super::error::CaseError;
use super::key::{
    ARRAY, Key, KeyKind, SLIP_STAR, SPEED_STAR, STIFFNESS_PER_AREA, StarUnit, TIME_STAR, above, key, number,
    quantity, whole, within,
};
use super::length_of_a_block::LengthOfABlock;
use super::serde_names::names_of;
use super::synonyms::Synonyms;
use super::values::is_default;
use super::words::FrictionAlong;
use crate::key_rows;
use crate::quantity::{Length, Pressure, StiffnessPerArea};
use slipfront_base::number_format::four_digits;

const SIGMA: KeyKind = number(
    within(0.0, 1.0),
    "it is relative to the mean coefficient, so that 0.05 is 5 percent",
);
const SHEAR_STRENGTH: KeyKind = quantity("Pa", within(0.0, 1e15));
/// TOML's largest integer.
const MAX_SEED: u64 = i64::MAX.unsigned_abs();
/// Largest ratio of the mean kinetic to the mean static coefficient.
const MAX_R_STAR: f64 = 10.0;

/// Words that people try first, with the advice on each, by law.
pub(super) const SYNONYMS: [Synonyms; 6] = [
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
    /// Coefficients that depend on speed and state.
    RateAndState,
}

/// Connection that holds a block up to its threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactModel {
    /// Contact that does not yield.
    Rigid,
    /// Breakable spring between block and substrate.
    Springs,
}

/// Friction of a block with a broken contact spring.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AfterBreak {
    /// A spring that re-forms without stress.
    #[default]
    FormAgain,
    /// Kinetic friction, until the spring relaxes.
    Slide,
}

key_rows! {
    /// `[friction]`: the law and the local coefficients (Eqs. 1 and 4).
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(try_from = "FrictionKeys", into = "FrictionKeys")]
    pub struct Friction from FrictionKeys {
        /// Interpretation of Eq. 4, or rate-and-state friction instead of it; `"reversal"` and `"literal"`
        /// are for comparison.
        pub law: Law = key("\"projection\"", KeyKind::Words(names_of::<Law>)).paper("Eq. 4"),
        /// Direction in which friction acts: the plane of a slider that lies on its substrate, or x alone, of
        /// a sheet that stands upright on it, whose blocks move freely along y.
        #[serde(skip_serializing_if = "is_default")]
        pub along: FrictionAlong = key("\"plane\"", KeyKind::Words(names_of::<FrictionAlong>))
            .note("See [upright sheets](../model.md#an-upright-sheet)."),
        /// Mean static coefficient. It is the scale of all forces, even if a field is given.
        pub mu_static: f64 = key("1.0", number(above(0.0, 100.0), "it is the scale of all forces"))
            .paper("mean of mu_s")
            .title("mean static coefficient", "\u{3bc}\u{209b}", ""),
        [
            /// Mean of the local kinetic coefficients: `r_star` or `mu_kinetic`.
            pub kinetic: KineticFriction or "friction needs `r_star` or `mu_kinetic`" {
                /// Ratio of the mean kinetic to the mean static coefficient.
                r_star: f64 => RStar = key("0.5", number(within(0.0, MAX_R_STAR), "it is the ratio of the kinetic to the static coefficient"))
                    .star(StarUnit::One)
                    .paper("R*").title("friction ratio", "R*", ""),
                /// Mean kinetic coefficient, instead of `r_star`.
                mu_kinetic: f64 => MuKinetic = key("", KeyKind::Special("0 to 10 times `mu_static`"))
                    .paper("mean of mu_k")
                    .title("mean kinetic coefficient", "\u{3bc}\u{2096}", ""),
            }
        ]
        /// Standard deviation of the static coefficients, relative to their mean.
        pub sigma_static_star: f64 = key("0.05", SIGMA).star(StarUnit::One).paper("sigma_s*")
            .title("spread of static coefficients", "\u{3c3}\u{209b}*", ""),
        /// Standard deviation of the kinetic coefficients, relative to *their* mean.
        pub sigma_kinetic_star: f64 = key("0.05", SIGMA).star(StarUnit::One).paper("sigma_k*")
            .title("spread of kinetic coefficients", "\u{3c3}\u{2096}*", ""),
        /// Seed of the random coefficients.
        pub seed: u64 = key("1", whole(0, MAX_SEED)).title("seed", "", ""),
        /// Static coefficients block by block, instead of random ones.
        pub mu_static_field: Option<String> = key("", ARRAY).paper("mu_s,i"),
        /// Kinetic coefficients block by block, instead of random ones.
        pub mu_kinetic_field: Option<String> = key("", ARRAY).paper("mu_k,i"),
        /// Load-independent shear strength tau_a of the contact: the static threshold of a block in contact
        /// is mu_s,i F_n,i + tau_a l^2.
        pub adhesion: Pressure = key("\"0 Pa\"", SHEAR_STRENGTH).title("adhesion", "\u{3c4}\u{2090}", "Pa"),
        /// Load-independent shear strength that is added to the kinetic friction of blocks in contact.
        pub adhesion_kinetic: Pressure = key("\"0 Pa\"", SHEAR_STRENGTH)
            .title("kinetic adhesion", "\u{3c4}\u{2090}\u{2096}", "Pa"),
        /// Length over which random coefficients are alike; without it every block draws its own.
        pub correlation_length: Option<Length> = key("", quantity("m", within(1e-13, 1e8)))
            .title("correlation length", "\u{3be}", "m")
            .further_bounds(", 0.25 to 100 000 blocks")
            .note("With it the spreads are those at a point, and those [of means over \
            blocks](../model.md#coefficients-that-are-alike-over-a-length) are less."),
        /// Velocity weakening of kinetic friction: mu_k,i (ratio + (1 - ratio)/(1 + v/v_c)).
        pub velocity: Option<Velocity> =
            key("", KeyKind::Table("{ law = \"weakening\", v_c_star = 0.1, ratio = 0.5 }", Velocity::KEYS)),
        /// Ageing of static friction while a block is stuck: mu_s,i (1 + beta ln(1 + t/time)).
        pub ageing: Option<Ageing> = key("", KeyKind::Table("{ law = \"logarithmic\", beta = 0.02, time_star = 1 }", Ageing::KEYS)),
        /// Slip over which strength falls from the static to the kinetic threshold, D_c; without it strength
        /// falls at once.
        pub slip_weakening: Option<SlipWeakeningLength> = key("", KeyKind::Table("{ length = \"0.5 um\" }", SlipWeakeningLength::KEYS))
            .further_bounds(", in units of P mu_s l^2/(E h); one of the two")
            .note("See [the model](../model.md#other-laws-of-friction)."),
        /// Time of stick after which a block has its full strength again; without it strength is not restored
        /// during the run.
        pub healing_time_star: Option<f64> = key("", TIME_STAR).star(StarUnit::Time)
            .title("healing time", "t\u{2095}*", ""),
        /// Contact below the threshold: rigid, or a spring that breaks at the threshold.
        pub contact: ContactModel = key("\"rigid\"", KeyKind::Words(names_of::<ContactModel>)),
        /// Stiffness of the contact spring of a block; `contact = "springs"` needs this key or the next.
        pub contact_stiffness_star: Option<f64> = key("", number(above(0.0, 1e3),
            "it is relative to E h, with the thickness h, and a spring between blocks has 0.75"))
                .star(StarUnit::SpringOfBlock).or(&["contact_stiffness_per_area"])
            .paper("k_t/(E h)").title("contact stiffness", "k\u{209c}*", ""),
        /// Stiffness of the contact springs per area.
        pub contact_stiffness_per_area: Option<StiffnessPerArea> = key("", STIFFNESS_PER_AREA)
            .or(&["contact_stiffness_star"])
            .title("contact stiffness", "K\u{209c}", "N/m\u{b3}"),
        /// Friction of a block whose spring has broken: the spring forms again at once, without stress, or
        /// the block slides at its kinetic friction until the spring relaxes and holds it again.
        #[serde(skip_serializing_if = "is_default")]
        pub after_break: AfterBreak = key("\"form_again\"", KeyKind::Words(names_of::<AfterBreak>))
            .note("See [springs in contact](../model.md#other-laws-of-friction)."),
        /// Whether a contact spring that re-forms has a new threshold, from the coefficient of a random block
        /// in contact (chosen by the seed).
        pub redraw: bool = key("false", KeyKind::Switch),
        /// Direct effect of rate-and-state friction; this law needs this key and the next three.
        pub a: Option<f64> = key("", number(within(1e-6, 10.0), "it is a coefficient, of the order of 0.01"))
            .title("direct effect", "a", ""),
        /// Evolution effect of rate-and-state friction.
        pub b: Option<f64> = key("", number(within(0.0, 10.0), "it is a coefficient, of the order of 0.01"))
            .title("evolution effect", "b", ""),
        /// Characteristic slip of the state variable, in units of P mu_s l^2/(E h).
        pub d_c_star: Option<f64> = key("", SLIP_STAR).star(StarUnit::Displacement)
            .title("slip of the state", "D*", ""),
        /// Reference speed of rate-and-state friction, in the unit of V*.
        pub v_0_star: Option<f64> = key("", SPEED_STAR).star(StarUnit::Speed)
            .title("reference speed", "V\u{2080}*", ""),
        /// Friction coefficient of steady sliding at `v_0_star`; `mu_static` if not given.
        pub mu_0: Option<f64> = key("", number(within(0.0, 100.0), "it is a coefficient"))
            .title("coefficient of steady sliding", "\u{3bc}\u{2080}", ""),
        /// Initial state, t*; `d_c_star`/`v_0_star` if not given.
        pub theta_0_star: Option<f64> = key("", TIME_STAR).star(StarUnit::Time)
            .title("state at the start", "\u{3b8}\u{2080}*", ""),
        /// Speed above which a block counts as sliding under rate-and-state friction, in the unit of V*;
        /// V*/10 if not given.
        pub slip_speed_star: Option<f64> = key("", SPEED_STAR).star(StarUnit::Speed),
    }
}

impl Friction {
    /// Keys with defaults that a printed case omits where there is no kinetic coefficient.
    pub(super) const KINETIC: [&str; 2] = ["r_star", "sigma_kinetic_star"];

    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        self.check_values(check)?;
        if let KineticFriction::MuKinetic(mu_kinetic) = self.kinetic {
            let bounds = (Included(0.0), Included(MAX_R_STAR * self.mu_static));
            let remark = format!("at most {MAX_R_STAR} times `mu_static`");
            check.number_within("mu_kinetic", mu_kinetic, bounds, &remark)?;
        }
        if let Some(slip_weakening) = &self.slip_weakening {
            slip_weakening.expect_one_length(check)?;
        }
        self.check_together(check)
    }

    /// Whether friction has a static coefficient.
    pub fn has_static_coefficient(&self) -> bool {
        self.law != Law::RateAndState
    }

    /// Whether friction has a kinetic coefficient as well as a static one.
    pub fn has_kinetic_coefficient(&self) -> bool {
        self.has_static_coefficient()
            && (self.contact == ContactModel::Rigid || self.after_break == AfterBreak::Slide)
    }

    /// R*, the mean kinetic over the mean static coefficient; 0 where there is no kinetic one.
    pub fn mean_ratio(&self) -> f64 {
        match self.kinetic {
            _ if !self.has_kinetic_coefficient() => 0.0,
            KineticFriction::RStar(r_star) => r_star,
            KineticFriction::MuKinetic(mu) => mu / self.mu_static,
        }
    }

    /// Spreads of the coefficients that are drawn, with their names; none for coefficients that a file gives,
    /// or that the law does not have.
    fn spreads(&self) -> Vec<(&'static str, f64)> {
        let of_static = self.has_static_coefficient() && self.mu_static_field.is_none();
        let of_kinetic = self.has_kinetic_coefficient() && self.mu_kinetic_field.is_none();
        let of_static = of_static.then_some(("static", self.sigma_static_star));
        let of_kinetic = of_kinetic.then_some(("kinetic", self.sigma_kinetic_star));
        of_static.into_iter().chain(of_kinetic).collect()
    }

    /// The [spreads](Self::spreads) that equal their default, if there is no correlation length. Whether the
    /// user gave a spread is not known, because a printed case has all keys.
    pub(crate) fn default_spreads(&self) -> Vec<(&'static str, f64)> {
        let mut spreads = self.spreads();
        spreads.retain(|(_, sigma_star)| self.correlation_length.is_none() && *sigma_star == DEFAULT_SIGMA);
        spreads
    }

    /// Lengths of friction that equal the block length because no key gives them.
    pub(crate) fn lengths_of_a_block(&self) -> impl Iterator<Item = LengthOfABlock> {
        let is_rigid = self.has_static_coefficient() && self.contact == ContactModel::Rigid;
        let falls_at_once = is_rigid && self.slip_weakening.is_none() && self.mean_ratio() < 1.0;
        let draws = self.spreads().iter().any(|(_, sigma_star)| *sigma_star > 0.0);
        let drawn_by_block = self.correlation_length.is_none() && draws;
        let slip = falls_at_once.then_some(LengthOfABlock {
            length: "the slip-weakening distance",
            key: "friction.slip_weakening",
        });
        let coefficients = drawn_by_block.then_some(LengthOfABlock {
            length: "the correlation length of the coefficients",
            key: "friction.correlation_length",
        });
        slip.into_iter().chain(coefficients)
    }

    /// The law of the model for this V*, from keys that are consistent with each other. `foundation`:
    /// stiffness of the foundation under a block of an upright sheet.
    pub fn in_model(&self, v_star: f64, scales: &Scales, foundation: f64) -> slipfront::Friction {
        let per_area = self.contact_stiffness_per_area.as_ref();
        let of_area = per_area.map(|per_area| scales.stiffness_of_area(per_area.si()));
        if let Some(stiffness) = self.contact_stiffness_star.or(of_area) {
            return slipfront::Friction::ContactSprings(ContactSprings {
                stiffness,
                after_break: match self.after_break {
                    AfterBreak::FormAgain => slipfront::AfterBreak::FormsAgain {
                        redraw: self.redraw.then_some(self.seed),
                    },
                    AfterBreak::Slide => slipfront::AfterBreak::Slides,
                },
            });
        }
        let reading = match self.law {
            Law::Projection => FrictionLaw::Projection,
            Law::Reversal => FrictionLaw::Reversal,
            Law::Literal => FrictionLaw::Literal,
            Law::RateAndState => {
                let values = self.rate_and_state().map(|(_, value)| value);
                let law = rate_and_state::law(values, self.mu_static, v_star);
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
            interface: match self.along {
                FrictionAlong::Plane => None,
                FrictionAlong::X => Some(Interface { foundation }),
            },
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
            let mut all = format!("mu_s = {mu_static} ({of_static})");
            if self.has_kinetic_coefficient() {
                let ratio = four_digits(self.mean_ratio());
                let of_kinetic = spread(&self.mu_kinetic_field, self.sigma_kinetic_star);
                all += &format!(", R* = {ratio} ({of_kinetic})");
            }
            all
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
                let slip_weakening = coulomb.slip_weakening.as_ref().map(slip_weakening::in_words);
                let options: String = [weakening, ageing, slip_weakening]
                    .into_iter()
                    .flatten()
                    .collect();
                let along = match &coulomb.interface {
                    None => String::new(),
                    Some(interface) if interface.foundation > 0.0 => format!(
                        ", only along x, on a foundation of {} E h per block",
                        four_digits(interface.foundation)
                    ),
                    Some(_) => ", along x alone".to_owned(),
                };
                format!("{}, seed {}{reading}{options}{along}", coefficients(), self.seed)
            }
            slipfront::Friction::RateAndState(law) => rate_and_state::in_words(law, self.mu_static),
            slipfront::Friction::ContactSprings(law) => {
                let springs = contact_springs::in_words(law);
                format!("{}, seed {}{springs}", coefficients(), self.seed)
            }
        }
    }

    /// A key that requires a single rank, and the reason.
    pub fn takes_one_rank(&self) -> Option<(&'static str, &'static str)> {
        self.redraw
            .then_some(("friction.redraw", contact_springs::ONE_RANK))
    }

    /// The keys of rate and state and their values. The required ones are first.
    fn rate_and_state(&self) -> [(&'static str, Option<f64>); 7] {
        [
            ("a", self.a),
            ("b", self.b),
            ("d_c_star", self.d_c_star),
            ("v_0_star", self.v_0_star),
            ("mu_0", self.mu_0),
            ("theta_0_star", self.theta_0_star),
            ("slip_speed_star", self.slip_speed_star),
        ]
    }

    /// Refuses combinations of keys without a meaning.
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
            ("after_break", !is_default(&self.after_break)),
        ];
        let has_stiffness = springs[..2].iter().any(|(_, is_set)| *is_set);
        match (self.contact, has_stiffness) {
            (ContactModel::Rigid, _) => refuse_set(check, &springs, contact_springs::ELSEWHERE),
            (ContactModel::Springs, false) => check.refuse("contact", contact_springs::without_stiffness),
            (ContactModel::Springs, true) => {
                refuse_set(check, &self.options(), contact_springs::ALONE)?;
                match self.after_break {
                    AfterBreak::FormAgain => {
                        refuse_set(check, &self.of_kinetic(check), contact_springs::NO_KINETIC)
                    }
                    AfterBreak::Slide => {
                        refuse_set(check, &[("redraw", self.redraw)], contact_springs::SLIDES)
                    }
                }
            }
        }
    }

    /// Whether strength falls with slip.
    pub(crate) fn falls_with_slip(&self) -> bool {
        self.slip_weakening.is_some()
    }

    /// Whether the friction of a block depends on time or speed, and not only on its slip.
    pub fn depends_on_time(&self) -> bool {
        let [velocity, ageing, _, healing] = self.options();
        self.law == Law::RateAndState || velocity.1 || ageing.1 || healing.1
    }

    /// Whether these keys apply to a held drive, which stops while a block slides.
    pub fn can_be_held(&self) -> bool {
        let keys = self.not_held();
        keys.iter().flatten().all(|(_, is_set)| !is_set)
    }

    /// Refuses keys that do not apply to a held drive, which stops while a block slides.
    pub(super) fn check_held(&self, check: &Check) -> Result<(), CaseError> {
        let [in_time, others] = self.not_held();
        refuse_set(check, &in_time, HELD_IN_TIME)?;
        refuse_set(check, &others, HELD)
    }

    /// Keys that do not apply to a held drive, and whether they are set. The first are those with which
    /// contacts strengthen with time.
    fn not_held(&self) -> [[(&'static str, bool); 2]; 2] {
        let [_, ageing, _, healing] = self.options();
        let springs = ("contact", self.contact == ContactModel::Springs);
        [[ageing, healing], [("law", self.law != Law::Projection), springs]]
    }

    /// Refuses a catalogue of events if slip takes no time.
    pub(super) fn check_events(&self, check: &Check) -> Result<(), CaseError> {
        let springs = self.contact == ContactModel::Springs && self.after_break == AfterBreak::FormAgain;
        refuse_set(check, &[("contact", springs)], EVENTS)
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

    /// Refuses keys that do not apply to the law.
    fn check_law(&self, check: &Check) -> Result<(), CaseError> {
        let springs = ("contact", self.contact == ContactModel::Springs);
        let values = self.rate_and_state().into_iter();
        let mut of_state = values.map(|(key, value)| (key, value.is_some()));
        match self.law {
            Law::Projection => {}
            Law::Reversal | Law::Literal => {
                let why = "`law` = \"reversal\" and \"literal\" are other interpretations of Eq. 4, only for comparison with \
                           it; use `law` = \"projection\"";
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
                let without = [&self.options()[..], &self.of_kinetic(check), &others].concat();
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

    /// The keys of kinetic friction, and whether they are set by the user or in code.
    fn of_kinetic(&self, check: &Check) -> [(&'static str, bool); 5] {
        let (has_ratio, has_mean) = match self.kinetic {
            KineticFriction::RStar(r_star) => (check.has("r_star") || r_star != DEFAULT_R_STAR, false),
            KineticFriction::MuKinetic(_) => (check.has("r_star"), true),
        };
        let sigma = self.sigma_kinetic_star;
        let has_spread = is_spread(sigma) || (check.has("sigma_kinetic_star") && sigma != 0.0);
        [
            ("r_star", has_ratio),
            ("mu_kinetic", has_mean),
            ("sigma_kinetic_star", has_spread),
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

/// Refuses the first of these keys that is set.
fn refuse_set(check: &Check, keys: &[(&str, bool)], why: &str) -> Result<(), CaseError> {
    let set = keys.iter().find(|(_, is_set)| *is_set);
    set.map_or(Ok(()), |(key, _)| {
        check.refuse(key, |path| format!("`{path}` does not apply here: {why}"))
    })
}

/// Reason why laws that depend on time do not apply to a held drive.
const HELD_IN_TIME: &str = "with `drive.loading` = \"held\" loading is arbitrarily slow, so there is no time scale for contacts \
                            to strengthen; leave one of them out";

/// Reason why other laws do not apply to a held drive.
const HELD: &str = "with `drive.loading` = \"held\" the drive moves while all blocks in contact stick, which needs `law` = \
                    \"projection\" and `contact` = \"rigid\"; use these, or `drive.loading` = \"constant\"";

/// Reason why springs in contact have no slip events.
const EVENTS: &str = "`output.events` needs blocks that slide during an event, but a contact spring breaks and re-forms in an \
                      instant; use `after_break` = \"slide\" or `contact` = \"rigid\", or leave `output.events` out";

/// Whether a spread is set. The values 0 and the default are accepted even without coefficients to spread.
fn is_spread(sigma: f64) -> bool {
    sigma != 0.0 && sigma != DEFAULT_SIGMA
}

/// Default spread. A printed case contains it even where it has no effect.
const DEFAULT_SIGMA: f64 = 0.05;
const DEFAULT_R_STAR: f64 = 0.5;
