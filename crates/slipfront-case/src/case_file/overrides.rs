//! `--set key=value`: a change to a parsed case file, before its values are read.

use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::depth::limit_nesting;
use super::error::CaseError;
use super::keys;
use super::source::Source;

/// Most parts of a key: `texture.0.center.1` is one number of a pair.
const MAX_PARTS: usize = 4;

/// Applies the override that stands at `span` of `text` to the parsed file.
///
/// The value is read as TOML, and as a string when it is not TOML, because a shell strips quotes. A key displaces the
/// one that excludes it (`drive.speed` the file's `drive.v_star`); of two overrides of one key the later holds.
pub(super) fn apply<'i>(
    root: &mut DeTable<'i>,
    source: &Source,
    text: &'i str,
    span: &Range<usize>,
) -> Result<(), CaseError> {
    let refuse = |sentence: &str| source.error_at(span.clone(), sentence);
    let entry = text.get(span.clone()).unwrap_or_default();
    let Some((key, value)) = entry.split_once('=') else {
        return Err(refuse(
            "an override is written KEY=VALUE, such as drive.v_star=0.05",
        ));
    };
    let path: Vec<&str> = key.split('.').map(str::trim).collect();
    let is_bare = |part: &str| {
        !part.is_empty()
            && part
                .chars()
                .all(|c| c.is_ascii_alphanumeric() || "_-".contains(c))
    };
    if path.len() > MAX_PARTS || !path.iter().all(|part| is_bare(part)) {
        return Err(refuse(
            "the key of an override is made of names and dots, such as drive.v_star or texture.0.coverage",
        ));
    }
    let value_start = span.end - value.trim_start().len();
    let value = read_value(source, value.trim(), value_start)?;
    let change = Change {
        source,
        table: path[0],
        span,
    };
    change
        .set(root, &path, value)
        .map_err(|sentence| refuse(&sentence))
}

/// Reads a value, whose text begins at `offset`.
fn read_value<'i>(source: &Source, text: &'i str, offset: usize) -> Result<Spanned<DeValue<'i>>, CaseError> {
    let span = offset..offset + text.len();
    if text.is_empty() {
        return Err(source.error_at(
            span,
            "the override has no value: write KEY=VALUE, such as drive.v_star=0.05",
        ));
    }
    match DeValue::parse(limit_nesting(text)) {
        Ok(value) => Ok(moved(value, offset)),
        // What opens a string, a list or a table was meant to be one.
        Err(error) if text.starts_with(['"', '\'', '[', '{']) => {
            Err(CaseError::syntax(source, offset, &error))
        }
        Err(_) => Ok(Spanned::new(span, DeValue::String(Cow::Borrowed(text)))),
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
        DeValue::Table(table) => DeValue::Table(
            table
                .into_iter()
                .map(|(key, value)| {
                    (
                        Spanned::new(shift(key.span()), key.into_inner()),
                        moved(value, offset),
                    )
                })
                .collect(),
        ),
        scalar => scalar,
    };
    Spanned::new(span, inner)
}

struct Change<'a> {
    source: &'a Source,
    /// The top-level table that the override is about.
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
                self.displace_partners(table, key)?;
                // Removed first: inserting alone would keep the old key with the old span.
                table.remove(*key);
                table.insert(self.spanned(Cow::Borrowed(*key)), value);
                Ok(())
            }
            [key, rest @ ..] => {
                if !table.contains_key(*key) {
                    let is_index = rest[0].bytes().all(|byte| byte.is_ascii_digit());
                    let empty = if is_index {
                        DeValue::Array(DeArray::default())
                    } else {
                        DeValue::Table(DeTable::default())
                    };
                    table.insert(self.spanned(Cow::Borrowed(*key)), self.spanned(empty));
                }
                match table.get_mut(*key).map(Spanned::get_mut) {
                    Some(DeValue::Table(inner)) => self.set(inner, rest, value),
                    Some(DeValue::Array(values)) => self.set_element(values, key, rest, value),
                    _ => Err(format!("`{key}` is not a table in the case: set it as a whole")),
                }
            }
        }
    }

    /// Sets `rest[1..]` of the element `rest[0]`; the index one beyond the last adds an element.
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

    /// Removes the keys that exclude `key`; refuses when an override set one of them.
    fn displace_partners(&self, table: &mut DeTable<'_>, key: &str) -> Result<(), String> {
        for partner in keys::partners(self.table, key) {
            if let Some(old) = table.remove(partner)
                && old.span().start > self.source.file_len()
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
