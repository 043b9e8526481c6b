//! Changes to a case file: `--set key=value`, and the keys that the axes of a study set.

use std::borrow::Cow;
use std::fmt;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::depth::{limit_nesting, parts_of};
use super::diagnose::syntax_error;
use super::error::CaseError;
use super::key_table::partners;
use super::source::Source;

/// A key of a case file and its new value. The override removes keys that exclude this key, as `drive.speed`
/// excludes `drive.v_star`. If two overrides set one key, the later one applies.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Override {
    /// The override as quoted in messages: `KEY=VALUE`.
    text: String,
    key: Range<usize>,
    value: Range<usize>,
}

impl fmt::Display for Override {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Override {
    /// The override that sets a key to a value.
    pub fn new(key: &str, value: &toml::Value) -> Self {
        let text = format!("{key}={value}");
        Self {
            key: 0..key.len(),
            value: key.len() + 1..text.len(),
            text,
        }
    }

    /// Reads an override of the form `KEY=VALUE`. The value is TOML, or otherwise a literal string.
    ///
    /// # Errors
    /// When there is no value, and when a value begins like a string, list or table of TOML but is not TOML.
    pub fn parse(text: &str) -> Result<Self, CaseError> {
        let mut source = Source::default();
        let start = source.add_override(text);
        let refuse =
            |from: usize, sentence: &str| source.error_at(start + from..start + text.len(), sentence);
        let Some((key, value)) = text.split_once('=') else {
            return Err(refuse(
                0,
                "an override is written KEY=VALUE, such as drive.v_star=0.05",
            ));
        };
        let value_start = text.len() - value.trim_start().len();
        let value = value.trim();
        if value.is_empty() {
            return Err(refuse(
                value_start,
                "the override has no value: write KEY=VALUE, such as drive.v_star=0.05",
            ));
        }
        // A value that opens a string, a list or a table must be complete.
        if value.starts_with(['"', '\'', '[', '{']) {
            let start = start + value_start;
            DeValue::parse(limit_nesting(&source, start, value)?)
                .map_err(|error| syntax_error(&source, start, &error))?;
        }
        let key_start = key.len() - key.trim_start().len();
        Ok(Self {
            text: text.to_owned(),
            key: key_start..key_start + key.trim().len(),
            value: value_start..value_start + value.len(),
        })
    }

    /// The key that the override sets.
    pub fn key(&self) -> &str {
        &self.text[self.key.clone()]
    }

    /// The value of the override: a string if it is not TOML.
    pub fn value(&self) -> toml::Value {
        let text = &self.text[self.value.clone()];
        let parsed = format!("value = {text}").parse::<toml::Table>();
        let value = parsed.ok().and_then(|mut table| table.remove("value"));
        value.unwrap_or_else(|| toml::Value::from(text))
    }

    /// The top-level table that the override changes.
    pub(super) fn table(&self) -> &str {
        self.key().split('.').next().unwrap_or_default().trim()
    }

    /// Applies the override to a parsed file, and adds its text to the source.
    pub(super) fn apply<'i>(&'i self, root: &mut DeTable<'i>, source: &mut Source) -> Result<(), CaseError> {
        let start = source.add_override(&self.text);
        let source = &*source;
        let span = start..start + self.text.len();
        let refuse = |sentence: &str| source.error_at(span.clone(), sentence);
        let path = parts_of(self.key()).map_err(refuse)?;
        let change = Change {
            source,
            table: path[0],
            span: &span,
        };
        let text = &self.text[self.value.clone()];
        // A value that is not TOML is a string without quotes, which a shell removes.
        let string = || Spanned::new(0..text.len(), DeValue::String(Cow::Borrowed(text)));
        let start = start + self.value.start;
        let parsed = limit_nesting(source, start, text)
            .ok()
            .and_then(|text| DeValue::parse(text).ok());
        let value = parsed.unwrap_or_else(string);
        change
            .set(root, &path, moved(value, start))
            .map_err(|sentence| refuse(&sentence))
    }
}

