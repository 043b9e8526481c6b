//! Keys of a case file: kind, bounds, default and title of each, and the functions that build the rows of the
//! table.
//!
//! Bounds on quantities are generous: they refuse typing errors (a block of 1000 km), not unusual materials.

use std::ops::Bound::{self, Excluded, Included};

/// A range of numbers.
pub type Bounds = (Bound<f64>, Bound<f64>);

/// Kind of the values that a key takes.
#[derive(Clone, Copy, Debug)]
#[expect(
    missing_docs,
    reason = "the sentence of each variant tells what its fields are"
)]
pub enum KeyKind {
    /// A number, or one of the given words. The remark ends the sentence about a number outside the bounds.
    Number {
        bounds: Bounds,
        remark: &'static str,
        words: &'static [&'static str],
    },
    /// A string of number and unit; the bounds are in the SI unit `unit`.
    Quantity { unit: &'static str, bounds: Bounds },
    /// A whole number, or a pair of them. The noun names the value where "from 1 to 64" is not enough; the
    /// remark ends the sentence about a number outside the bounds.
    Whole {
        least: u64,
        most: u64,
        noun: &'static str,
        remark: &'static str,
    },
    /// One of the words of an enum.
    Words(fn() -> &'static [&'static str]),
    /// `true` or `false`.
    Switch,
    /// The path of a file in one of the given formats.
    File(&'static [&'static str]),
    /// A table with its own keys, or a list of such tables, with an example.
    Table(&'static str, &'static [Key]),
    /// A value with bounds that depend on others, or with its own form; the text describes its bounds.
    Special(&'static str),
}

/// Title of a quantity along an axis of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Title {
    /// Name of the quantity in words.
    pub words: &'static str,
    /// Symbol of the quantity; empty if it has none. Subscripts are Unicode's subscript letters.
    pub symbol: &'static str,
    /// Unit of the quantity as pictures print it; empty for a number without a unit.
    pub unit: &'static str,
}

/// Unit of a dimensionless key, with a name that ends in `_star`. The unit depends on the edge of a block and
/// on the thickness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StarUnit {
    /// The unit of V*.
    Speed,
    /// The unit of t*.
    Time,
    /// One over the unit of t*.
    Rate,
    /// The unit of displacement.
    Displacement,
    /// The stiffness E h of the spring of a block. Its value per area stays constant on other blocks: `K = k*
    /// E h/l^2`.
    SpringOfBlock,
    /// The stiffness E h of all springs combined.
    Stiffness,
    /// No unit: a ratio, or a spread of coefficients.
    One,
}

/// A key of a file.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Name of the key within its table.
    pub name: &'static str,
    /// Meaning of the key: a sentence or more.
    pub doc: &'static str,
    /// Kind of the values that the key takes.
    pub kind: KeyKind,
    /// Default of the key as TOML; empty if it has none.
    pub default: &'static str,
    /// Keys for the same quantity, of which a table has one; this key itself may be among them.
    partners: &'static [&'static str],
    /// Unit of a key with a star; none for other keys.
    pub star: Option<StarUnit>,
    /// Title of the key; none for keys that are not an axis of any picture.
    pub title: Option<Title>,
    /// Symbol or equation in the paper; empty if it has none.
    pub paper: &'static str,
    /// Text after the bounds of the kind in the reference; empty if the bounds are complete.
    pub further_bounds: &'static str,
    /// Sentences after the meaning in the reference, with their links.
    pub note: &'static str,
    /// Text in place of the default; empty where the default or the meaning is enough.
    pub without: &'static str,
}

impl Key {
    /// The alternative keys for the same quantity: a table has one of them.
    pub fn partners(&self) -> impl Iterator<Item = &'static str> + use<> {
        let own = self.name;
        self.partners.iter().copied().filter(move |name| *name != own)
    }

    pub(super) const fn or(mut self, partners: &'static [&'static str]) -> Self {
        self.partners = partners;
        self
    }
    pub(super) const fn star(mut self, unit: StarUnit) -> Self {
        self.star = Some(unit);
        self
    }

    pub(super) const fn title(
        mut self,
        words: &'static str,
        symbol: &'static str,
        unit: &'static str,
    ) -> Self {
        self.title = Some(Title { words, symbol, unit });
        self
    }

    pub(super) const fn paper(mut self, symbol: &'static str) -> Self {
        self.paper = of_reference(symbol);
        self
    }

    /// The key with text after the bounds of its kind in the reference.
    pub const fn further_bounds(mut self, words: &'static str) -> Self {
        self.further_bounds = of_reference(words);
        self
    }

    /// The key with sentences after its meaning in the reference.
    pub const fn note(mut self, sentences: &'static str) -> Self {
        self.note = of_reference(sentences);
        self
    }

    /// The key with a text for files without it, in place of a default.
    pub const fn without(mut self, words: &'static str) -> Self {
        self.without = of_reference(words);
        self
    }

    /// The key with its name, and its meaning from a doc comment.
    pub const fn named(mut self, name: &'static str, doc: &'static str) -> Self {
        self.name = name;
        self.doc = of_reference(doc.trim_ascii());
        self
    }
}

