//! `[friction]`: the law, the local coefficients and what they depend on.

use std::ops::Bound::Included;

use serde::{Deserialize, Serialize};

use super::check::Check;
use super::choice::keys_with_choice;
use super::error::CaseError;
use super::key_table::{BETA, MAX_R_STAR, RATIO, SPEED_STAR, TIME_STAR};
use super::values::word;
use super::words::{Contact, Law};
use crate::quantity::Pressure;

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
    /// Standard deviation of the kinetic coefficients over *their* mean, 0 to 1.
    pub sigma_kinetic_star: f64,
    /// Seed of the random coefficients, 0 to 2^63 - 1.
    pub seed: u64,
    /// A file of static coefficients, block by block, in place of random ones: `.npy` or `.csv`, shape (ny, nx).
    pub mu_static_field: Option<String>,
    /// A file of kinetic coefficients, block by block, in place of random ones: `.npy` or `.csv`, shape (ny, nx).
    pub mu_kinetic_field: Option<String>,
    /// Shear strength of the contact without load (tau_a), which adds `tau_a l^2` to the static threshold, Pa.
    pub adhesion: Pressure,
    /// The same of kinetic friction, Pa.
    pub adhesion_kinetic: Pressure,
    /// Kinetic friction that falls with speed.
    pub velocity: Option<Velocity>,
    /// Static friction that grows while a block is stuck.
    pub ageing: Option<Ageing>,
    /// What holds a block until its threshold.
    pub contact: Contact,
    /// Stiffness of the spring in the contact of a block over `young_modulus` times `block_size`, of contacts that are springs.
    pub contact_stiffness_star: Option<f64>,
    /// Whether a spring that forms again has another threshold.
    pub redraw: bool,
    /// Direct effect of rate and state.
    pub a: Option<f64>,
    /// Its evolution effect.
    pub b: Option<f64>,
    /// Slip over which its state follows, in units of P mu_s l/E.
    pub d_c_star: Option<f64>,
    /// Its reference speed, in the unit of V*.
    pub v_0_star: Option<f64>,
    /// Its coefficient of steady sliding at that speed; `mu_static` if not given.
    pub mu_0: Option<f64>,
    /// Its state at the start, t*; `d_c_star/v_0_star` if not given.
    pub theta_0_star: Option<f64>,
    /// Speed above which a block counts as sliding, in the unit of V*; a tenth of V* if not given.
    pub slip_speed_star: Option<f64>,
}

/// `velocity`: kinetic friction that falls with speed, mu_k [ratio + (1 - ratio)/(1 + v/v_c)].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Velocity {
    /// The law.
    #[serde(deserialize_with = "word")]
    pub law: VelocityLaw,
    /// Speed at which half of the fall is reached, in the unit of V*; more than 0, at most 10.
    pub v_c_star: f64,
    /// Kinetic friction at high speed over that at rest, 0 to 1.
    pub ratio: f64,
}

/// How kinetic friction depends on speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VelocityLaw {
    /// It falls.
    Weakening,
}

/// `ageing`: static friction that grows while a block is stuck, mu_s [1 + beta ln(1 + t/time)].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ageing {
    /// The law.
    #[serde(deserialize_with = "word")]
    pub law: AgeingLaw,
    /// Growth per unit of the logarithm, 0 to 10.
    pub beta: f64,
    /// Time after which it shows, t*; more than 0, at most 1e9.
    pub time_star: f64,
}

