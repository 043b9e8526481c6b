//! What can be wrong with a case file, in sentences that name the place and the remedy.

use std::io;
use std::ops::Range;
use std::path::PathBuf;

use thiserror::Error;

use super::keys;
use super::source::{Place, Source};
use crate::text;
use crate::text::truncated;

/// A case file that cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CaseError {
    /// The file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The path names a folder.
    #[error("{} is a folder: name the file in it", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
    },
    /// The file is larger than any case file is.
    #[error("{} is larger than {limit_mib} MiB, so it is no case or study file", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The largest size that is read, in MiB.
        limit_mib: u64,
    },
    /// The file is not text.
    #[error("{}:{line}: the file is not UTF-8 text", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
        /// The line of the first byte that is not UTF-8, from 1.
        line: usize,
    },
    /// The case cannot be expressed in TOML.
    #[error("the case cannot be written as TOML: {0}")]
    Unwritable(#[from] toml::ser::Error),
    /// Something that is written in the case, or in a `--set`, is wrong.
    #[error(transparent)]
    Invalid(Box<Invalid>),
}

/// Something that is wrong with the contents of a case, and where.
#[derive(Debug, Error)]
#[error("{}{sentence}{}", place.as_ref().map(|place| format!("{place}: ")).unwrap_or_default(),
    place.as_ref().map(Place::excerpt).unwrap_or_default())]
pub struct Invalid {
    /// Where it was written; none for values that were set in code.
    pub place: Option<Place>,
    /// What is wrong, and what to write instead.
    pub sentence: String,
}

impl CaseError {
    /// An invalid value or key at a place, in a sentence.
    pub fn invalid(place: Option<Place>, sentence: impl Into<String>) -> Self {
        let sentence = text::single_line(&sentence.into());
        Self::Invalid(Box::new(Invalid { place, sentence }))
    }

    /// An error of TOML's grammar.
    pub fn syntax(source: &Source, offset: usize, error: &toml::de::Error) -> Self {
        let span = error.span().unwrap_or(0..0);
        let span = span.start + offset..span.end + offset;
        let message = one_line(error.message());
        let sentence = if message == "duplicate key" {
            format!(
                "duplicate key `{}`: it is already set in this table",
                source.slice(span.clone())
            )
        } else {
            format!("this is not valid TOML: {message}")
        };
        source.error_at(span, sentence)
    }

    /// An error of serde's, at `span`, while it reads the table under `header`, whose keys are `known`.
    pub fn value(source: &Source, span: Range<usize>, message: &str, header: &str, known: &[&str]) -> Self {
        let message = one_line(message);
        if let Some((key, expected)) = name_and_rest(&message, "unknown field `") {
            let expected: Vec<&str> = expected.split('`').skip(1).step_by(2).collect();
            // A table within the one under `header` has keys of its own.
            let inner = source.key_at(&span).filter(|_| expected != known);
            let sentence = match inner {
                Some(inner) => keys::unknown(&truncated(key), &format!("`{inner}`"), &expected),
                None => keys::unknown(&truncated(key), header, known),
            };
            return source.error_at(span, sentence);
        }
        let complaint = match name_and_rest(&message, "unknown variant `") {
            Some((word, expected)) => {
                let words: Vec<&str> = expected.split('`').skip(1).step_by(2).collect();
                unknown_word(&truncated(word), &words)
            }
            None => in_plain_words(&message),
        };
        let subject = source.key_at(&span).unwrap_or(header);
        let sentence = format!("`{subject}`: {complaint}");
        source.error_at(span, sentence)
    }
}

/// Takes serde's "unknown field `name`, expected ..." apart.
fn name_and_rest<'m>(message: &'m str, start: &str) -> Option<(&'m str, &'m str)> {
    message.strip_prefix(start)?.rsplit_once("`, expected ")
}

fn unknown_word(word: &str, known: &[&str]) -> String {
    let list = known
        .iter()
        .map(|word| format!("\"{word}\""))
        .collect::<Vec<_>>()
        .join(", ");
    match keys::nearest(word, known) {
        Some(near) => format!("unknown word {word:?}: did you mean \"{near}\"? It can be {list}"),
        None => format!("unknown word {word:?}: it can be {list}"),
    }
}

fn one_line(message: &str) -> String {
    message.trim().replace('\n', ", ")
}

/// Serde speaks of Rust's types; a user knows TOML's.
fn in_plain_words(message: &str) -> String {
    const WORDS: [(&str, &str); 8] = [
        ("missing field", "it needs the key"),
        ("integer number overflowed", "the whole number is too large"),
        ("expected f64", "expected a number"),
        ("expected u32", "expected a whole number from 0 to 4294967295"),
        (
            "expected u64",
            "expected a whole number from 0 to 9223372036854775807",
        ),
        ("type: map", "type: table"),
        ("sequence", "list"),
        ("floating point", "number"),
    ];
    WORDS.iter().fold(message.to_owned(), |text, (rust, plain)| {
        text.replace(rust, plain)
    })
}
