//! The text of a case file and its overrides, and the place of each value in it.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::{CaseError, Place};
use slipfront_base::ordered::map_of;
use slipfront_base::text::truncated;

/// Largest length of a key with a recorded place, in bytes; all known keys are shorter. Without the limit, a
/// key of many megabytes would be stored again for each key below it.
const MAX_KEY: usize = 64;

/// The text of a case, kept so that later errors can name their place.
///
/// All sources compare equal, so that cases from different texts may be equal.
#[derive(Clone, Debug, Default)]
pub struct Source {
    name: Arc<str>,
    file: Arc<str>,
    /// The overrides, each with the position of its first byte. Positions continue after the file, so that a
    /// span identifies its text.
    overrides: Vec<(usize, String)>,
    /// The span of every value by its key, such as `drive.v_star` or `texture.0.coverage`, without longer
    /// keys.
    places: BTreeMap<String, Range<usize>>,
    /// The file that contains this text as a table, if the user did not write the text itself.
    whole: Option<Arc<Whole>>,
}

/// A file that holds a case as one of its tables.
#[derive(Debug)]
struct Whole {
    source: Source,
    table: String,
}

impl PartialEq for Source {
    fn eq(&self, _other: &Self) -> bool {
        true
    }
}

impl Source {
    /// The text of a case file of this name.
    pub fn new(name: &str, file: &str) -> Self {
        Self {
            name: name.into(),
            file: file.into(),
            ..Self::default()
        }
    }

    /// Declares that the text is the table `table` of a file that the user wrote: errors then name their
    /// places in this file.
    pub fn of_table(mut self, whole: Source, table: &str) -> Self {
        let table = table.to_owned();
        self.whole = Some(Arc::new(Whole { source: whole, table }));
        self
    }

    /// Adds the text of an override; returns the position of its first byte.
    pub fn add_override(&mut self, text: &str) -> usize {
        let end = match self.overrides.last() {
            Some((start, last)) => start + last.len(),
            None => self.file.len(),
        };
        self.overrides.push((end + 1, text.to_owned()));
        end + 1
    }

    /// The name of the case in messages: its path, when it was loaded from a file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// A piece of the file or of an override.
    pub(super) fn slice(&self, span: Range<usize>) -> &str {
        let piece = match self.override_at(span.start) {
            Some((start, text)) => text.get(span.start - start..span.end.saturating_sub(*start)),
            None => self.file.get(span),
        };
        piece.unwrap_or_default()
    }

    /// The text before and after a position, within its line of the file or its override.
    pub(super) fn line_around(&self, position: usize) -> (&str, &str) {
        let (start, text) = match self.override_at(position) {
            Some((start, text)) => (*start, text.as_str()),
            None => (0, &*self.file),
        };
        let (before, after) = text.split_at(text.floor_char_boundary(position - start));
        let before = before.rsplit('\n').next().unwrap_or_default();
        (before, after.lines().next().unwrap_or_default())
    }

    /// Returns the source without the places of values in these top-level tables.
    pub(super) fn without(&self, tables: &[&str]) -> Self {
        let table = |key: &str| key.split('.').next().is_some_and(|table| tables.contains(&table));
        let kept = self.places.iter().filter(|(key, _)| !table(key));
        Self {
            places: map_of(kept.map(|(key, place)| (key.clone(), place.clone()))),
            name: Arc::clone(&self.name),
            file: Arc::clone(&self.file),
            overrides: self.overrides.clone(),
            whole: self.whole.clone(),
        }
    }

    /// Records the place of every value of a parsed file.
    pub fn note_places(&mut self, root: &DeTable<'_>) {
        note_table(&mut self.places, "", root);
    }

    /// The key of the value with exactly this span, or otherwise of the smallest value around it.
    pub fn key_at(&self, span: &Range<usize>) -> Option<&str> {
        let around = self
            .places
            .iter()
            .filter(|(_, place)| place.start <= span.start && span.end <= place.end);
        // Among equal spans, the longest key: a table made by `--set` has the span of its only value.
        around
            .min_by_key(|(key, place)| (place.len(), usize::MAX - key.len()))
            .map(|(key, _)| key.as_str())
    }

