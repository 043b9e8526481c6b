//! Texts of the lessons contain no digits except those of checked numbers, and use every checked number.

use std::collections::BTreeSet;

use super::content::{LessonWords, numbers, words};

/// Words after which a number is part of a name.
const NAMES: [&str; 3] = ["Fig. ", "Table ", "Eq. "];
/// Allowed number of words of a step.
const STEP_WORDS: std::ops::RangeInclusive<usize> = 40..=120;

/// The texts of a lesson.
fn texts(lesson: &LessonWords) -> impl Iterator<Item = &String> {
    let of_steps = lesson.steps.values().flat_map(|step| {
        let labels = step.set.values();
        std::iter::once(&step.title)
            .chain(step.paragraphs())
            .chain(labels)
    });
    [&lesson.title, &lesson.summary].into_iter().chain(of_steps)
}

/// The ids in the braces of a text, and the text without them.
pub(crate) fn ids(text: &str) -> Result<(Vec<&str>, String), String> {
    let mut rest = text;
    let (mut ids, mut plain) = (Vec::new(), String::new());
    while let Some((before, after)) = rest.split_once('{') {
        let (id, behind) = after
            .split_once('}')
            .ok_or_else(|| format!("a brace is open: {text}"))?;
        plain.push_str(before);
        ids.push(id);
        rest = behind;
    }
    plain.push_str(rest);
    if plain.contains('}') {
        return Err(format!("a brace is closed that was not open: {text}"));
    }
    Ok((ids, plain))
}

/// A text without the numbers of figures, tables and equations.
fn without_names(text: &str) -> String {
    let mut text = text.to_owned();
    for name in NAMES {
        let mut parts = text.split(name);
        let first = parts.next().unwrap_or_default().to_owned();
        let rest = parts.map(|part| part.trim_start_matches(|c: char| c.is_ascii_digit()));
        text = rest.fold(first, |all, part| all + " " + part);
    }
    text
}

fn check(text: &str) -> Result<Vec<&str>, String> {
    let (ids, plain) = ids(text)?;
    if without_names(&plain).contains(char::is_numeric) {
        return Err(format!("a digit stands outside of braces: {text}"));
    }
    if !plain.matches('*').count().is_multiple_of(2) || plain.contains(['<', '>']) {
        return Err(format!("markup is *emphasis* alone: {text}"));
    }
    Ok(ids)
}

#[test]
fn texts_say_known_numbers_and_all_of_them() {
    let (words, numbers) = (words(), numbers());
    let mut used = BTreeSet::new();
    for text in words.values().flat_map(texts) {
        used.extend(check(text).unwrap());
    }
    let known: BTreeSet<&str> = numbers.keys().map(String::as_str).collect();
    assert_eq!(used, known, "left: in texts; right: in lesson_numbers.json");
}

#[test]
fn steps_are_short() {
    for (id, step) in words().values().flat_map(|lesson| &lesson.steps) {
        let count: usize = step
            .paragraphs()
            .map(|text| text.split_whitespace().count())
            .sum();
        assert!(STEP_WORDS.contains(&count), "{id}: {count} words");
    }
}

#[test]
fn digits_braces_and_markup_out_of_place_are_refused() {
    assert_eq!(check("a {b} of Fig. 16, Table 1 and Eq. 4: *so*"), Ok(vec!["b"]));
    for text in ["31 %", "½", "{a", "a}", "V*", "<em>", "Fig. 16 and 17", "k₁"] {
        assert!(check(text).is_err(), "{text}");
    }
}
