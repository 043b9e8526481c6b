//! The table `[output]`: the results that are written, their instants and their resolution.

use serde::{Deserialize, Serialize};
use slipfront::observe::Field;

use super::check::Check;
use super::error::CaseError;
use super::key_table::{SNAPSHOT_TIME, SPACING};
use super::values::{AutoOr, words};
use slipfront_base::number_format::exact;

/// The table `[output]`: snapshots, fields and the series.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// The instants at which fields are written.
    pub snapshots: Snapshots,
    /// The fields that are written at these instants.
    #[serde(deserialize_with = "words")]
    pub fields: Vec<Field>,
    /// Stride n of the fields file, which has every n-th block along x and along y; 1 or more.
    pub stride: u32,
    /// Spacing of the rows of the series in t*; `auto` is every step, or as many as give at most 20 000 rows.
    pub series: AutoOr,
    /// Whether a movie is drawn of the run.
    pub movie: bool,
}

/// The instants at which fields are written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "SnapshotsKey", into = "SnapshotsKey")]
pub enum Snapshots {
    /// `"auto"`: the instants A to F of Fig. 4, found by the run itself.
    Auto,
    /// A list of t*, increasing; none when empty.
    At(Vec<f64>),
    /// `{ every = 5.0 }`: at multiples of that t*, and at the instants A to F.
    Every(f64),
}

impl Output {
    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        match &self.snapshots {
            Snapshots::Auto => {}
            // A table of its own in the file, or the value of `snapshots`: either has a place.
            Snapshots::Every(every) => check.value_of(&SPACING, "snapshots.every", every)?,
            Snapshots::At(times) => {
                for time in times {
                    check.value_of(&SNAPSHOT_TIME, "snapshots", time)?;
                }
                if let Some(pair) = times.windows(2).find(|pair| pair[0] >= pair[1]) {
                    let (later, earlier) = (exact(pair[1]), exact(pair[0]));
                    return check.refuse("snapshots", |key| {
                        format!(
                            "`{key}` has {later} after {earlier}: list the times in increasing order, each once"
                        )
                    });
                }
            }
        }
        let fields = &self.fields;
        if (1..fields.len()).any(|n| fields[..n].contains(&fields[n])) {
            return check.refuse("fields", |key| {
                format!("`{key}` names a field twice: name each once")
            });
        }
        check.value("stride", &u64::from(self.stride))?;
        check.value("series", &self.series)
    }
}

/// `snapshots` as it stands in the file.
#[derive(Serialize, Deserialize)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "expected \"auto\", a list of times t* such as [10.0, 80.0], or { every = 5.0 }"
)]
enum SnapshotsKey {
    Word(String),
    At(Vec<f64>),
    Every { every: f64 },
}

impl TryFrom<SnapshotsKey> for Snapshots {
    type Error = &'static str;

    fn try_from(key: SnapshotsKey) -> Result<Self, Self::Error> {
        match key {
            SnapshotsKey::Word(word) if word == "auto" => Ok(Self::Auto),
            SnapshotsKey::Word(_) => {
                Err("expected \"auto\", a list of times t* such as [10.0, 80.0], or { every = 5.0 }")
            }
            SnapshotsKey::At(times) => Ok(Self::At(times)),
            SnapshotsKey::Every { every } => Ok(Self::Every(every)),
        }
    }
}

impl From<Snapshots> for SnapshotsKey {
    fn from(snapshots: Snapshots) -> Self {
        match snapshots {
            Snapshots::Auto => Self::Word("auto".to_owned()),
            Snapshots::At(times) => Self::At(times),
            Snapshots::Every(every) => Self::Every { every },
        }
    }
}
