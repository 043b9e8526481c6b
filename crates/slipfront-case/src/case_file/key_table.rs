//! The table of keys: kind, bounds, default and title of every key of a case file.

use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Bound::{Included, Unbounded};
use std::sync::LazyLock;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use slipfront::observe::Field;
use slipfront::{Edges, StopReason};

use super::friction;
use super::key::{
    ARRAY, AUTO, DEGREES, Key, KeyKind, MAX_TIME_STAR, POSITIVE_TIME, STIFFNESS_PER_AREA, Title, above,
    between, key, number, or_word, quantity, whole, within,
};
use super::probe::names_of;
use super::shapes;
use super::words::{AttachedEdge, Loading, Motion, Outline};

/// The keys that stand together: those of a table, or of a shape of texture.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// The name of the table; for a shape of texture, the shape.
    pub name: &'static str,
    /// Whether the section is a shape of `[[texture]]`.
    pub is_shape: bool,
    /// Keys of the section, in the order of the documentation. `shape` itself is not among the keys of a texture.
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

    /// Gives a table the defaults of the keys that it lacks, unless their partner stands there.
    pub(super) fn fill_in(&self, table: &mut DeTable<'_>) {
        let defaults = DEFAULTS.get(self.name).map_or(&[][..], Vec::as_slice);
        for (key, value) in self.keys.iter().zip(defaults) {
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
}

/// The defaults of the keys of a section, in their order.
type Defaults = Vec<Option<Spanned<DeValue<'static>>>>;

/// The defaults of all sections by their names. They are parsed once, since a study makes many cases.
static DEFAULTS: LazyLock<HashMap<&str, Defaults>> = LazyLock::new(|| {
    // A key without a default has an empty text, which is no value.
    let default = |key: &Key| DeValue::parse(key.default).ok();
    let defaults = |section: &Section| section.keys.iter().map(default).collect();
    let sections = SECTIONS.iter();
    sections
        .map(|section| (section.name, defaults(section)))
        .collect()
});

/// The table of the textures.
pub(super) const TEXTURE: &str = "texture";

/// Largest number of blocks along an axis.
pub(crate) const MAX_BLOCKS: u64 = 100_000;
/// dt* at which the scheme becomes unstable: 2/sqrt(6.5 x 0.75) = 0.9058.
pub(super) const UNSTABLE_STEP: f64 = 0.9058;
/// Least and largest property of a block over that of the whole slider.
pub(crate) const MIN_RELATIVE: f64 = 1e-6;
pub(crate) const MAX_RELATIVE: f64 = 1e6;

/// A slope of a profile.
pub(super) const RELATIVE_SLOPE: KeyKind = number(between(-1.0, 1.0), "1 would leave no load on an edge");
/// A stiffness with its unit.
pub(super) const STIFFNESS: KeyKind = quantity("N/m", within(1e-30, 1e30));
const DRIVE_STIFFNESS: KeyKind = number(above(0.0, 1e6), "that of the paper is 0.375 on each block");
/// A speed of a program.
pub(super) const PROGRAM_SPEED: KeyKind = number(within(-10.0, 10.0), "the paper's runs have 0.01 to 0.2");
/// The end of a segment of a program.
pub(super) const UNTIL: KeyKind = number(POSITIVE_TIME, "it is a time t*");
/// A property of a block over that of the whole slider.
pub(super) const RELATIVE_PROPERTY: KeyKind = number(
    within(MIN_RELATIVE, MAX_RELATIVE),
    "it is relative, so that 1 changes nothing",
);
const GRADE: KeyKind = KeyKind::Special("`{ along = \"x\", from = 1, to = 0.1 }`; 1e-6 to 1e6");
/// The sections that are tables.
const TABLES: [Section; 6] = [
    section(false, "slider", SLIDER),
    section(false, "load", LOAD),
    section(false, "drive", DRIVE),
    section(false, "friction", friction::KEYS),
    section(false, "time", TIME),
    section(false, "output", OUTPUT),
];

/// Every section of a case file: the tables, and the shapes of textures.
pub const SECTIONS: [Section; TABLES.len() + shapes::ALL.len()] = {
    let mut sections = [TABLES[0]; TABLES.len() + shapes::ALL.len()];
    let mut place = 0;
    while place < sections.len() {
        sections[place] = if place < TABLES.len() {
            TABLES[place]
        } else {
            let (shape, keys) = shapes::ALL[place - TABLES.len()];
            section(true, shape, keys)
        };
        place += 1;
    }
    sections
};

#[rustfmt::skip]
const SLIDER: &[Key] = &[
    key("blocks", "[25, 25]", whole(1, MAX_BLOCKS), "blocks along x and along y").title("blocks along a side", "", ""),
    key("block_size", "\"1 um\"", quantity("m", within(1e-12, 1e3)), "edge of a block").title("block size", "l", "m"),
    key("thickness", "", quantity("m", within(1e-12, 1e3)), "thickness of the sheet that the slider is; `block_size` if not given")
        .title("thickness", "h", "m"),
    key("young_modulus", "\"100 GPa\"", quantity("Pa", within(1e-3, 1e15)), "Young's modulus")
        .title("Young's modulus", "E", "Pa"),
    key("density", "\"10 g/cm^3\"", quantity("kg/m^3", within(1e-6, 1e9)), "density")
        .title("density", "\u{3c1}", "kg/m\u{b3}"),
    key("omega_star", "0.1", number(within(0.0, 1e3), "a slider that rings little has 1"), "damping of the blocks' motion")
        .or("damping_rate").title("damping", "\u{3a9}*", ""),
    key("damping_rate", "", quantity("1/s", within(0.0, 1e24)), "damping with its unit")
        .or("omega_star").title("damping", "\u{3a9}", "1/s"),
    key("edges", "\"free\"", KeyKind::Words(names_of::<Edges>), "what lies beyond the edges that bound x and those that bound y"),
    key("outline", "\"rectangle\"", KeyKind::Words(names_of::<Outline>), "shape of the slider: blocks outside do not exist"),
    key("outline_file", "", KeyKind::File(&["png", "npy"]), "the shape as a mask: dark pixels, or 1 in an array, are blocks"),
    key("viscosity_time_star", "0", number(within(0.0, 1e3), "it is a time in t*, of the order of 0.1 where it matters"),
        "damping constant of a damper beside every spring between blocks over the spring's stiffness")
        .title("viscosity", "\u{3c4}\u{1d65}*", ""),
    key("stiffness_field", "", ARRAY, "Young's modulus over `young_modulus`, block by block").or("stiffness_grade"),
    key("stiffness_grade", "", GRADE, "the same, from one edge to the other").or("stiffness_field"),
    key("density_field", "", ARRAY, "density over `density`, block by block").or("density_grade"),
    key("density_grade", "", GRADE, "the same, from one edge to the other").or("density_field"),
];

#[rustfmt::skip]
const LOAD: &[Key] = &[
    key("pressure", "\"100 kPa\"", quantity("Pa", within(1e-9, 1e15)), "normal load over the whole area, textured or not")
        .title("pressure", "P", "Pa"),
    key("redistribute", "true", KeyKind::Switch, "whether the blocks in contact carry the load of the textured ones"),
    key("profile", "", KeyKind::Special("`{ along = \"x\", relative_slope = 0.5 }`; more than -1, less than 1"),
        "a pressure that rises along x or y, with the mean `pressure`").or("pressure_field"),
    key("pressure_field", "", ARRAY, "local pressure over `pressure`, block by block").or("profile"),
];

#[rustfmt::skip]
const DRIVE: &[Key] = &[
    key("v_star", "0.03", number(above(0.0, 10.0), "the paper's runs have 0.01 to 0.2"), "speed of the drive")
        .or("speed").or("program").title("drive speed", "V*", ""),
    key("speed", "", quantity("m/s", within(1e-18, 1e6)), "speed of the drive with its unit")
        .or("v_star").or("program").title("drive speed", "V", "m/s"),
    key("program", "", KeyKind::Special("`[{ v_star = 0.03, until_star = 200 }, { v_star = 0 }]`; -10 to 10, times rising"),
        "speeds that follow one another").or("v_star").or("speed"),
    key("direction", "0", DEGREES, "direction of the drive, degrees from x towards y")
        .title("direction of the drive", "\u{3b8}", "\u{b0}"),
    key("motion", "\"translation\"", KeyKind::Words(names_of::<Motion>), "whether the drive pulls along the direction or turns"),
    key("loading", "\"constant\"", KeyKind::Words(names_of::<Loading>), "whether the drive moves all the time or stands while a block in contact slides"),
    key("attach", "\"all\"", KeyKind::Words(names_of::<AttachedEdge>), "which blocks have a drive spring: all, or those of an edge")
        .or("attach_file"),
    key("attach_file", "", KeyKind::File(&["png", "npy"]), "an image or array of the blocks that have a drive spring").or("attach"),
    key("stiffness", "\"auto\"", KeyKind::Special("`\"auto\"`, or 1e-30 to 1e30 N/m"), "stiffness of each drive spring")
        .or("stiffness_star").or("stiffness_per_area").or("total_stiffness").or("total_stiffness_star"),
    key("stiffness_star", "", DRIVE_STIFFNESS, "stiffness of each drive spring over E h, with the thickness h")
        .or("stiffness").or("stiffness_per_area").or("total_stiffness").or("total_stiffness_star")
        .title("drive stiffness", "k\u{209b}*", ""),
    key("stiffness_per_area", "", STIFFNESS_PER_AREA, "stiffness of the mount, which the drive springs are, per area: that of a slider on any blocks")
        .or("stiffness").or("stiffness_star").or("total_stiffness").or("total_stiffness_star")
        .title("stiffness of the mount", "K", "N/m\u{b3}"),
    key("total_stiffness", "", STIFFNESS, "stiffness of all drive springs together, shared in proportion to the modulus of each block")
        .or("stiffness").or("stiffness_star").or("stiffness_per_area").or("total_stiffness_star")
        .title("total drive stiffness", "K\u{209b}", "N/m"),
    key("total_stiffness_star", "", DRIVE_STIFFNESS, "stiffness of all drive springs together over E h, with the thickness h")
        .or("stiffness").or("stiffness_star").or("stiffness_per_area").or("total_stiffness")
        .title("total drive stiffness", "K\u{209b}*", ""),
];

#[rustfmt::skip]
const TIME: &[Key] = &[
    key("duration_star", "\"auto\"", or_word(POSITIVE_TIME, "8/V* shows onset and sliding", AUTO), "length of the run")
        .or("duration").title("duration", "t*", ""),
    key("duration", "", quantity("s", within(1e-24, 1e12)), "length of the run with its unit")
        .or("duration_star").title("duration", "t", "s"),
    key("step", "\"auto\"", or_word(between(0.0, UNSTABLE_STEP), "beyond it the scheme is unstable; \"auto\" is 0.1",
        &["auto", "paper"]), "time step").title("time step", "\u{394}t*", ""),
    key("stop", "\"end\"", KeyKind::Words(names_of::<StopReason>),
        "end at the duration, or as soon as the fall that ends the first peak is seen"),
    key("kinetic_from_star", "\"auto\"", or_word((Included(0.0), Unbounded),
        "the average is taken from there to the end of the run", AUTO), "start of the window that mu_k* is averaged over"),
];

#[rustfmt::skip]
const OUTPUT: &[Key] = &[
    key("snapshots", "\"auto\"", KeyKind::Special("`\"auto\"`, a list, or `{ every = 5.0 }`"), "when fields are written"),
    key("fields", "[\"contact_stress_star\", \"traction\", \"displacement_x\", \"displacement_y\", \"sliding\"]",
        KeyKind::Words(names_of::<Field>), "what is written then"),
    key("stride", "1", KeyKind::Whole { least: 1, most: MAX_BLOCKS, noun: "", remark: "; 1 writes every block" },
        "every n-th block in the fields file"),
    key("series", "\"auto\"", SPACING, "spacing of the rows of the series in t*"),
    key("movie", "false", KeyKind::Switch, "whether a movie is drawn of the snapshots"),
];

/// A time between snapshots or rows.
pub(super) const SPACING: KeyKind = or_word(POSITIVE_TIME, "it is a spacing in t*", AUTO);

/// A time of a snapshot in a list of them.
pub(super) const SNAPSHOT_TIME: KeyKind = number(within(0.0, MAX_TIME_STAR), "snapshots are times t*");

const fn section(is_shape: bool, name: &'static str, keys: &'static [Key]) -> Section {
    Section { name, is_shape, keys }
}

/// The title of a key such as `drive.v_star` or `texture.0.coverage`, and the position of its texture.
pub fn title_of(path: &str) -> Option<(Title, Option<usize>)> {
    let (table, rest) = path.split_once('.')?;
    let (texture, name) = match rest.split_once('.') {
        Some((index, name)) if table == TEXTURE => (Some(index.parse().ok()?), name),
        _ => (None, rest),
    };
    let mut keys = sections_of(table).filter_map(|section| section.key(name));
    Some((keys.next()?.title?, texture))
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
