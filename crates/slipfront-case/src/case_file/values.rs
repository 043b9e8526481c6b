//! Forms of values that several tables use: pairs, and words in place of numbers.

use std::fmt;
use std::marker::PhantomData;

use serde::de::value::Error as ValueError;
use serde::de::{Error as _, IntoDeserializer, SeqAccess, Visitor};
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

/// One of the words of `T`, an enum of unit variants, which serde would also read from a table
/// `{ word = {} }`.
struct Word<T>(T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Word<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut found = None;
        deserializer.deserialize_str(WordVisitor(&mut |word| {
            found = Some(T::deserialize(word.to_owned().into_deserializer())?);
            Ok(())
        }))?;
        found
            .map(Word)
            .ok_or_else(|| D::Error::custom("expected a word in quotes"))
    }
}

/// Visitor that looks up a word during the visit, so that an error still gets the place of the word. It is
/// not generic, so that all words share its code.
struct WordVisitor<'a>(&'a mut dyn FnMut(&str) -> Result<(), ValueError>);

impl Visitor<'_> for WordVisitor<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a word in quotes")
    }

    fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<(), E> {
        (self.0)(word).map_err(E::custom)
    }
}

pub(super) fn word<'de, D, T>(deserializer: D) -> Result<T, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    Word::deserialize(deserializer).map(|Word(value)| value)
}

pub(super) fn some_word<'de, D, T>(deserializer: D) -> Result<Option<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    word(deserializer).map(Some)
}

pub(super) fn words<'de, D, T>(deserializer: D) -> Result<Vec<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    let words: Vec<Word<T>> = Vec::deserialize(deserializer)?;
    Ok(words.into_iter().map(|Word(value)| value).collect())
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
