//! The table `[output]`: the results to write, their instants and their resolution.

use serde::{Deserialize, Serialize};
use slipfront::observe::Field;

use super::check::{Check, Checked};
use super::error::CaseError;
use super::key::{AUTO, KeyKind, MAX_TIME_STAR, POSITIVE_TIME, key, number, or_word, within};
use super::serde_names::names_of;
use super::slider::MAX_BLOCKS;
use super::values::AutoOr;
use crate::key_rows;
use slipfront_base::number_format::exact;

key_rows! {
    /// The table `[output]`: snapshots, fields and the series.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Output checked {
        /// Instants at which fields are written. `"auto"` is the instants A to F of Fig. 4. A list contains
        /// times t* in increasing order, from 0 to 1e9; `[]` writes none. `every` is multiples of this t*
        /// (more than 0, at most 1e9), in addition to the instants A to F.
        pub snapshots: Snapshots = key("\"auto\"", KeyKind::Special("`\"auto\"`, a list, or `{ every = 5.0 }`")),
        /// Fields that are written at these instants.
        pub fields: Vec<Field> = key("[\"contact_stress_star\", \"traction\", \"displacement_x\", \"displacement_y\", \"sliding\"]",
            KeyKind::Words(names_of::<Field>))
                .further_bounds(", each at most once; `\"traction\"` is blank over a texture"),
        /// Stride of the fields file, which contains every n-th block along x and along y.
        pub stride: u32 = key("1", KeyKind::Whole { least: 1, most: MAX_BLOCKS, noun: "", remark: "; 1 writes every block" }),
        /// Spacing of the rows of the series in t*; `"auto"` is one step, or the spacing that gives at most
        /// 20 000 rows.
        pub series: AutoOr = key("\"auto\"", SPACING),
        /// Whether a movie is drawn of the snapshots, `movie.gif`.
        pub movie: bool = key("false", KeyKind::Switch)
            .note("See [pictures](../guide/results.md#pictures). It needs from 1 to 1000 snapshots of the field that it shows."),
        /// Whether a catalogue of the events of slip is kept, `events.csv`: when and where each begins, its
        /// blocks and its moment.
        #[serde(skip_serializing_if = "std::ops::Not::not")]
        pub events: bool = key("false", KeyKind::Switch)
            .note("See [events](../guide/results.md#eventscsv). Springs in contact that form again have none."),
        /// Whether the last state is written, `state.npy`, in which another case can begin.
        #[serde(skip_serializing_if = "std::ops::Not::not")]
        pub final_state: bool = key("false", KeyKind::Switch).note("See [`[initial]`](#initial)."),
    }
}

/// Kind of a time between snapshots or rows.
const SPACING: KeyKind = or_word(POSITIVE_TIME, "it is a spacing in t*", AUTO);

/// Kind of a time in a list of snapshots.
const SNAPSHOT_TIME: KeyKind = number(within(0.0, MAX_TIME_STAR), "snapshots are times t*");

/// The instants at which fields are written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "SnapshotsKey", into = "SnapshotsKey")]
pub enum Snapshots {
    /// `"auto"`: the instants A to F of Fig. 4, found by the run itself.
    Auto,
    /// A list of times t*, increasing; no snapshots if it is empty.
    At(Vec<f64>),
    /// `{ every = 5.0 }`: at multiples of this t*, and at the instants A to F.
    Every(f64),
}

impl Output {
    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        self.check_values(check)?;
        if let Snapshots::At(times) = &self.snapshots
            && let Some(pair) = times.windows(2).find(|pair| pair[0] >= pair[1])
        {
            let (later, earlier) = (exact(pair[1]), exact(pair[0]));
            return check.refuse("snapshots", |key| {
                format!("`{key}` has {later} after {earlier}: list the times in increasing order, each once")
            });
        }
        let fields = &self.fields;
        if (1..fields.len()).any(|n| fields[..n].contains(&fields[n])) {
            return check.refuse("fields", |key| {
                format!("`{key}` names a field twice: name each once")
            });
        }
        Ok(())
    }
}

impl Checked for Snapshots {
    fn check(&self, check: &Check, key: &str, _: &KeyKind) -> Result<(), CaseError> {
        match self {
            Self::Auto => Ok(()),
            // The place of the error is the key `every`, in a table of its own or within the value of
            // `snapshots`.
            Self::Every(every) => every.check(check, &format!("{key}.every"), &SPACING),
            Self::At(times) => times
                .iter()
                .try_for_each(|time| time.check(check, key, &SNAPSHOT_TIME)),
        }
    }
}
/// `snapshots` as in the file.
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
