//! The table `[time]`: duration, steps and end of the run.

use std::ops::Bound::{Excluded, Included};

use serde::{Deserialize, Serialize};
use slipfront::StopReason;

use super::check::Check;
use super::choice::keys_with_choice;
use super::drive::DriveSpeed;
use super::error::CaseError;
use super::key::MAX_TIME_STAR;
use super::key_table::UNSTABLE_STEP;

use super::values::{AutoOr, WordOrNumber, word};
use crate::quantity::Duration;

/// `[time]`: duration, step, end and averaging window of the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "TimeKeys", into = "TimeKeys")]
pub struct Time {
    /// Duration of the run: `duration_star` or `duration`.
    pub duration: RunTime,
    /// The time step.
    pub step: TimeStep,
    /// Condition that ends the run: its duration, or the fall after the first peak of mu* if that comes first.
    pub stop: StopReason,
    /// Start of the window that the kinetic friction is averaged over, in t*; `auto` is 2.5/V* after the onset.
    pub kinetic_from_star: AutoOr,
}

/// The length of the run.
#[derive(Clone, Debug, PartialEq)]
pub enum RunTime {
    /// The key `duration_star`: in t*, more than 0; `auto` is 8/V*, longer for drives that load slower.
    Star(AutoOr),
    /// The key `duration`, in s.
    Duration(Duration),
}

/// The time step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "WordOrNumber", into = "WordOrNumber")]
pub enum TimeStep {
    /// The value `"auto"`: dt* = 0.1.
    Auto,
    /// The value `"paper"`: dt* = (2/3) V* (Eq. 13).
    Paper,
    /// dt* itself, more than 0 and less than 0.9058.
    Number(f64),
}

impl Time {
    /// Checks the times; some bounds depend on the speed of the drive.
    pub(super) fn check(&self, check: &Check, speed: &DriveSpeed) -> Result<(), CaseError> {
        self.duration.check(check)?;
        match (self.step, speed) {
            (TimeStep::Number(dt_star), _) => check.value("step", &dt_star)?,
            (TimeStep::Paper, DriveSpeed::VStar(v_star)) if v_star * 2.0 / 3.0 >= UNSTABLE_STEP => {
                let step = v_star * 2.0 / 3.0;
                return check.refuse("step", |key| {
                    format!(
                        "`{key}` = \"paper\" is (2/3) V* = {step:.4}: it must be less than {UNSTABLE_STEP}; take \"auto\", \
                         or a smaller `drive.v_star`"
                    )
                });
            }
            _ => {}
        }
        if let AutoOr::Number(from) = self.kinetic_from_star {
            let end = match &self.duration {
                RunTime::Star(AutoOr::Number(star)) => Excluded(*star),
                _ => Included(MAX_TIME_STAR),
            };
            let remark = "the average is taken from there to the end of the run";
            check.number_within("kinetic_from_star", from, (Included(0.0), end), remark)?;
        }
        Ok(())
    }
}

keys_with_choice! {
    Time: TimeKeys {
        (duration: RunTime {
            duration_star: AutoOr => Star,
            duration: Duration => Duration,
            _ => "the run needs a length: `duration_star` or `duration`"
        }),
        step: TimeStep,
        #[serde(deserialize_with = "word")]
        stop: StopReason,
        kinetic_from_star: AutoOr,
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
