//! The table `[time]`: duration, steps and end of the run.

use std::ops::Bound::{Excluded, Included, Unbounded};

use serde::{Deserialize, Serialize};
use slipfront::StopReason;

use super::check::{Check, Checked};
use super::drive::DriveSpeed;
use super::error::CaseError;
use super::key::{
    AUTO, Key, KeyKind, MAX_TIME_STAR, POSITIVE_TIME, StarUnit, between, key, or_word, quantity, within,
};
use super::serde_names::names_of;
use super::values::{AutoOr, WordOrNumber};
use crate::key_rows;
use crate::quantity::Duration;

key_rows! {
    /// `[time]`: duration, step, end and averaging window of the run.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(try_from = "TimeKeys", into = "TimeKeys")]
    pub struct Time from TimeKeys {
        [
            /// Duration of the run: `duration_star` or `duration`.
            pub duration: RunTime or "the run needs a duration: `duration_star` or `duration`" {
                /// Duration of the run. `"auto"` is 8/V*. If fewer than 48 % of the blocks are in contact and
                /// each carries f times the load (with a drive on every block), it is (8/3 f + 2.5)/V*.
                /// Adhesion multiplies it by 1 + tau_a/(P mu_s). With a program it counts from the last
                /// change of speed.
                duration_star: AutoOr => Star = key("\"auto\"", or_word(POSITIVE_TIME, "8/V* shows onset and sliding", AUTO))
                    .star(StarUnit::Time)
                    .paper("t*").title("duration", "t*", ""),
                /// Duration of the run with its unit, instead of `duration_star`.
                duration: Duration => Duration = key("", quantity("s", within(1e-24, 1e12)))
                    .paper("t")
                    .title("duration", "t", "s"),
            }
        ]
        /// Time step. `"auto"` is 0.1, or half the largest stable step if that is smaller, and 0.9 of it for
        /// a bulk body. `"paper"` is (2/3) V* (Eq. 13). A sheet is stable below 0.9058, and less with stiff
        /// blocks or mounts; `slipfront check` prints the bound.
        pub step: TimeStep = key("\"auto\"", or_word(between(0.0, UNSTABLE_STEP), "beyond it the scheme is unstable; \"auto\" is 0.1",
            &["auto", "paper"])).paper("dt*").title("time step", "\u{394}t*", ""),
        /// Condition that ends the run: its duration, or the fall that ends the first peak as soon as it is
        /// seen.
        pub stop: StopReason = key("\"end\"", KeyKind::Words(names_of::<StopReason>))
            .note("Under [slow loading](#slow-loading) `\"after_onset\"` ends it where the kinetic window begins."),
        /// Start of the window that mu_k* is averaged over; `"auto"` is t_s* + 2.5/V*.
        pub kinetic_from_star: AutoOr = key("\"auto\"", or_word((Included(0.0), Unbounded),
            "the average is taken from there to the end of the run", AUTO)).star(StarUnit::Time)
                .further_bounds(", before the end of the run")
            .note("Under [slow loading](#slow-loading) `\"auto\"` is 5/V*."),
    }
}

/// dt* beyond which no slider is stable, nor the softest bulk body: 2/sqrt(sqrt(2) pi/2) = 1.342.
const UNSTABLE_STEP: f64 = 1.342;

/// The time step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "WordOrNumber", into = "WordOrNumber")]
pub enum TimeStep {
    /// The value `"auto"`: dt* = 0.1.
    Auto,
    /// The value `"paper"`: dt* = (2/3) V* (Eq. 13).
    Paper,
    /// dt* itself, more than 0 and less than 1.342.
    Number(f64),
}

impl Time {
    /// Checks the times; some bounds depend on the speed of the drive.
    pub(super) fn check(&self, check: &Check, speed: &DriveSpeed) -> Result<(), CaseError> {
        if let (TimeStep::Paper, DriveSpeed::VStar(v_star)) = (self.step, speed)
            && v_star * 2.0 / 3.0 >= UNSTABLE_STEP
        {
            let step = v_star * 2.0 / 3.0;
            return check.refuse("step", |key| {
                format!(
                    "`{key}` = \"paper\" is (2/3) V* = {step:.4}: it must be less than {UNSTABLE_STEP}; use \"auto\", or a \
                     smaller `drive.v_star`"
                )
            });
        }
        if let AutoOr::Number(from) = self.kinetic_from_star {
            let end = match &self.duration {
                RunTime::Star(AutoOr::Number(star)) => Excluded(*star),
                _ => Included(MAX_TIME_STAR),
            };
            let remark = "the average is taken from there to the end of the run";
            check.number_within("kinetic_from_star", from, (Included(0.0), end), remark)?;
        }
        self.check_values(check)
    }
}

impl Checked for TimeStep {
    fn complaint(&self, kind: &KeyKind) -> Option<String> {
        match self {
            Self::Auto | Self::Paper => None,
            Self::Number(dt_star) => dt_star.complaint(kind),
        }
    }
}
impl TryFrom<WordOrNumber> for TimeStep {
    type Error = &'static str;

    fn try_from(value: WordOrNumber) -> Result<Self, Self::Error> {
        match value {
            WordOrNumber::Number(dt_star) => Ok(Self::Number(dt_star)),
            WordOrNumber::Word(word) if word == "auto" => Ok(Self::Auto),
            WordOrNumber::Word(word) if word == "paper" => Ok(Self::Paper),
            WordOrNumber::Word(_) => Err("expected a number, \"auto\" or \"paper\""),
        }
    }
}

impl From<TimeStep> for WordOrNumber {
    fn from(step: TimeStep) -> Self {
        match step {
            TimeStep::Auto => Self::Word("auto".to_owned()),
            TimeStep::Paper => Self::Word("paper".to_owned()),
            TimeStep::Number(dt_star) => Self::Number(dt_star),
        }
    }
}
