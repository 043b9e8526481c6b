//! The keys of a case file by their sections: the tables, and the shapes of textures.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::LazyLock;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::drive::Drive;
use super::friction::Friction;
use super::initial::Initial;
use super::key::{Key, KeyKind, StarUnit, Title, joined};
use super::load::Load;
use super::output::Output;
use super::pattern::Pattern;
use super::shapes::{Cavity, Drawing, Groove, HeightMap, Mask, Polygon};
use super::slider::Slider;
use super::time::Time;

/// A group of keys: those of a table, or of a shape of texture.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// The name of the table; for a shape of texture, the shape.
    pub name: &'static str,
    /// Whether the section is a shape of `[[texture]]`.
    pub is_shape: bool,
    /// Keys of the section, in the order of the documentation. The key `shape` itself is not one of the keys
    /// of a texture.
    pub keys: &'static [Key],
}

impl Section {
    /// The top-level table of the file that holds the section's keys.
    pub fn table(&self) -> &'static str {
        if self.is_shape { TEXTURE } else { self.name }
    }

    /// The key of the section with this name.
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    /// Gives a table the defaults of its missing keys, unless a partner is present.
    pub(super) fn fill_in(&self, table: &mut DeTable<'_>) {
        fill_in(
            table,
            self.keys,
            DEFAULTS.get(self.name).map_or(&[], Vec::as_slice),
        );
    }
}

/// Parsed default of a key; none if it has none.
type ParsedDefault = Option<Spanned<DeValue<'static>>>;

/// The defaults of all sections by their names. They are parsed once, because a study makes many cases.
static DEFAULTS: LazyLock<HashMap<&str, Vec<ParsedDefault>>> = LazyLock::new(|| {
    let sections = SECTIONS.iter();
    sections
        .map(|section| (section.name, defaults(section.keys)))
        .collect()
});

/// Parsed defaults of keys, in order.
fn defaults(keys: &[Key]) -> Vec<ParsedDefault> {
    // A key without a default has an empty text, which is not a value.
    keys.iter().map(|key| DeValue::parse(key.default).ok()).collect()
}

/// Gives a table the defaults of its missing keys, unless a partner is present.
fn fill_in(table: &mut DeTable<'_>, keys: &[Key], defaults: &[ParsedDefault]) {
    for (key, value) in keys.iter().zip(defaults) {
        let Some(value) = value else { continue };
        if !key
            .partners()
            .chain([key.name])
            .any(|name| table.contains_key(name))
        {
            table.insert(Spanned::new(0..0, Cow::Borrowed(key.name)), value.clone());
        }
    }
}

/// Gives a table outside a case, and the tables in it, the defaults of their missing keys.
pub(super) fn fill_in_all(table: &mut DeTable<'_>, keys: &[Key]) {
    fill_in(table, keys, &defaults(keys));
    for key in keys {
        if let KeyKind::Table(_, inner) = key.kind
            && let Some(DeValue::Table(table)) = table.get_mut(key.name).map(Spanned::get_mut)
        {
            fill_in_all(table, inner);
        }
    }
}

/// The table of the textures.
pub(super) const TEXTURE: &str = "texture";

/// Joins the keys of a shape and the keys common to all shapes.
macro_rules! shape_keys {
    ($shape:ident) => {
        &joined::<{ $shape::KEYS.len() + Pattern::KEYS.len() }>($shape::KEYS, Pattern::KEYS)
    };
}

/// Every section of a case file, in the order of the documentation: the tables, and the shapes of textures.
pub const SECTIONS: [Section; 13] = [
    section(false, "slider", Slider::KEYS),
    section(false, "load", Load::KEYS),
    section(false, "drive", Drive::KEYS),
    section(false, "friction", Friction::KEYS),
    section(false, "initial", Initial::KEYS),
    section(false, "time", Time::KEYS),
    section(false, "output", Output::KEYS),
    section(true, "cavity", shape_keys!(Cavity)),
    section(true, "groove", shape_keys!(Groove)),
    section(true, "polygon", shape_keys!(Polygon)),
    section(true, "mask", shape_keys!(Mask)),
    section(true, "height_map", shape_keys!(HeightMap)),
    section(true, "drawing", shape_keys!(Drawing)),
];
const fn section(is_shape: bool, name: &'static str, keys: &'static [Key]) -> Section {
    Section { name, is_shape, keys }
}

/// The title of a key such as `drive.v_star` or `texture.0.coverage`, and the index of its texture.
pub fn title_of(path: &str) -> Option<(Title, Option<usize>)> {
    let (table, rest) = path.split_once('.')?;
    let (texture, name) = match rest.split_once('.') {
        Some((index, name)) if table == TEXTURE => (Some(index.parse().ok()?), name),
        _ => (None, rest),
    };
    let mut keys = sections_of(table).filter_map(|section| section.key(name));
    Some((keys.next()?.title?, texture))
}

/// The unit of a key with this name, in a section or in a table within one; none for a key without a star.
pub(crate) fn star_unit(name: &str) -> Option<StarUnit> {
    fn unit_in(keys: &[Key], name: &str) -> Option<StarUnit> {
        keys.iter().find_map(|key| match key.kind {
            _ if key.name == name => key.star,
            KeyKind::Table(_, inner) => unit_in(inner, name),
            _ => None,
        })
    }
    SECTIONS.iter().find_map(|section| unit_in(section.keys, name))
}

/// Whether a key, such as `texture.0.file` or `file` within its table, names a file.
pub fn names_a_file(key: &str) -> bool {
    let name = key.rsplit('.').next().unwrap_or(key);
    let mut keys = SECTIONS.iter().filter_map(|section| section.key(name));
    keys.any(|key| matches!(key.kind, KeyKind::File(_)))
}

/// The keys of a table or shape of texture.
pub(super) fn keys_of(section: &str) -> &'static [Key] {
    let section = SECTIONS.iter().find(|found| found.name == section);
    section.map_or(&[], |section| section.keys)
}

/// The sections of a top-level table.
fn sections_of(table: &str) -> impl Iterator<Item = &'static Section> {
    SECTIONS.iter().filter(move |section| section.table() == table)
}

/// The names of the keys that exclude `key` in a table because each sets the same quantity.
pub(super) fn partners<'k>(table: &'k str, key: &'k str) -> impl Iterator<Item = &'static str> + 'k {
    let keys = sections_of(table).filter_map(move |section| section.key(key));
    keys.flat_map(Key::partners)
}
