//! Errors of the TOML parser and of serde as sentences about a case file.

use std::ops::Range;

use super::check::in_words;
use super::error::CaseError;
use super::key::{Key, KeyKind};
use super::key_table::Section;
use super::keys;
use super::source::Source;
use super::synonyms::advice_on;
use crate::nearest::nearest;
use slipfront_base::text::truncated;

/// Messages of the parser about common mistakes, by their beginnings, and the advice to the user on each.
const GRAMMAR: [(&str, &str); 7] = [
    (
        "string values must be quoted",
        "a string must be in quotes, such as \"100 kPa\"",
    ),
    (
        "invalid boolean",
        "a word must be in quotes, unless it is true or false",
    ),
    ("invalid mantissa", "a number begins with a digit, such as 0.03"),
    (
        "invalid basic string, expected `\"`",
        "the quotes of a string are not closed",
    ),
    (
        "unexpected key or value",
        "there must be one value after `=`; write a list in [ ] and a string in quotes",
    ),
    ("key with no value", "a key and its value are joined by `=`"),
    ("invalid key-value pair", "a line is `key = value` or `[table]`"),
];

/// An error of TOML syntax in text that begins at `offset` of the source.
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
        let advice = advice_on_words(source, &span, &message).or_else(|| {
            let plain = GRAMMAR.iter().find(|(start, _)| message.starts_with(start));
            plain.map(|(_, plain)| (*plain).to_owned())
        });
        format!("this is not valid TOML: {}", advice.unwrap_or(message))
    };
    source.error_at(span, sentence)
}

/// Typographic quotation marks, which word processors put in place of straight ones.
const PRINTED_QUOTES: [char; 8] = [
    '\u{201c}', '\u{201d}', '\u{201e}', '\u{2018}', '\u{2019}', '\u{201a}', '\u{ab}', '\u{bb}',
];

/// Advice on words at a span that is not TOML, if they show what the user meant: the message of the parser
/// describes only what it takes them for.
fn advice_on_words(source: &Source, span: &Range<usize>, message: &str) -> Option<String> {
    let (before, after) = source.line_around(span.start);
    let marked = source.slice(span.clone());
    // For a string that seems unclosed, the span is after its end.
    let in_text = if message.starts_with("invalid basic string") {
        before
    } else {
        ""
    };
    let mut looked_at = in_text.chars().chain(marked.chars()).chain(after.chars().next());
    if let Some(quote) = looked_at.find(|c| PRINTED_QUOTES.contains(c)) {
        return Some(format!(
            "{quote} is a typographic quotation mark: write a string in straight ones, such as \"100 kPa\""
        ));
    }
    if [
        "too few unicode value digits",
        "missing escaped value",
        "value is out of range",
    ]
    .iter()
    .any(|start| message.starts_with(start))
    {
        return Some(
            "a backslash begins an escape sequence: write a Windows path in single quotes, such as 'C:\\data\\map.csv', or /"
                .to_owned(),
        );
    }
    let words: Vec<&str> = marked.split_whitespace().collect();
    if words.len() > 1 && words.iter().all(|word| word.parse::<f64>().is_ok()) {
        let list = words.join(", ");
        return Some(format!(
            "the numbers of a list have commas between them: [{}]",
            truncated(&list)
        ));
    }
    let rest = after.strip_prefix(',')?;
    let whole = before.rsplit(|c: char| c.is_whitespace() || c == '=').next()?;
    let digits = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    let decimals = &rest[..digits];
    // In a number, only digits surround a comma.
    (!decimals.is_empty() && whole.parse::<i64>().is_ok()).then(|| {
        let (point, list) = (format!("{whole}.{decimals}"), format!("[{whole}, {decimals}]"));
        format!(
            "there must be one value after `=`; the decimal sign is a point, {}, and a list is in brackets, {}",
            truncated(&point),
            truncated(&list)
        )
    })
}