/// The value with all its spans moved by `offset`.
fn moved(value: Spanned<DeValue<'_>>, offset: usize) -> Spanned<DeValue<'_>> {
    let shift = |span: Range<usize>| span.start + offset..span.end + offset;
    let span = shift(value.span());
    let inner = match value.into_inner() {
        DeValue::Array(values) => {
            DeValue::Array(values.into_iter().map(|value| moved(value, offset)).collect())
        }
        DeValue::Table(table) => {
            let moved_key = |key: Spanned<_>| Spanned::new(shift(key.span()), key.into_inner());
            let entries = table.into_iter();
            let entries = entries.map(|(key, value)| (moved_key(key), moved(value, offset)));
            DeValue::Table(entries.collect())
        }
        scalar => scalar,
    };
    Spanned::new(span, inner)
}

/// An override that is being applied.
struct Change<'a> {
    source: &'a Source,
    /// The top-level table that the override changes.
    table: &'a str,
    span: &'a Range<usize>,
}

impl Change<'_> {
    fn set<'i>(
        &self,
        table: &mut DeTable<'i>,
        path: &[&'i str],
        value: Spanned<DeValue<'i>>,
    ) -> Result<(), String> {
        match path {
            [] => Ok(()),
            [key] => {
                self.remove_partners(table, key)?;
                // Removed first, because inserting alone would keep the old key with the old span.
                table.remove(*key);
                table.insert(self.spanned(Cow::Borrowed(*key)), value);
                Ok(())
            }
            [key, rest @ ..] => {
                let is_index = rest[0].bytes().all(|byte| byte.is_ascii_digit());
                let empty = if is_index {
                    DeValue::Array(DeArray::default())
                } else {
                    DeValue::Table(DeTable::default())
                };
                let inner = table.entry(self.spanned(Cow::Borrowed(*key)));
                match inner.or_insert(self.spanned(empty)).get_mut() {
                    DeValue::Table(inner) => self.set(inner, rest, value),
                    DeValue::Array(values) => self.set_element(values, key, rest, value),
                    _ => Err(format!("`{key}` is not a table in the case: set it as a whole")),
                }
            }
        }
    }

    /// Sets `rest[1..]` of the element `rest[0]`; the index one past the last adds an element.
    fn set_element<'i>(
        &self,
        values: &mut DeArray<'i>,
        key: &str,
        rest: &[&'i str],
        value: Spanned<DeValue<'i>>,
    ) -> Result<(), String> {
        let count = values.len();
        let Some(index) = rest[0].parse::<usize>().ok().filter(|index| *index <= count) else {
            return Err(format!(
                "there is no `{key}.{}`: the case has {count} of them, counted from 0",
                rest[0]
            ));
        };
        if index == count {
            values.push(self.spanned(DeValue::Table(DeTable::default())));
        }
        let element = &mut values.as_mut()[index];
        if rest.len() == 1 {
            *element = value;
            return Ok(());
        }
        match element.get_mut() {
            DeValue::Table(inner) => self.set(inner, &rest[1..], value),
            _ => Err(format!(
                "`{key}.{index}` is not a table in the case: set `{key}` as a whole"
            )),
        }
    }

    /// Removes the keys that exclude `key`; an error when an override has set one of them.
    fn remove_partners(&self, table: &mut DeTable<'_>, key: &str) -> Result<(), String> {
        for partner in partners(self.table, key) {
            if let Some(old) = table.remove(partner)
                && self.source.override_at(old.span().start).is_some()
            {
                return Err(format!(
                    "`{key}` and `{partner}`, which another --set gives, set the same thing: keep one"
                ));
            }
        }
        Ok(())
    }

    fn spanned<T>(&self, value: T) -> Spanned<T> {
        Spanned::new(self.span.clone(), value)
    }
}
