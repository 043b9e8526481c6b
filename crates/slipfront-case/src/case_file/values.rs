//! Forms of values that several tables use: pairs, and words in place of numbers.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{Error as _, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::quantity::{Length, QuantityError};

/// Exactly two values. (Serde's own `[T; 2]` leaves a third value unread.)
#[derive(Serialize)]
pub(super) struct Pair<T>(pub(super) [T; 2]);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Pair<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(PairVisitor(PhantomData))
    }
}

/// Visitor that counts the values during the visit, so that an error still gets the place of the pair.
struct PairVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for PairVisitor<T> {
    type Value = Pair<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a pair [x, y]")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Pair<T>, A::Error> {
        let mut values = Vec::new();
        while let Some(value) = elements.next_element()? {
            values.push(value);
        }
        let pair = <[T; 2]>::try_from(values);
        pair.map(Pair)
            .map_err(|values| A::Error::invalid_length(values.len(), &self))
    }
}

/// Reads a length from a text. A text that cannot be read keeps its own message where a value may have
/// several forms.
pub(super) fn length(text: &str) -> Result<Length, String> {
    text.parse().map_err(|error: QuantityError| error.to_string())
}

pub(super) fn pair<'de, D, T>(deserializer: D) -> Result<[T; 2], D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    Pair::deserialize(deserializer).map(|Pair(values)| values)
}

/// Whether a value equals the default of its type, so that a printed case may omit its key.
pub(super) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// A number, or a word in place of one.
#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number, or a word such as \"auto\"")]
pub(super) enum WordOrNumber {
    Number(f64),
    Word(String),
}

/// A number chosen by the user or by the program.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "WordOrNumber", into = "WordOrNumber")]
pub enum AutoOr {
    /// `"auto"`: the program chooses, according to the documentation of the key.
    Auto,
    /// The user's number.
    Number(f64),
}

impl TryFrom<WordOrNumber> for AutoOr {
    type Error = &'static str;

    fn try_from(value: WordOrNumber) -> Result<Self, Self::Error> {
        match value {
            WordOrNumber::Number(number) => Ok(Self::Number(number)),
            WordOrNumber::Word(word) if word == "auto" => Ok(Self::Auto),
            WordOrNumber::Word(_) => Err("expected a number or \"auto\""),
        }
    }
}

impl From<AutoOr> for WordOrNumber {
    fn from(value: AutoOr) -> Self {
        match value {
            AutoOr::Auto => Self::Word("auto".to_owned()),
            AutoOr::Number(number) => Self::Number(number),
        }
    }
}