/// An error of serde at `span`, while reading the table under `header` with the keys `known`. They are the
/// keys of `section` if the table is one of a case.
pub(super) fn value_error(
    source: &Source,
    span: Range<usize>,
    message: &str,
    header: &str,
    known: &[&str],
    section: Option<&Section>,
) -> CaseError {
    let message = one_line(message);
    if let Some((key, expected)) = name_and_expected(&message, "unknown field `") {
        // A table within the one under `header` has its own keys.
        let inner = source.key_at(&span).filter(|_| expected != known);
        let sentence = match inner {
            Some(inner) => keys::unknown(&truncated(key), &format!("`{inner}`"), &expected),
            // A table may be read in parts.
            None => {
                let all = section.map(|section| section.keys.iter().map(|key| key.name).collect());
                keys::unknown(&truncated(key), header, &all.unwrap_or(known.to_vec()))
            }
        };
        return source.error_at(span, sentence);
    }
    let path = source.key_at(&span);
    let subject = path.unwrap_or(header);
    let key = path.and_then(|path| section?.key(path.rsplit('.').next()?));
    let sentence = if let Some((word, words)) = name_and_expected(&message, "unknown variant `") {
        format!("`{subject}`: {}", unknown_word(&truncated(word), &words, subject))
    } else if let Some(expected) = expected_by(&message) {
        let whole = source.written(subject);
        let takes = key.and_then(|key| takes(key, &message));
        // An element of a list with its own form, such as a corner of a polygon, is quoted alone.
        let (verb, written) = match source.slice(span.clone()) {
            element if takes.is_none() && element != whole => ("holds", element),
            _ => ("is", whole),
        };
        let takes = takes.unwrap_or_else(|| in_plain_words(expected));
        let written = truncated(written);
        let hint = key.map_or(String::new(), |key| hint(key, section, &written));
        format!("`{subject}` {verb} {written}: it must be {takes}{hint}")
    } else {
        let has_no_unit = message.contains(" has no unit; ");
        let key = key.filter(|_| has_no_unit);
        let hint = key.map_or(String::new(), |key| hint(key, section, ""));
        let message = message.replace("missing field", "it needs the key");
        format!("`{subject}`: {message}{hint}")
    };
    source.error_at(span, sentence)
}

/// The unknown name and the expected names in a message of serde: "unknown field `name`, expected one of `a`,
/// `b`".
fn name_and_expected<'m>(message: &'m str, start: &str) -> Option<(&'m str, Vec<&'m str>)> {
    let (name, expected) = message.strip_prefix(start)?.rsplit_once("`, expected ")?;
    Some((name, expected.split('`').skip(1).step_by(2).collect()))
}

/// Advice on a word that is not one of the `known` words. A synonym is suggested if it is in the table of the
/// `subject`, the key of the word.
fn unknown_word(word: &str, known: &[&str], subject: &str) -> String {
    let quoted: Vec<String> = known.iter().map(|word| format!("\"{word}\"")).collect();
    let list = quoted.join(", ");
    let table = subject.split('.').next().unwrap_or(subject);
    let advice = advice_on(word).filter(|advice| advice.contains(&format!("`{table}.")));
    match (nearest(word, known), advice) {
        (Some(near), _) => format!("unknown word {word:?}: did you mean \"{near}\"? It can be {list}"),
        (None, Some(advice)) => format!("unknown word {word:?}: {advice}. It can be {list}"),
        (None, None) => format!("unknown word {word:?}: it can be {list}"),
    }
}

fn one_line(message: &str) -> String {
    message.trim().replace('\n', ", ")
}

/// The expected type in a message of serde about a value of the wrong type or length.
fn expected_by(message: &str) -> Option<&str> {
    if message == "integer number overflowed" {
        return Some("a whole number");
    }
    let is_about_type = ["invalid type: ", "invalid value: ", "invalid length "]
        .iter()
        .any(|start| message.starts_with(start));
    if is_about_type {
        message.rsplit_once(", expected ").map(|(_, expected)| expected)
    } else {
        message
            .strip_prefix("expected ")
            .or_else(|| message.strip_prefix("wanted "))
    }
}

