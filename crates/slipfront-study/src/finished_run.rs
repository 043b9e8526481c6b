//! The outcome of a run of a study, as its journal records it.

use std::path::Path;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use slipfront_base::disk::json;
use slipfront_run::manifest::{Manifest, ManifestFile};
use slipfront_run::names::CASE;
use slipfront_run::run_copy::file_names;

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
    pub fn from_summary(summary: Summary) -> Self {
        Self::Done(Box::new(summary)).or_not_finite()
    }

    /// The part of the outcome that tables and statistics need.
    pub(crate) fn result(&self) -> RunResult {
        match self {
            Self::Done(summary) => Ok(Arc::new(SummaryValues::from_summary(summary))),
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
    /// Seal of the manifest of its folder, or of a run that failed a hash of its case; none if no folder was
    /// kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept: Option<String>,
}

/// Tells a kept run folder from any other: the seal of the manifest, or of a run that failed a hash of the
/// case and the files that it reads. None if the folder has no such files, or they are damaged.
pub(crate) fn mark_of(folder: &Path, is_done: bool) -> Option<String> {
    if is_done {
        return Some(Manifest::read(folder).ok()?.checksum);
    }
    let mut names = file_names(folder).ok()?;
    names.retain(|name| name == CASE || name.starts_with("inputs/"));
    names.sort();
    let files = names.iter().map(|name| ManifestFile::read(folder, name));
    let files = files.collect::<std::io::Result<Vec<_>>>().ok()?;
    (names.iter().any(|name| name == CASE)).then(|| blake3::hash(&json(&files)).to_hex().to_string())
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
            Outcome::from_summary(summary)
        };
        assert!(matches!(outcome(0.1), Outcome::Done(_)));
        assert!(matches!(outcome(f64::NAN), Outcome::Failed(_)));
        assert!(matches!(outcome(f64::INFINITY), Outcome::Failed(_)));
    }
}
