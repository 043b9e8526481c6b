//! Errors of the TOML parser and of serde as sentences about a case file.

use std::ops::Range;

use super::error::CaseError;
use super::keys;
use super::source::Source;
use crate::text::truncated;

/// An error of TOML's grammar in text that begins at `offset` of the source.
pub fn syntax_error(source: &Source, offset: usize, error: &toml::de::Error) -> CaseError {
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

/// An error of serde at `span`, while it reads the table under `header`, whose keys are `known`.
pub(super) fn value_error(
    source: &Source,
    span: Range<usize>,
    message: &str,
    header: &str,
    known: &[&str],
) -> CaseError {
    let message = one_line(message);
    if let Some((key, expected)) = name_and_expected(&message, "unknown field `") {
        // A table within the one under `header` has keys of its own.
        let inner = source.key_at(&span).filter(|_| expected != known);
        let sentence = match inner {
            Some(inner) => keys::unknown(&truncated(key), &format!("`{inner}`"), &expected),
            None => keys::unknown(&truncated(key), header, known),
        };
        return source.error_at(span, sentence);
    }
    let complaint = match name_and_expected(&message, "unknown variant `") {
        Some((word, words)) => unknown_word(&truncated(word), &words),
        None => in_plain_words(&message),
    };
    let subject = source.key_at(&span).unwrap_or(header);
    let sentence = format!("`{subject}`: {complaint}");
    source.error_at(span, sentence)
}

/// The name, and those that were expected, in a message of serde: "unknown field `name`, expected one of `a`, `b`".
fn name_and_expected<'m>(message: &'m str, start: &str) -> Option<(&'m str, Vec<&'m str>)> {
    let (name, expected) = message.strip_prefix(start)?.rsplit_once("`, expected ")?;
    Some((name, expected.split('`').skip(1).step_by(2).collect()))
}

fn unknown_word(word: &str, known: &[&str]) -> String {
    let quoted: Vec<String> = known.iter().map(|word| format!("\"{word}\"")).collect();
    let list = quoted.join(", ");
    match keys::nearest(word, known) {
        Some(near) => format!("unknown word {word:?}: did you mean \"{near}\"? It can be {list}"),
        None => format!("unknown word {word:?}: it can be {list}"),
    }
}

fn one_line(message: &str) -> String {
    message.trim().replace('\n', ", ")
}

/// A message of serde with the names of TOML's types in place of those of Rust's.
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