/// The values that a key accepts according to the table of keys; none where serde says more about their form.
fn takes(key: &Key, message: &str) -> Option<String> {
    let example = if key.default.starts_with('[') {
        format!(", such as {}", key.default)
    } else {
        String::new()
    };
    Some(match key.kind {
        KeyKind::Number { bounds, words, .. } => {
            let words: String = words.iter().map(|word| format!(", or \"{word}\"")).collect();
            format!("a number, {}{words}", in_words(bounds))
        }
        KeyKind::Whole { least, most, .. } if example.is_empty() => {
            format!("a whole number from {least} to {most}")
        }
        KeyKind::Whole { least, most, .. } => {
            format!("a pair of whole numbers from {least} to {most}{example}")
        }
        // The message of the word or pair of words already says so.
        KeyKind::Words(_) if message.starts_with("expected ") => return None,
        KeyKind::Words(words) => {
            let words: Vec<String> = words().iter().map(|word| format!("\"{word}\"")).collect();
            let list = if example.is_empty() { "one of" } else { "a list of" };
            format!("{list} {}", words.join(", "))
        }
        KeyKind::Switch => "true or false".to_owned(),
        KeyKind::File(formats) => format!("the path of a .{} file, in quotes", formats.join(" or .")),
        KeyKind::Quantity { .. } | KeyKind::Table(..) | KeyKind::Special(_) => return None,
    })
}

/// Further advice about a value, as `written`. A number needs no quotes, and a decimal point instead of a
/// comma. A key with a unit may have a partner without one, and vice versa. Otherwise the advice is the
/// remark on the number.
fn hint(key: &Key, section: Option<&Section>, written: &str) -> String {
    let quantity = |key: &Key| matches!(key.kind, KeyKind::Quantity { .. });
    // The partner with a unit if this key has none, or without.
    let mut partners = key.partners().filter_map(|name| section?.key(name));
    let partner = partners.find(|partner| quantity(partner) != quantity(key));
    let inside = written.trim_matches(['"', '\'']);
    let is_number = inside.parse::<f64>().is_ok();
    let begins_as_number = inside.starts_with(|c: char| c.is_ascii_digit());
    let with_point = inside.replace(',', ".");
    match (key.kind, partner) {
        (KeyKind::Number { .. }, _)
            if begins_as_number && !is_number && with_point.parse::<f64>().is_ok() =>
        {
            format!("; the decimal sign is a point: {with_point}")
        }
        (KeyKind::Number { .. } | KeyKind::Whole { .. }, _) if is_number && inside != written => {
            "; write it without quotes".to_owned()
        }
        (KeyKind::Number { .. }, Some(partner))
            if quantity(partner) && begins_as_number && inside.ends_with(char::is_alphabetic) =>
        {
            format!("; with a unit, the key is `{}`", partner.name)
        }
        // The partner is the same quantity without a unit, such as `v_star` for `speed`, or another quantity,
        // such as `coverage` for `lambda`.
        (KeyKind::Quantity { .. }, Some(partner))
            if partner.name.ends_with("_star") && written.is_empty() =>
        {
            format!("; without a unit, the key is `{}`", partner.name)
        }
        (KeyKind::Number { remark, .. }, _) => format!("; {remark}"),
        _ => String::new(),
    }
}

/// The type that serde expected, in TOML's terms instead of Rust's.
fn in_plain_words(expected: &str) -> String {
    const WORDS: [(&str, &str); 9] = [
        ("f64", "a number"),
        ("u32", "a whole number, not negative"),
        ("u64", "a whole number, not negative"),
        ("usize", "a whole number, not negative"),
        ("a boolean", "true or false"),
        ("a string", "a text in quotes"),
        ("string or table", "a word in quotes"),
        ("a sequence", "a list"),
        ("a map", "a table of keys"),
    ];
    let plain = WORDS.iter().find(|(rust, _)| *rust == expected);
    match plain {
        Some((_, plain)) => (*plain).to_owned(),
        None if expected.starts_with("struct ") => "a table of keys".to_owned(),
        None if expected.starts_with("enum ") => "a word in quotes".to_owned(),
        None => expected.to_owned(),
    }
}
