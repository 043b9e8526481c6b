//! Checks of values against the bounds of the table of keys, as far as the file alone can tell.

use std::ops::Bound::{Excluded, Included};
use std::ops::RangeBounds;
use std::path::Path;

use super::error::CaseError;
use super::key_table::{Bounds, Kind, SECTIONS, Section};
use super::source::Source;
use crate::number_format::exact;
use crate::quantity::{self, Quantity};

/// The checks of one table. Keys are named as within that table.
pub(super) struct Check<'a> {
    source: &'a Source,
    section: Option<&'static Section>,
    path: &'a str,
}

impl<'a> Check<'a> {
    /// The checks of a table or shape of texture, which stands at `path` of the file.
    pub(super) fn new(source: &'a Source, section: &str, path: &'a str) -> Self {
        let section = SECTIONS.iter().find(|found| found.name == section);
        Self {
            source,
            section,
            path,
        }
    }

    /// What a key takes.
    fn kind(&self, key: &str) -> Option<Kind> {
        Some(self.section?.key(key)?.kind)
    }

    /// The key as the user writes it.
    fn path_of(&self, key: &str) -> String {
        format!("{}.{key}", self.path)
    }

    /// An error at the value of a key; the sentence gets the key as the user writes it.
    pub(super) fn refuse(&self, key: &str, sentence: impl FnOnce(&str) -> String) -> Result<(), CaseError> {
        let path = self.path_of(key);
        Err(self.source.error(&path, sentence(&path)))
    }

    /// Whether the user wrote a value for a key.
    pub(super) fn has(&self, key: &str) -> bool {
        self.source.has(&self.path_of(key))
    }

    /// Refuses a number out of the bounds of its key, or none (`nan`).
    pub(super) fn number(&self, key: &str, value: f64) -> Result<(), CaseError> {
        match self.kind(key) {
            Some(Kind::Number { bounds, remark, .. }) => self.number_within(key, value, bounds, remark),
            _ => Ok(()),
        }
    }

    /// Refuses a number out of bounds that depend on other values, or none (`nan`).
    pub(super) fn number_within(
        &self,
        key: &str,
        value: f64,
        bounds: Bounds,
        remark: &str,
    ) -> Result<(), CaseError> {
        if bounds.contains(&value) && value.is_finite() {
            return Ok(());
        }
        self.refuse(key, |path| {
            let (value, range) = (exact(value), in_words(bounds));
            format!("`{path}` is {value}: it must be {range}; {remark}")
        })
    }

    /// Refuses a quantity whose SI value is out of the bounds of its key.
    pub(super) fn quantity<K: quantity::Kind>(
        &self,
        key: &str,
        value: &Quantity<K>,
    ) -> Result<(), CaseError> {
        match self.kind(key) {
            Some(Kind::Quantity { bounds, .. }) => self.quantity_within(key, value, bounds),
            _ => Ok(()),
        }
    }

    /// Refuses a quantity whose SI value is out of bounds.
    pub(super) fn quantity_within<K: quantity::Kind>(
        &self,
        key: &str,
        value: &Quantity<K>,
        bounds: Bounds,
    ) -> Result<(), CaseError> {
        if bounds.contains(&value.si()) && value.si().is_finite() {
            return Ok(());
        }
        self.refuse(key, |path| {
            let (range, unit) = (in_words(bounds), K::SI_UNIT);
            format!("`{path}` is \"{value}\": it must be {range} {unit}; look at number and unit")
        })
    }

    /// Refuses a whole number out of the bounds of its key.
    pub(super) fn whole(&self, key: &str, value: u64) -> Result<(), CaseError> {
        match self.kind(key) {
            Some(Kind::Whole {
                least,
                most,
                noun,
                remark,
            }) if !(least..=most).contains(&value) => self.refuse(key, |path| {
                format!("`{path}` is {value}: it must be {noun}from {least} to {most}{remark}")
            }),
            _ => Ok(()),
        }
    }

    /// Refuses a pair of whole numbers of which one is out of the bounds of their key.
    pub(super) fn pair(&self, key: &str, [x, y]: [u32; 2]) -> Result<(), CaseError> {
        match self.kind(key) {
            Some(Kind::Whole { least, most, .. })
                if [x, y].iter().any(|&n| !(least..=most).contains(&n.into())) =>
            {
                self.refuse(key, |path| {
                    format!("`{path}` is [{x}, {y}]: both must be from {least} to {most}")
                })
            }
            _ => Ok(()),
        }
    }

    /// Refuses a file whose name does not end as one of the formats of its key.
    pub(super) fn file(&self, key: &str, name: &str) -> Result<(), CaseError> {
        let Some(Kind::File(formats)) = self.kind(key) else {
            return Ok(());
        };
        let ending = Path::new(name)
            .extension()
            .and_then(|ending| ending.to_str())
            .unwrap_or_default();
        if formats.iter().any(|format| ending.eq_ignore_ascii_case(format)) {
            return Ok(());
        }
        self.refuse(key, |path| {
            let formats = formats.join(" or .");
            format!("`{path}` is {name:?}: it must name a .{formats} file")
        })
    }
}

/// A range in words, such as "more than 0 and at most 10".
fn in_words((low, high): Bounds) -> String {
    let side = |bound, included: &str, excluded: &str| match bound {
        Included(limit) => Some(format!("{included} {}", exact(limit))),
        Excluded(limit) => Some(format!("{excluded} {}", exact(limit))),
        std::ops::Bound::Unbounded => None,
    };
    let sides = [
        side(low, "at least", "more than"),
        side(high, "at most", "less than"),
    ];
    sides.into_iter().flatten().collect::<Vec<_>>().join(" and ")
}