    /// The value of `key` as the user wrote it; empty if the user did not.
    pub(super) fn written(&self, key: &str) -> &str {
        let span = self.places.get(key).cloned();
        span.map_or("", |span| self.slice(span))
    }

    /// Whether the user wrote a value for `key`, in the file or by `--set`.
    pub fn has(&self, key: &str) -> bool {
        self.places.contains_key(key)
    }

    /// An error about the value of `key`, such as `drive.v_star` or `texture.0.coverage`.
    ///
    /// The error has the place of this value, or none when the value is a default or was set in code.
    pub fn error(&self, key: &str, sentence: impl Into<String>) -> CaseError {
        let span = self.places.get(key).cloned();
        CaseError::invalid(span.map(|span| self.place(span)), sentence)
    }

    /// An error at a place in the text.
    pub fn error_at(&self, span: Range<usize>, sentence: impl Into<String>) -> CaseError {
        CaseError::invalid(Some(self.place(span)), sentence)
    }

    /// The place of a span: the line and column where it begins, or the `--set` that contains it.
    pub fn place(&self, span: Range<usize>) -> Place {
        match self.override_at(span.start) {
            Some((_, text)) => Place::Override(truncated(text)),
            None => self
                .place_in_whole(&span)
                .unwrap_or_else(|| Place::in_file(&self.name, &self.file, span)),
        }
    }

    /// The place of a span in the file that contains this text as a table: the place of the value or key
    /// there, or of the table around it.
    fn place_in_whole(&self, span: &Range<usize>) -> Option<Place> {
        let Whole { source, table } = self.whole.as_deref()?;
        // The span is that of a value, or of a key. The value of a key is the next one with its name.
        let name = self.slice(span.clone());
        let named = self
            .places
            .iter()
            .filter(|(key, place)| key.rsplit('.').next() == Some(name) && place.start >= span.end);
        let key = named
            .min_by_key(|(_, place)| place.start)
            .map(|(key, _)| key.as_str());
        let keys = [key, self.key_at(span)].into_iter().flatten();
        let mut keys = keys.map(|key| format!("{table}.{key}")).chain([table.clone()]);
        let place = keys.find_map(|key| source.places.get(&key).cloned());
        place.map(|span| source.place(span))
    }

    /// The override that contains a position, and the position where it begins.
    pub(super) fn override_at(&self, position: usize) -> Option<&(usize, String)> {
        self.overrides.iter().rev().find(|(start, _)| *start <= position)
    }
}

fn note_table(places: &mut BTreeMap<String, Range<usize>>, prefix: &str, table: &DeTable<'_>) {
    for (key, value) in table {
        note_value(places, format!("{prefix}{}", key.get_ref()), value);
    }
}

fn note_value(places: &mut BTreeMap<String, Range<usize>>, key: String, value: &Spanned<DeValue<'_>>) {
    if key.len() > MAX_KEY {
        return;
    }
    match value.get_ref() {
        DeValue::Table(table) => note_table(places, &format!("{key}."), table),
        DeValue::Array(values) => {
            let values = values.iter().enumerate();
            for (index, table) in values.filter(|(_, value)| value.get_ref().is_table()) {
                note_value(places, format!("{key}.{index}"), table);
            }
        }
        _ => {}
    }
    places.insert(key, span_of(value));
}

/// The span of a value. If an override has set elements of a list of numbers or words, this is the span of
/// the last of them, because the list in the file is no longer the value.
fn span_of(value: &Spanned<DeValue<'_>>) -> Range<usize> {
    let span = value.span();
    let DeValue::Array(values) = value.get_ref() else {
        return span;
    };
    let elements = values.iter().filter(|element| !element.get_ref().is_table());
    let set = elements
        .map(Spanned::span)
        .filter(|element| element.start >= span.end);
    set.max_by_key(|element| element.start).unwrap_or(span)
}