/// The text, if the program has a disk and may write pages of reference. A module for a browser omits it to
/// be smaller.
const fn of_reference(words: &'static str) -> &'static str {
    if cfg!(feature = "disk") { words } else { "" }
}

/// A key that accepts values of this kind, with a default as TOML; an empty default is none.
pub const fn key(default: &'static str, kind: KeyKind) -> Key {
    Key {
        name: "",
        doc: "",
        kind,
        default,
        partners: &[],
        star: None,
        title: None,
        paper: "",
        further_bounds: "",
        note: "",
        without: "",
    }
}

pub(super) const fn number(bounds: Bounds, remark: &'static str) -> KeyKind {
    or_word(bounds, remark, &[])
}

pub(super) const fn or_word(bounds: Bounds, remark: &'static str, words: &'static [&'static str]) -> KeyKind {
    KeyKind::Number {
        bounds,
        remark,
        words,
    }
}

pub(super) const fn quantity(unit: &'static str, bounds: Bounds) -> KeyKind {
    KeyKind::Quantity { unit, bounds }
}

/// The kind of a whole number within bounds.
pub const fn whole(least: u64, most: u64) -> KeyKind {
    KeyKind::Whole {
        least,
        most,
        noun: "",
        remark: "",
    }
}

/// Bounds from `low` to `high`, both included.
pub(super) const fn within(low: f64, high: f64) -> Bounds {
    (Included(low), Included(high))
}

/// Bounds above `low`, up to and including `high`.
pub(super) const fn above(low: f64, high: f64) -> Bounds {
    (Excluded(low), Included(high))
}

/// Bounds above `low` and below `high`.
pub(super) const fn between(low: f64, high: f64) -> Bounds {
    (Excluded(low), Excluded(high))
}

/// Kind of a stiffness per area.
pub(super) const STIFFNESS_PER_AREA: KeyKind = quantity("N/m^3", within(1e-30, 1e40));
/// The largest time, in t*.
pub(super) const MAX_TIME_STAR: f64 = 1e9;
/// Bounds of a positive time.
pub(super) const POSITIVE_TIME: Bounds = above(0.0, MAX_TIME_STAR);
/// The largest coordinate or size of a texture, m.
const MAX_LENGTH: f64 = 1e9;
/// A size of a texture, or a distance in it.
pub(super) const SIZE: KeyKind = quantity("m", above(0.0, MAX_LENGTH));
/// A coordinate of a texture.
pub(super) const COORDINATE: KeyKind = quantity("m", within(-MAX_LENGTH, MAX_LENGTH));
/// A share of the area of the slider.
pub(super) const COVERAGE: KeyKind = number(between(0.0, 100.0), "it is in percent of the whole area");
/// A direction.
pub(super) const DEGREES: KeyKind = number(within(-360.0, 360.0), "it is in degrees from x towards y");
/// A file of numbers, block by block.
pub(super) const ARRAY: KeyKind = KeyKind::File(&["npy", "csv"]);
/// A speed in the unit of V*.
pub(super) const SPEED_STAR: KeyKind = number(above(0.0, 10.0), "it is in the unit of V*");
/// A time in t*.
pub(super) const TIME_STAR: KeyKind = number(POSITIVE_TIME, "it is a time t*");
/// A slip.
pub(super) const SLIP_STAR: KeyKind = number(above(0.0, 1e9), "it is in units of P mu_s l^2/(E h)");
/// The word for a number that the case determines.
pub(super) const AUTO: &[&str] = &["auto"];

/// Concatenates two lists of keys.
pub(super) const fn joined<const COUNT: usize>(first: &[Key], second: &[Key]) -> [Key; COUNT] {
    let mut keys = [first[0]; COUNT];
    let mut place = 0;
    while place < COUNT {
        keys[place] = if place < first.len() {
            first[place]
        } else {
            second[place - first.len()]
        };
        place += 1;
    }
    keys
}
