//! The outcome of a run, and its line in the journal of a study: `<checksum> <json>`.

use std::sync::Arc;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::summary_values::SummaryValues;
use slipfront_run::summary::Summary;

/// End of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Numbers of the run.
    Done(Box<Summary>),
    /// Reason for the failure.
    Failed(String),
}

/// The part of an outcome that tables and statistics need: numbers, or the reason of the failure.
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

    /// The outcome, or a failure if a number of it is not finite: JSON has no such numbers.
    fn or_not_finite(self) -> Self {
        let json = serde_json::to_string(&self).unwrap_or_default();
        match serde_json::from_str::<Self>(&json) {
            Ok(read_back) if read_back == self => self,
            _ => Self::Failed("a number of its summary is not finite".to_owned()),
        }
    }
}

/// A finished run: one line of the journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FinishedRun {
    /// Identity of the run: a hash of all that decides its numbers.
    pub id: String,
    /// Seconds that the run took. A repeated run differs in this value alone.
    pub wall_time_s: f64,
    /// Outcome of the run.
    pub outcome: Outcome,
}

/// The line of a record with its line break.
pub fn to_line(record: &impl Serialize) -> Vec<u8> {
    // Our own struct of numbers and strings: serialisation cannot fail.
    let json = serde_json::to_string(record).unwrap_or_default();
    format!("{} {json}\n", checksum(json.as_bytes())).into_bytes()
}

/// A record that a line of a journal can hold.
pub trait JournalRecord: DeserializeOwned {
    /// Keys of which every record of this kind has one, in any version of slipfront.
    const KEYS: &'static [&'static str];
}

impl JournalRecord for FinishedRun {
    const KEYS: &'static [&'static str] = &["outcome"];
}

/// A whole line of a journal.
pub(crate) enum Line<T> {
    Record(T),
    /// A record of this kind that another version of slipfront has written.
    OfOtherVersion,
    OfOtherKind,
}

/// The line of a journal without its line break; none if it fails its checksum.
pub(crate) fn parse_line<T: JournalRecord>(line: &[u8]) -> Option<Line<T>> {
    let (sum, json) = line.split_at_checked(CHECKSUM)?;
    let json = json.strip_prefix(b" ")?;
    if checksum(json).as_bytes() != sum {
        return None;
    }
    if let Ok(record) = serde_json::from_slice(json) {
        return Some(Line::Record(record));
    }
    let keys: Map<String, Value> = serde_json::from_slice(json).unwrap_or_default();
    let is_of_kind = T::KEYS.iter().any(|key| keys.contains_key(*key));
    Some(if is_of_kind {
        Line::OfOtherVersion
    } else {
        Line::OfOtherKind
    })
}

/// Whether a line has the form of a record, damaged or not. A file without any such line is not a journal.
pub(crate) fn looks_like_ours(line: &[u8]) -> bool {
    line.get(CHECKSUM) == Some(&b' ') && line.get(CHECKSUM + 1) == Some(&b'{')
}

/// Whether the last line may be the beginning of a record: it ends within the checksum, or consists of zeros, which a power cut
/// can leave.
pub(crate) fn may_begin_ours(line: &[u8]) -> bool {
    let (sum, blank) = line.split_at(line.len().min(CHECKSUM));
    let is_beginning = sum.iter().all(u8::is_ascii_hexdigit) && b" ".starts_with(blank);
    is_beginning || line.iter().all(|&byte| byte == 0)
}

/// Characters of a checksum.
const CHECKSUM: usize = 16;

fn checksum(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex()[..CHECKSUM].to_owned()
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
