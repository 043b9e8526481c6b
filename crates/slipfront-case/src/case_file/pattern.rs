//! Keys `pitch`, `array`, `lattice`, `repeat` and `invert` of a `[[texture]]`: the copies of its shape.

use serde::{Deserialize, Serialize};

use super::check::{Check, Checked};
use super::error::CaseError;
use super::key::{KeyKind, SIZE, key, whole};
use super::serde_names::names_of;
use super::values::{Pair, length};
use super::words::Arrangement;
use crate::key_rows;
use crate::quantity::Length;

/// Largest total number of columns, and of rows, of all arrays of a texture.
pub(crate) const MAX_COUNT: u64 = 1000;
/// Kind of the number of columns and rows.
const COUNT: KeyKind = whole(1, MAX_COUNT);

/// Kind of the distance between neighbours.
pub(super) const PITCH: KeyKind = KeyKind::Special("a length, or a pair; more than 0, at most 1e9 m");

key_rows! {
    /// The pattern that repeats the shape of a texture; by default there is a single copy.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Pattern checked {
        /// Distance between neighbouring copies.
        pub pitch: Option<Pitch> = key("", PITCH).title("pitch", "", "m"),
        /// Number of columns and rows of copies: `"auto"` is as many as fit with a `pitch`, and one without.
        pub array: Count = key("\"auto\"", KeyKind::Special("`\"auto\"`, or a pair from 1 to 1000")),
        /// Arrangement of the copies.
        pub lattice: Arrangement = key("\"square\"", KeyKind::Words(names_of::<Arrangement>)),
        /// Pattern that repeats the array.
        pub repeat: Option<Array> = key("", KeyKind::Special("`{ array = [3, 3], pitch = \"20 um\", lattice = \"square\" }`")),
        /// Whether the area outside the copies is textured instead of the area inside.
        pub invert: bool = key("false", KeyKind::Switch),
    }
}

/// Array of places in columns and rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Array {
    /// Distance between neighbouring places.
    pub pitch: Option<Pitch>,
    /// Number of columns and rows.
    #[serde(default)]
    pub array: Count,
    /// Arrangement of the places.
    #[serde(default)]
    pub lattice: Arrangement,
}

/// The key `array`: columns and rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "CountKey", into = "CountKey")]
pub enum Count {
    /// The value `"auto"`: as many as fit in steps of `pitch`, or one without a pitch.
    #[default]
    Auto,
    /// The value `[columns, rows]`, 1 to 1000 each.
    Of([u32; 2]),
}

/// The key `pitch`: the distance between neighbours, m.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "PitchKey", into = "PitchKey")]
pub enum Pitch {
    /// One length: between columns and between rows, or between all neighbours of a hexagonal lattice.
    Equal(Length),
    /// The value `[x, y]`: between columns, and between rows.
    Each([Length; 2]),
}

impl Pattern {
    /// The arrays, the outermost first, with the prefix of the names of their keys.
    pub(crate) fn arrays(&self) -> impl Iterator<Item = (&'static str, Array)> + '_ {
        let own = Array {
            pitch: self.pitch.clone(),
            array: self.array,
            lattice: self.lattice,
        };
        let repeat = self.repeat.clone().map(|array| ("repeat.", array));
        repeat.into_iter().chain([("", own)])
    }

    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        self.check_values(check)?;
        for (before, array) in self.arrays() {
            array.check_lattice(check, before)?;
        }
        if let Some(repeat) = &self.repeat
            && !repeat.is_array()
        {
            let sentence = |key: &str| {
                format!("`{key}` says nothing of how often: give it `array` = [3, 3], or `pitch` = \"20 um\"")
            };
            return check.refuse("repeat", sentence);
        }
        Ok(())
    }
}

impl Array {
    /// Whether the array has more than one place.
    pub(crate) fn is_array(&self) -> bool {
        self.pitch.is_some() || self.array != Count::Auto
    }

    fn check_lattice(&self, check: &Check, before: &str) -> Result<(), CaseError> {
        let key = |name: &str| format!("{before}{name}");
        match (self.lattice, &self.pitch) {
            (Arrangement::Hexagonal, Some(Pitch::Each(_))) => check.refuse(&key("pitch"), |path| {
                format!(
                    "`{path}` is a pair, and a hexagonal lattice has the same distance between all neighbours: write one length, or \
                     `lattice` = \"staggered\""
                )
            }),
            (Arrangement::Hexagonal | Arrangement::Staggered, _) if !self.is_array() => {
                check.refuse(&key("lattice"), |path| {
                    format!(
                        "`{path}` arranges many copies, and there is one: give `array` = [4, 4], at most {MAX_COUNT} each way, or \
                         `pitch` = \"12 um\", which fills the slider"
                    )
                })
            }
            _ => Ok(()),
        }
    }
}

impl Pitch {
    fn lengths(&self) -> &[Length] {
        match self {
            Self::Equal(length) => std::slice::from_ref(length),
            Self::Each(lengths) => lengths,
        }
    }
}

impl Checked for Array {
    fn check(&self, check: &Check, key: &str, kind: &KeyKind) -> Result<(), CaseError> {
        self.array.check(check, &format!("{key}.array"), kind)?;
        self.pitch.check(check, &format!("{key}.pitch"), kind)
    }
}

impl Checked for Count {
    fn complaint(&self, _: &KeyKind) -> Option<String> {
        match self {
            Self::Auto => None,
            Self::Of(count) => count.complaint(&COUNT),
        }
    }
}

impl Checked for Pitch {
    fn complaint(&self, _: &KeyKind) -> Option<String> {
        self.lengths().iter().find_map(|length| length.complaint(&SIZE))
    }
}

const COUNT_EXPECTED: &str = "expected \"auto\" or a pair of whole numbers from 1 to 1000, such as [4, 3]";

/// The key `array` as in the file.
#[derive(Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "expected \"auto\" or a pair of whole numbers from 1 to 1000, such as [4, 3]"
)]
enum CountKey {
    Word(String),
    Pair(Pair<u32>),
}

impl TryFrom<CountKey> for Count {
    type Error = &'static str;

    fn try_from(key: CountKey) -> Result<Self, Self::Error> {
        match key {
            CountKey::Word(word) if word == "auto" => Ok(Self::Auto),
            CountKey::Word(_) => Err(COUNT_EXPECTED),
            CountKey::Pair(Pair(count)) => Ok(Self::Of(count)),
        }
    }
}

impl From<Count> for CountKey {
    fn from(count: Count) -> Self {
        match count {
            Count::Auto => Self::Word("auto".to_owned()),
            Count::Of(count) => Self::Pair(Pair(count)),
        }
    }
}

/// The key `pitch` as in the file. It holds texts, so that a length that cannot be read keeps its own
/// message.
#[derive(Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "expected a length such as \"12 um\", or a pair of them, [\"12 um\", \"8 um\"]"
)]
enum PitchKey {
    Equal(String),
    Each(Pair<String>),
}

impl TryFrom<PitchKey> for Pitch {
    type Error = String;

    fn try_from(key: PitchKey) -> Result<Self, String> {
        Ok(match key {
            PitchKey::Equal(text) => Self::Equal(length(&text)?),
            PitchKey::Each(Pair([x, y])) => Self::Each([length(&x)?, length(&y)?]),
        })
    }
}

impl From<Pitch> for PitchKey {
    fn from(pitch: Pitch) -> Self {
        match pitch {
            Pitch::Equal(length) => Self::Equal(length.to_string()),
            Pitch::Each(lengths) => Self::Each(Pair(lengths.map(|length| length.to_string()))),
        }
    }
}
