//! The outcome of a run of a study, as its journal records it.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::project_folder::JournalEntry;
use crate::summary_values::SummaryValues;
use slipfront_run::summary::Summary;

/// Outcome of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Numbers of the run.
    Done(Box<Summary>),
    /// Reason for the failure.
    Failed(String),
}

/// The part of an outcome that tables and statistics need: numbers, or the reason for the failure.
pub type RunResult = Result<Arc<SummaryValues>, String>;

impl Outcome {
    /// The outcome of a run with these numbers.
    pub fn of(summary: Summary) -> Self {
        Self::Done(Box::new(summary)).or_not_finite()
    }

    /// The part of the outcome that tables and statistics need.
    pub(crate) fn result(&self) -> RunResult {
        match self {
            Self::Done(summary) => Ok(Arc::new(SummaryValues::of(summary))),
            Self::Failed(reason) => Err(reason.clone()),
        }
    }

    /// The outcome, or a failure if one of its numbers is not finite: JSON has no such numbers.
    fn or_not_finite(self) -> Self {
        let json = serde_json::to_string(&self).unwrap_or_default();
        match serde_json::from_str::<Self>(&json) {
            Ok(read_back) if read_back == self => self,
            _ => Self::Failed("a value in its summary is not finite".to_owned()),
        }
    }
}

/// A finished run: one line of the journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FinishedRun {
    /// Identity of the run: a hash of everything that determines its numbers.
    pub id: String,
    /// Seconds that the run took. A repeated run differs only in this value.
    pub wall_time_s: f64,
    /// Outcome of the run.
    pub outcome: Outcome,
}

impl JournalEntry for FinishedRun {
    const KEYS: &'static [&'static str] = &["outcome"];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_json_cannot_hold_is_a_failure() {
        let outcome = |value| {
            let summary = Summary {
                energy_error: value,
                ..Summary::default()
            };
            Outcome::of(summary)
        };
        assert!(matches!(outcome(0.1), Outcome::Done(_)));
        assert!(matches!(outcome(f64::NAN), Outcome::Failed(_)));
        assert!(matches!(outcome(f64::INFINITY), Outcome::Failed(_)));
    }
}
