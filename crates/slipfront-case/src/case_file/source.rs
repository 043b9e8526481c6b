//! Where a value of a case file was written: a line and column of the file, or a `--set`.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::CaseError;
use crate::text::{MAX_EXCERPT, truncated};

/// The longest key whose place is noted, in bytes: all known ones are shorter. The keys below one of many megabytes
/// would take that length each.
const MAX_KEY: usize = 64;

/// What a case was read from, kept so that later errors can name their place.
///
/// Sources do not take part in comparison: all are equal.
#[derive(Clone, Debug, Default)]
pub struct Source {
    name: String,
    /// The file's text, then each override on a line of its own, so that a span alone tells where it belongs.
    text: Arc<str>,
    overrides: Vec<Range<usize>>,
    /// The span of every value by its key, such as `drive.v_star` or `texture.0.coverage`; none of absurdly long keys.
    places: BTreeMap<String, Range<usize>>,
}

impl PartialEq for Source {
    fn eq(&self, _other: &Self) -> bool {
        true
    }
}

impl Source {
    /// The text of a case file of this name, with overrides behind it.
    pub fn new(name: &str, file: &str, overrides: &[String]) -> Self {
        let mut text = file.to_owned();
        let mut spans = Vec::new();
        for entry in overrides {
            text.push('\n');
            spans.push(text.len()..text.len() + entry.len());
            text.push_str(entry);
        }
        Self {
            name: name.to_owned(),
            text: text.into(),
            overrides: spans,
            places: BTreeMap::new(),
        }
    }

    /// The name of the case in messages: its path, when it was loaded from a file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// File and overrides as one text, into which all spans point.
    pub fn text(&self) -> Arc<str> {
        Arc::clone(&self.text)
    }

    /// Length of the file without the overrides, in bytes.
    pub fn file_len(&self) -> usize {
        self.overrides
            .first()
            .map_or(self.text.len(), |first| first.start - 1)
    }

    /// Where the overrides stand in the text.
    pub fn overrides(&self) -> &[Range<usize>] {
        &self.overrides
    }

    /// A piece of the text.
    pub fn slice(&self, span: Range<usize>) -> &str {
        self.text.get(span).unwrap_or_default()
    }

    /// Notes the place of every value of a parsed file.
    pub fn note_places(&mut self, root: &DeTable<'_>) {
        note_table(&mut self.places, "", root);
    }

    /// The span of the value of `key`; `None` when the key has its default.
    pub fn span(&self, key: &str) -> Option<Range<usize>> {
        self.places.get(key).cloned()
    }

    /// The key whose value has exactly this span, or else the innermost one around it.
    pub fn key_at(&self, span: &Range<usize>) -> Option<&str> {
        let around = self
            .places
            .iter()
            .filter(|(_, place)| place.start <= span.start && span.end <= place.end);
        // Of equal spans the longest key: a table made by `--set` spans no more than its only value.
        around
            .min_by_key(|(key, place)| (place.len(), usize::MAX - key.len()))
            .map(|(key, _)| key.as_str())
    }

    /// Whether the user wrote a value for `key`, in the file or by `--set`.
    pub fn has(&self, key: &str) -> bool {
        self.places.contains_key(key)
    }

    /// An error about the value of `key`, such as `drive.v_star` or `texture.0.coverage`.
    ///
    /// It carries the place of that value, or none when the value is a default or was set in code.
    pub fn error(&self, key: &str, sentence: impl Into<String>) -> CaseError {
        CaseError::invalid(self.span(key).map(|span| self.place(span)), sentence)
    }

    /// An error at a place in the text.
    pub fn error_at(&self, span: Range<usize>, sentence: impl Into<String>) -> CaseError {
        CaseError::invalid(Some(self.place(span)), sentence)
    }

    /// The place of a span: the line and column where it begins, or the `--set` that it lies in.
    pub fn place(&self, span: Range<usize>) -> Place {
        if span.start > self.file_len()
            && let Some(entry) = self.overrides.iter().find(|entry| span.start <= entry.end)
        {
            return Place::Override(truncated(self.slice(entry.clone())));
        }
        let file = self.slice(0..self.file_len());
        let start = (0..=span.start.min(file.len()))
            .rev()
            .find(|&i| file.is_char_boundary(i))
            .unwrap_or(0);
        let line_start = file[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let line = file[line_start..].lines().next().unwrap_or_default();
        let marked = file
            .get(start..span.end)
            .unwrap_or_default()
            .lines()
            .next()
            .unwrap_or_default();
        Place::File {
            name: self.name.clone(),
            line: file[..start].matches('\n').count() + 1,
            column: file[line_start..start].chars().count() + 1,
            excerpt: excerpt(line, start - line_start, marked.chars().count()),
        }
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
            let tables = values
                .iter()
                .enumerate()
                .filter(|(_, value)| value.get_ref().is_table());
            for (i, value) in tables {
                note_value(places, format!("{key}.{i}"), value);
            }
        }
        _ => {}
    }
    places.insert(key, value.span());
}

/// Where a value was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// In the case file.
    File {
        /// The file's name.
        name: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// The line, and below it a caret under the value.
        excerpt: String,
    },
    /// In the value of a `--set`, which is given here.
    Override(String),
}

impl Place {
    /// The line with its caret; empty for a `--set`.
    pub fn excerpt(&self) -> &str {
        match self {
            Self::File { excerpt, .. } => excerpt,
            Self::Override(_) => "",
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File {
                name, line, column, ..
            } => write!(f, "{name}:{line}:{column}"),
            Self::Override(text) => write!(f, "--set {text}"),
        }
    }
}

/// The line, and below it carets under `width` characters from byte `start`; empty when there is nothing to show.
fn excerpt(line: &str, start: usize, width: usize) -> String {
    let before = &line[..start.min(line.len())];
    if line.trim().is_empty() || before.chars().count() > MAX_EXCERPT {
        return String::new();
    }
    // Tabs stay tabs, so that the caret stands below its character however wide they are.
    let margin: String = before
        .chars()
        .map(|c| if c == '\t' { '\t' } else { ' ' })
        .collect();
    let shown = truncated(line);
    let width = width
        .min(shown.chars().count().saturating_sub(before.chars().count()))
        .max(1);
    format!("\n  {shown}\n  {margin}{}", "^".repeat(width))
}
