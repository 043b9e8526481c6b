//! Checks of values against the bounds of the table of keys, as far as they depend on the file alone.

use std::ops::Bound::{Excluded, Included};
use std::ops::RangeBounds;
use std::path::Path;

use slipfront::observe::Field;
use slipfront::surface::Orientation;
use slipfront::{Edges, Face, StopReason};

use super::error::CaseError;
use super::friction::{AfterBreak, ContactModel, Law};
use super::key::{Bounds, Key, KeyKind};
use super::load::Along;
use super::shapes::{Level, Missing};
use super::source::Source;
use super::values::AutoOr;
use super::words::{Arrangement, AttachedEdge, Body, EdgeSprings, FrictionAlong, Loading, Motion, Outline};
use crate::quantity::{self, Quantity};
use crate::table::{DecimalSign, FieldSeparator};
use slipfront_base::number_format::exact;

/// Checks of one table, with the names of keys within that table.
pub(super) struct Check<'a> {
    source: &'a Source,
    /// The keys of the table or shape of texture.
    keys: &'static [Key],
    path: &'a str,
}

impl<'a> Check<'a> {
    /// Checks of the table or shape of texture at `path` of the file, which has these keys.
    pub(super) fn new(source: &'a Source, keys: &'static [Key], path: &'a str) -> Self {
        Self { source, keys, path }
    }

    /// Checks of a table within this one, at `path`.
    pub(super) fn within<'p>(&self, path: &'p str, keys: &'static [Key]) -> Check<'p>
    where
        'a: 'p,
    {
        Check {
            source: self.source,
            keys,
            path,
        }
    }

    /// The key as the user writes it.
    pub(super) fn path_of(&self, key: &str) -> String {
        format!("{}.{key}", self.path)
    }

    /// An error at the value of a key; `sentence` gets the key as the user writes it.
    pub(super) fn refuse(&self, key: &str, sentence: impl FnOnce(&str) -> String) -> Result<(), CaseError> {
        let path = self.path_of(key);
        Err(self.source.error(&path, sentence(&path)))
    }

    /// Whether the user wrote a value for a key.
    pub(super) fn has(&self, key: &str) -> bool {
        self.source.has(&self.path_of(key))
    }

    /// Refuses a value that its key does not accept.
    pub(super) fn value(&self, key: &str, value: &dyn Checked) -> Result<(), CaseError> {
        match self.keys.iter().find(|found| found.name == key) {
            Some(found) => value.check(self, key, &found.kind),
            None => Ok(()),
        }
    }

    /// Refuses a number outside bounds that depend on other values, or NaN.
    pub(super) fn number_within(
        &self,
        key: &str,
        value: f64,
        bounds: Bounds,
        remark: &str,
    ) -> Result<(), CaseError> {
        self.hold(key, out_of(bounds, value, remark))
    }

    /// Refuses the value of a key if there is a complaint about it.
    fn hold(&self, key: &str, complaint: Option<String>) -> Result<(), CaseError> {
        complaint.map_or(Ok(()), |complaint| {
            self.refuse(key, |path| format!("`{path}` is {complaint}"))
        })
    }
}

/// Values that are checked against the kind of their key.
pub(super) trait Checked {
    /// A complaint about a value that is not of this kind: the value, and the values allowed. None where the
    /// type of the value suffices.
    fn complaint(&self, _kind: &KeyKind) -> Option<String> {
        None
    }

    /// Refuses the value of `key` unless it is of this kind.
    fn check(&self, check: &Check, key: &str, kind: &KeyKind) -> Result<(), CaseError> {
        check.hold(key, self.complaint(kind))
    }
}

/// Declares that values of some types are right once they have been read.
macro_rules! right_once_read {
    ($($type:ty)+) => { $(impl Checked for $type {})+ };
}

right_once_read! {
    bool AttachedEdge Arrangement Body EdgeSprings FrictionAlong Loading Motion Outline Along Law ContactModel
    AfterBreak Level Missing DecimalSign FieldSeparator Face [Edges; 2] Orientation StopReason
    Vec<Field>
}
impl Checked for f64 {
    fn complaint(&self, kind: &KeyKind) -> Option<String> {
        let KeyKind::Number { bounds, remark, .. } = kind else {
            return None;
        };
        out_of(*bounds, *self, remark)
    }
}

impl Checked for AutoOr {
    fn complaint(&self, kind: &KeyKind) -> Option<String> {
        match self {
            Self::Auto => None,
            Self::Number(number) => number.complaint(kind),
        }
    }
}

impl<K: quantity::Kind> Checked for Quantity<K> {
    fn complaint(&self, kind: &KeyKind) -> Option<String> {
        let KeyKind::Quantity { bounds, unit } = kind else {
            return None;
        };
        (!is_within(*bounds, self.si())).then(|| {
            let range = in_words(*bounds);
            format!("\"{self}\": it must be {range} {unit}; check number and unit")
        })
    }
}

impl Checked for u64 {
    fn complaint(&self, kind: &KeyKind) -> Option<String> {
        match kind {
            KeyKind::Whole {
                least,
                most,
                noun,
                remark,
            } if !(least..=most).contains(&self) => {
                Some(format!("{self}: it must be {noun}from {least} to {most}{remark}"))
            }
            _ => None,
        }
    }
}

impl Checked for u32 {
    fn complaint(&self, kind: &KeyKind) -> Option<String> {
        u64::from(*self).complaint(kind)
    }
}

impl Checked for [u32; 2] {
    fn complaint(&self, kind: &KeyKind) -> Option<String> {
        let KeyKind::Whole { least, most, .. } = kind else {
            return None;
        };
        let [x, y] = self.map(u64::from);
        let is_wrong = [x, y].iter().any(|count| !(least..=most).contains(&count));
        is_wrong.then(|| format!("[{x}, {y}]: both must be from {least} to {most}"))
    }
}

impl Checked for String {
    fn complaint(&self, kind: &KeyKind) -> Option<String> {
        let KeyKind::File(formats) = kind else { return None };
        if self.contains(char::is_control) {
            // The backslashes in C:\new\table.csv form such characters.
            return Some(format!(
                "{self:?}: it contains control characters; write a Windows path in single quotes, such as 'C:\\new\\table.csv', or /"
            ));
        }
        let ending = Path::new(self).extension().and_then(|ending| ending.to_str());
        let ending = ending.unwrap_or_default();
        let is_known = formats.iter().any(|format| ending.eq_ignore_ascii_case(format));
        (!is_known).then(|| format!("{self:?}: it must name a .{} file", formats.join(" or .")))
    }
}

impl<V: Checked> Checked for Option<V> {
    fn check(&self, check: &Check, key: &str, kind: &KeyKind) -> Result<(), CaseError> {
        self.as_ref()
            .map_or(Ok(()), |value| value.check(check, key, kind))
    }
}
fn is_within(bounds: Bounds, value: f64) -> bool {
    bounds.contains(&value) && value.is_finite()
}

/// A complaint about a number outside its bounds, or NaN.
fn out_of(bounds: Bounds, value: f64, remark: &str) -> Option<String> {
    let sentence = || format!("{}: it must be {}; {remark}", exact(value), in_words(bounds));
    (!is_within(bounds, value)).then(sentence)
}

/// A range in words, such as "more than 0 and at most 10".
pub(super) fn in_words((low, high): Bounds) -> String {
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