/// How static friction depends on age.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AgeingLaw {
    /// With the logarithm of the age.
    Logarithmic,
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
        if let Some(velocity) = &self.velocity {
            check.value_of(&SPEED_STAR, "velocity.v_c_star", &velocity.v_c_star)?;
            check.value_of(&RATIO, "velocity.ratio", &velocity.ratio)?;
        }
        if let Some(ageing) = &self.ageing {
            check.value_of(&BETA, "ageing.beta", &ageing.beta)?;
            check.value_of(&TIME_STAR, "ageing.time_star", &ageing.time_star)?;
        }
        check.value("contact_stiffness_star", &self.contact_stiffness_star)?;
        for (key, value) in self.rate_and_state_keys() {
            check.value(key, &value)?;
        }
        self.check_together(check)
    }

    /// Whether friction has static and kinetic coefficients.
    pub fn has_kinetic_coefficient(&self) -> bool {
        self.law != Law::RateAndState && self.contact == Contact::Rigid
    }

    /// The keys of rate and state.
    fn rate_and_state_keys(&self) -> [(&'static str, Option<f64>); 7] {
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

    /// Refuses keys that have no meaning beside each other.
    fn check_together(&self, check: &Check) -> Result<(), CaseError> {
        /// The first of some keys that are set and must not be is refused.
        fn refuse_set(check: &Check, keys: &[(&str, bool)], why: &str) -> Result<(), CaseError> {
            let set = keys.iter().find(|(_, is_set)| *is_set);
            set.map_or(Ok(()), |(key, _)| {
                check.refuse(key, |path| format!("`{path}` has no meaning here: {why}"))
            })
        }
        let varies = [
            ("velocity", self.velocity.is_some()),
            ("ageing", self.ageing.is_some()),
        ];
        // Where there are no such coefficients their defaults are no contradiction.
        let is_spread = |sigma: f64| sigma != 0.0 && sigma != DEFAULT_SIGMA;
        let kinetic = [
            (
                "r_star",
                !matches!(self.kinetic, KineticFriction::RStar(r_star) if r_star == DEFAULT_R_STAR)
                    && matches!(self.kinetic, KineticFriction::RStar(_)),
            ),
            (
                "mu_kinetic",
                matches!(self.kinetic, KineticFriction::MuKinetic(_)),
            ),
            ("sigma_kinetic_star", is_spread(self.sigma_kinetic_star)),
            ("mu_kinetic_field", self.mu_kinetic_field.is_some()),
            ("adhesion_kinetic", self.adhesion_kinetic.si() != 0.0),
        ];
        let springs = [
            ("contact_stiffness_star", self.contact_stiffness_star.is_some()),
            ("redraw", self.redraw),
        ];
        match self.law {
            Law::Projection => {}
            Law::Reversal | Law::Literal => {
                let why = "`law` = \"reversal\" and \"literal\" are other readings of Eq. 4, for comparison with it alone; \
                           take `law` = \"projection\"";
                refuse_set(check, &varies, why)?;
                refuse_set(check, &[("contact", self.contact == Contact::Springs)], why)?;
            }
            Law::RateAndState => {
                let why = "`law` = \"rate_and_state\" has no static and kinetic coefficients, and its friction follows speed and age \
                           already; leave it out, or take `law` = \"projection\"";
                refuse_set(check, &varies, why)?;
                refuse_set(check, &kinetic, why)?;
                let others = [
                    ("sigma_static_star", is_spread(self.sigma_static_star)),
                    ("mu_static_field", self.mu_static_field.is_some()),
                    ("adhesion", self.adhesion.si() != 0.0),
                    ("contact", self.contact == Contact::Springs),
                ];
                refuse_set(check, &others, why)?;
                let needed = &self.rate_and_state_keys()[..4];
                if let Some((key, _)) = needed.iter().find(|(_, value)| value.is_none()) {
                    return check.refuse("law", |path| {
                        format!("`{path}` = \"rate_and_state\" needs `{key}`: it needs `a`, `b`, `d_c_star` and `v_0_star`")
                    });
                }
            }
        }
        if self.law != Law::RateAndState {
            let set = self
                .rate_and_state_keys()
                .map(|(key, value)| (key, value.is_some()));
            refuse_set(
                check,
                &set,
                "it belongs to `law` = \"rate_and_state\"; set that, or leave it out",
            )?;
        }
        match (self.contact, self.contact_stiffness_star) {
            (Contact::Rigid, _) => refuse_set(
                check,
                &springs,
                "it belongs to `contact` = \"springs\"; set that, or leave it out",
            ),
            (Contact::Springs, None) => check.refuse("contact", |path| {
                format!("`{path}` = \"springs\" needs their stiffness, `contact_stiffness_star`")
            }),
            (Contact::Springs, Some(_)) => {
                let why = "with `contact` = \"springs\" a block is held by its spring at any speed, and there is no kinetic \
                           friction; leave it out, or take `contact` = \"rigid\"";
                refuse_set(check, &varies, why)?;
                refuse_set(check, &kinetic, why)
            }
        }
    }
}

/// Defaults of keys that a case may have where they have no meaning: it is printed with every default.
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
        velocity: Option<Velocity>,
        #[serde(skip_serializing_if = "Option::is_none")]
        ageing: Option<Ageing>,
        #[serde(deserialize_with = "word")]
        contact: Contact,
        #[serde(skip_serializing_if = "Option::is_none")]
        contact_stiffness_star: Option<f64>,
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
