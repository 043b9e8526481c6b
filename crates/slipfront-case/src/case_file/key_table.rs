//! The table of keys: for every key of a case file what it takes, its bounds, default and title.
//!
//! Bounds on quantities are generous: they refuse typing errors (a block of 1000 km), not unusual materials.

use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Bound::{self, Excluded, Included, Unbounded};
use std::sync::LazyLock;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use slipfront::observe::Field;
use slipfront::surface::Orientation;
use slipfront::{Edges, StopReason};

use super::probe::names_of;
use super::words::{Arrangement, AttachedEdge, Contact, Law, Motion, Outline};

/// A range of numbers.
pub type Bounds = (Bound<f64>, Bound<f64>);

/// What a key takes.
#[derive(Clone, Copy, Debug)]
#[expect(
    missing_docs,
    reason = "the sentence of each variant tells what its fields are"
)]
pub enum Kind {
    /// A number, or one of these words in its place. The remark ends the sentence about a number out of bounds.
    Number {
        bounds: Bounds,
        remark: &'static str,
        words: &'static [&'static str],
    },
    /// A string of number and unit; the bounds are in this unit of the SI.
    Quantity { unit: &'static str, bounds: Bounds },
    /// A whole number, or a pair of them. The noun is what it must be, where "from 1 to 64" does not say enough, and the
    /// remark ends the sentence about a number out of bounds.
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
    /// The path of a file of one of these formats.
    File(&'static [&'static str]),
    /// A value whose bounds depend on others, or that has a form of its own: its bounds in words.
    Special(&'static str),
}

/// What a quantity is called along an axis of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Title {
    /// What it is, in words.
    pub words: &'static str,
    /// Its symbol; empty if it has none. Subscripts are Unicode's subscript letters.
    pub symbol: &'static str,
    /// Its unit as pictures print it; empty for a number without unit.
    pub unit: &'static str,
}

/// A key of a case file.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Its name within its table.
    pub name: &'static str,
    /// What it takes.
    pub kind: Kind,
    /// Its default as TOML; empty if it has none.
    pub default: &'static str,
    /// The keys that set the same thing: a table has one of them.
    partners: [Option<&'static str>; 3],
    /// Its title; none for keys that no picture has along an axis.
    pub title: Option<Title>,
    /// What it means, in one line.
    pub doc: &'static str,
}

/// The keys that stand together: those of a table, or of a shape of texture.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// The name of the table; for a shape of texture, the shape.
    pub name: &'static str,
    /// Whether it is a shape of `[[texture]]`.
    pub is_shape: bool,
    /// Its keys, in the order of the documentation. `shape` itself is not among those of a texture.
    pub keys: &'static [Key],
}

impl Section {
    /// The top-level table of the file that holds its keys.
    pub fn table(&self) -> &'static str {
        if self.is_shape { TEXTURE } else { self.name }
    }

    /// The key of this name.
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

/// Most blocks along an axis.
pub(crate) const MAX_BLOCKS: u64 = 100_000;
/// dt* at which the scheme becomes unstable: 2/sqrt(6.5 x 0.75) = 0.9058.
pub(super) const UNSTABLE_STEP: f64 = 0.9058;
/// The longest time, in t*.
pub(super) const MAX_TIME_STAR: f64 = 1e9;
/// The largest coordinate or size of a texture, m.
const MAX_LENGTH: f64 = 1e9;
/// TOML's largest integer.
const MAX_SEED: u64 = i64::MAX.unsigned_abs();

/// Least and largest property of a block over that of the whole slider.
pub(crate) const MIN_RELATIVE: f64 = 1e-6;
pub(crate) const MAX_RELATIVE: f64 = 1e6;

const POSITIVE_TIME: Bounds = above(0.0, MAX_TIME_STAR);
const COVERAGE: Kind = number(between(0.0, 100.0), "it is in percent of the whole area");
const DEGREES: Kind = number(within(-360.0, 360.0), "it is in degrees from x towards y");
const SIGMA: Kind = number(
    within(0.0, 1.0),
    "it is relative to the mean coefficient, so that 0.05 is 5 percent",
);
pub(super) const SIZE: Kind = quantity("m", above(0.0, MAX_LENGTH));
pub(super) const COORDINATE: Kind = quantity("m", within(-MAX_LENGTH, MAX_LENGTH));
const ARRAY: Kind = Kind::File(&["npy", "csv"]);
/// A slope of a profile.
pub(super) const RELATIVE_SLOPE: Kind = number(between(-1.0, 1.0), "1 would leave no load on an edge");
/// A stiffness with its unit.
pub(super) const STIFFNESS: Kind = quantity("N/m", within(1e-30, 1e30));
const DRIVE_STIFFNESS: Kind = number(above(0.0, 1e6), "that of the paper is 0.375 on each block");
/// A speed of a program.
pub(super) const PROGRAM_SPEED: Kind = number(within(-10.0, 10.0), "the paper's runs have 0.01 to 0.2");
/// The end of a segment of a program.
pub(super) const UNTIL: Kind = number(POSITIVE_TIME, "it is a time t*");
/// A property of a block over that of the whole slider.
pub(super) const RELATIVE_PROPERTY: Kind = number(
    within(MIN_RELATIVE, MAX_RELATIVE),
    "it is relative, so that 1 changes nothing",
);
const GRADE: Kind = Kind::Special("`{ along = \"x\", from = 1, to = 0.1 }`; 1e-6 to 1e6");
const SHEAR_STRENGTH: Kind = quantity("Pa", within(0.0, 1e15));

/// Every section of a case file.
pub const SECTIONS: [Section; 11] = [
    section(false, "slider", SLIDER),
    section(false, "load", LOAD),
    section(false, "drive", DRIVE),
    section(false, "friction", FRICTION),
    section(false, "time", TIME),
    section(false, "output", OUTPUT),
    section(true, "cavity", CAVITY),
    section(true, "groove", GROOVE),
    section(true, "polygon", POLYGON),
    section(true, "mask", MASK),
    section(true, "height_map", HEIGHT_MAP),
];

#[rustfmt::skip]
const SLIDER: &[Key] = &[
    key("blocks", "[25, 25]", whole(1, MAX_BLOCKS), "blocks along x and along y").title("blocks along a side", "", ""),
    key("block_size", "\"1 um\"", quantity("m", within(1e-12, 1e3)), "edge of a block").title("block size", "l", "m"),
    key("young_modulus", "\"100 GPa\"", quantity("Pa", within(1e-3, 1e15)), "Young's modulus")
        .title("Young's modulus", "E", "Pa"),
    key("density", "\"10 g/cm^3\"", quantity("kg/m^3", within(1e-6, 1e9)), "density")
        .title("density", "\u{3c1}", "kg/m\u{b3}"),
    key("omega_star", "0.1", number(within(0.0, 1e3), "a slider that rings little has 1"), "damping of the blocks' motion")
        .or("damping_rate").title("damping", "\u{3a9}*", ""),
    key("damping_rate", "", quantity("1/s", within(0.0, 1e24)), "damping with its unit")
        .or("omega_star").title("damping", "\u{3a9}", "1/s"),
    key("edges", "\"free\"", Kind::Words(names_of::<Edges>), "what lies beyond the edges that bound x and those that bound y"),
    key("outline", "\"rectangle\"", Kind::Words(names_of::<Outline>), "shape of the slider: blocks outside do not exist"),
    key("outline_file", "", Kind::File(&["png", "npy"]), "the shape as a mask: dark pixels, or 1 in an array, are blocks"),
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
    key("redistribute", "true", Kind::Switch, "whether the blocks in contact carry the load of the textured ones"),
    key("profile", "", Kind::Special("`{ along = \"x\", relative_slope = 0.5 }`; more than -1, less than 1"),
        "a pressure that rises along x or y, with the mean `pressure`").or("pressure_field"),
    key("pressure_field", "", ARRAY, "local pressure over `pressure`, block by block").or("profile"),
];

#[rustfmt::skip]
const DRIVE: &[Key] = &[
    key("v_star", "0.03", number(above(0.0, 10.0), "the paper's runs have 0.01 to 0.2"), "speed of the drive")
        .or("speed").or("program").title("drive speed", "V*", ""),
    key("speed", "", quantity("m/s", within(1e-18, 1e6)), "speed of the drive with its unit")
        .or("v_star").or("program").title("drive speed", "V", "m/s"),
    key("program", "", Kind::Special("`[{ v_star = 0.03, until_star = 200 }, { v_star = 0 }]`; -10 to 10, times rising"),
        "speeds that follow one another").or("v_star").or("speed"),
    key("direction", "0", DEGREES, "direction of the drive, degrees from x towards y")
        .title("direction of the drive", "\u{3b8}", "\u{b0}"),
    key("motion", "\"translation\"", Kind::Words(names_of::<Motion>), "whether the drive pulls along the direction or turns"),
    key("attach", "\"all\"", Kind::Words(names_of::<AttachedEdge>), "which blocks have a drive spring: all, or those of an edge")
        .or("attach_file"),
    key("attach_file", "", Kind::File(&["png", "npy"]), "an image or array of the blocks that have a drive spring").or("attach"),
    key("stiffness", "\"auto\"", Kind::Special("`\"auto\"`, or 1e-30 to 1e30 N/m"), "stiffness of each drive spring")
        .or("stiffness_star").or("total_stiffness").or("total_stiffness_star"),
    key("stiffness_star", "", DRIVE_STIFFNESS, "the same over E l").or("stiffness").or("total_stiffness").or("total_stiffness_star")
        .title("drive stiffness", "k\u{209b}*", ""),
    key("total_stiffness", "", STIFFNESS, "stiffness of all drive springs together, shared in proportion to the modulus of each block")
        .or("stiffness").or("stiffness_star").or("total_stiffness_star").title("total drive stiffness", "K\u{209b}", "N/m"),
    key("total_stiffness_star", "", DRIVE_STIFFNESS, "the same over E l")
        .or("stiffness").or("stiffness_star").or("total_stiffness").title("total drive stiffness", "K\u{209b}*", ""),
];

#[rustfmt::skip]
const FRICTION: &[Key] = &[
    key("law", "\"projection\"", Kind::Words(names_of::<Law>), "the reading of Eq. 4, or rate and state in its place"),
    key("mu_static", "1.0", number(above(0.0, 100.0), "it is the scale of all forces"), "mean static coefficient")
        .title("mean static coefficient", "\u{3bc}\u{209b}", ""),
    key("r_star", "0.5", number(within(0.0, MAX_R_STAR), "it is the kinetic over the static coefficient"),
        "mean kinetic over mean static coefficient").or("mu_kinetic").title("friction ratio", "R*", ""),
    key("mu_kinetic", "", Kind::Special("0 to 10 times `mu_static`"), "mean kinetic coefficient")
        .or("r_star").title("mean kinetic coefficient", "\u{3bc}\u{2096}", ""),
    key("sigma_static_star", "0.05", SIGMA, "standard deviation of the static coefficients over their mean")
        .title("spread of static coefficients", "\u{3c3}\u{209b}*", ""),
    key("sigma_kinetic_star", "0.05", SIGMA, "standard deviation of the kinetic coefficients over *their* mean")
        .title("spread of kinetic coefficients", "\u{3c3}\u{2096}*", ""),
    key("seed", "1", whole(0, MAX_SEED), "seed of the random coefficients").title("seed", "", ""),
    key("mu_static_field", "", ARRAY, "static coefficients block by block, in place of random ones"),
    key("mu_kinetic_field", "", ARRAY, "kinetic coefficients block by block, in place of random ones"),
    key("adhesion", "\"0 Pa\"", SHEAR_STRENGTH, "shear strength without load, added to the static threshold of the blocks in contact")
        .title("adhesion", "\u{3c4}\u{2090}", "Pa"),
    key("adhesion_kinetic", "\"0 Pa\"", SHEAR_STRENGTH, "the same, added to their kinetic friction")
        .title("kinetic adhesion", "\u{3c4}\u{2090}\u{2096}", "Pa"),
    key("velocity", "", Kind::Special("`{ law = \"weakening\", v_c_star = 0.1, ratio = 0.5 }`; v_c_star more than 0, at most 10; ratio 0 to 1"),
        "kinetic friction that falls with speed"),
    key("ageing", "", Kind::Special("`{ law = \"logarithmic\", beta = 0.02, time_star = 1 }`; beta 0 to 10; time_star more than 0, at most 1e9"),
        "static friction that grows while a block is stuck"),
    key("contact", "\"rigid\"", Kind::Words(names_of::<Contact>), "what holds a block until its threshold"),
    key("contact_stiffness_star", "", number(above(0.0, 1e3), "it is over E l, and a spring between blocks has 0.75"),
        "stiffness of the spring in the contact of a block").title("contact stiffness", "k\u{209c}*", ""),
    key("redraw", "false", Kind::Switch, "whether a spring that forms again has another threshold"),
    key("a", "", number(within(1e-6, 10.0), "it is a coefficient, of the order of 0.01"), "direct effect of rate and state")
        .title("direct effect", "a", ""),
    key("b", "", number(within(0.0, 10.0), "it is a coefficient, of the order of 0.01"), "evolution effect of rate and state")
        .title("evolution effect", "b", ""),
    key("d_c_star", "", number(above(0.0, 1e9), "it is in units of P mu_s l/E"), "slip over which the state follows a change of speed")
        .title("slip of the state", "D*", ""),
    key("v_0_star", "", SPEED_STAR, "reference speed of rate and state").title("reference speed", "V\u{2080}*", ""),
    key("mu_0", "", number(within(0.0, 100.0), "it is a coefficient"), "coefficient of steady sliding at `v_0_star`")
        .title("coefficient of steady sliding", "\u{3bc}\u{2080}", ""),
    key("theta_0_star", "", TIME_STAR, "state at the start").title("state at the start", "\u{3b8}\u{2080}*", ""),
    key("slip_speed_star", "", SPEED_STAR, "speed above which a block counts as sliding under rate and state"),
];

/// A speed in the unit of V*.
pub(super) const SPEED_STAR: Kind = number(above(0.0, 10.0), "it is in the unit of V*");
/// A time in t*.
pub(super) const TIME_STAR: Kind = number(POSITIVE_TIME, "it is a time t*");
/// A share of kinetic friction.
pub(super) const RATIO: Kind = number(
    within(0.0, 1.0),
    "it is kinetic friction at high speed over that at rest",
);
/// Growth with age.
pub(super) const BETA: Kind = number(
    within(0.0, 10.0),
    "it is the growth per unit of the logarithm of the age",
);

/// Largest mean kinetic over mean static coefficient.
pub(super) const MAX_R_STAR: f64 = 10.0;

#[rustfmt::skip]
const TIME: &[Key] = &[
    key("duration_star", "\"auto\"", or_word(POSITIVE_TIME, "8/V* shows onset and sliding", AUTO), "length of the run")
        .or("duration").title("duration", "t*", ""),
    key("duration", "", quantity("s", within(1e-24, 1e12)), "length of the run with its unit")
        .or("duration_star").title("duration", "t", "s"),
    key("step", "\"auto\"", or_word(between(0.0, UNSTABLE_STEP), "beyond it the scheme is unstable; \"auto\" is 0.1",
        &["auto", "paper"]), "time step").title("time step", "\u{394}t*", ""),
    key("stop", "\"end\"", Kind::Words(names_of::<StopReason>),
        "end at the duration, or as soon as the fall that ends the first peak is seen"),
    key("kinetic_from_star", "\"auto\"", or_word((Included(0.0), Unbounded),
        "the average is taken from there to the end of the run", AUTO), "start of the window that mu_k* is averaged over"),
];

#[rustfmt::skip]
const OUTPUT: &[Key] = &[
    key("snapshots", "\"auto\"", Kind::Special("`\"auto\"`, a list, or `{ every = 5.0 }`"), "when fields are written"),
    key("fields", "[\"contact_stress_star\", \"traction\", \"displacement_x\", \"displacement_y\", \"sliding\"]",
        Kind::Words(names_of::<Field>), "what is written then"),
    key("stride", "1", Kind::Whole { least: 1, most: MAX_BLOCKS, noun: "", remark: "; 1 writes every block" },
        "every n-th block in the fields file"),
    key("series", "\"auto\"", SPACING, "spacing of the rows of the series in t*"),
    key("movie", "false", Kind::Switch, "whether a movie is drawn of the snapshots"),
];

/// A time between snapshots or rows.
pub(super) const SPACING: Kind = or_word(POSITIVE_TIME, "it is a spacing in t*", AUTO);

#[rustfmt::skip]
const CAVITY: &[Key] = &[
    key("s", "1", Kind::Whole { least: 1, most: 64, noun: "a whole number ", remark: "" },
        "kind of outline: an ellipse for 1, else a polygon of s + 1 curved edges").title("cavity shape", "s", ""),
    key("w", "0", Kind::Special("-1 < w < 1 for s = 1, else -1/s to 1/s"), "how far the outline is from a circle")
        .title("cavity shape", "w", ""),
    key("coverage", "", COVERAGE, "size: percent of the whole area")
        .or("lambda").title("texture coverage", "A*", "%"),
    key("lambda", "", SIZE, "size: the length of Eq. 17, a circle's radius")
        .or("coverage").title("cavity size", "\u{3bb}", "m"),
    key("across", "false", Kind::Switch, "the paper's swap of x and y"),
    key("center", "\"middle\"", Kind::Special("`\"middle\"`, or a pair within 1e9 m"), "centre of the cavity, or of its pattern"),
    key("rotate", "0", DEGREES, "rotation, degrees from x towards y").title("rotation of the texture", "", "\u{b0}"),
    PITCH, ARRAY_OF_COPIES, LATTICE, REPEAT, INVERT,
];

#[rustfmt::skip]
const GROOVE: &[Key] = &[
    key("orientation", "\"across\"", Kind::Words(names_of::<Orientation>),
        "whether the groove runs along y (across the x axis) or along x"),
    key("coverage", "", COVERAGE, "size: percent of the whole area").or("width").title("texture coverage", "A*", "%"),
    key("width", "", SIZE, "size: the width").or("coverage").title("groove width", "", "m"),
    key("offset", "\"0 um\"", COORDINATE, "distance of the groove's middle line from the slider's")
        .title("groove offset", "", "m"),
    PITCH, ARRAY_OF_COPIES, LATTICE, REPEAT, INVERT,
];

#[rustfmt::skip]
const POLYGON: &[Key] = &[
    key("points", "", Kind::Special("at least 3 pairs within 1e9 m"), "the corners"),
    PITCH, ARRAY_OF_COPIES, LATTICE, REPEAT, INVERT,
];

#[rustfmt::skip]
const MASK: &[Key] = &[
    key("file", "", Kind::File(&["png", "npy"]), "an image, stretched over the slider"),
    key("threshold", "0.5", number(between(0.0, 1.0), "it is a share of white"),
        "a pixel of an image is dark below this share of white"),
    PITCH, ARRAY_OF_COPIES, LATTICE, REPEAT, INVERT,
];

#[rustfmt::skip]
const HEIGHT_MAP: &[Key] = &[
    key("file", "", Kind::File(&["npy", "csv", "gsf", "x3p", "png", "tif", "tiff"]), "measured heights, stretched over the slider"),
    key("bearing_percent", "", COVERAGE, "the share of the area that touches, the highest parts first")
        .or("depth").title("bearing area", "", "%"),
    key("depth", "", SIZE, "how far below the reference a block still touches").or("bearing_percent").title("depth of contact", "", "m"),
    key("reference", "", COORDINATE, "height from which `depth` is counted; that of the highest block if left out"),
    key("height_unit", "", SIZE, "the height that a value of 1 in the file means, if the file has no unit"),
    key("pixel_size", "", Kind::Special("a length, or a pair; more than 0, at most 1e9 m"),
        "distance of neighbouring points, if the file does not have it"),
    PITCH, ARRAY_OF_COPIES, LATTICE, REPEAT, INVERT,
];

/// Most columns, and most rows, of all arrays of a texture together.
pub(crate) const MAX_COUNT: u64 = 1000;
/// Columns and rows.
pub(super) const COUNT: Kind = whole(1, MAX_COUNT);

// The keys of a pattern, which all shapes have.
#[rustfmt::skip]
const PITCH: Key = key("pitch", "", Kind::Special("a length, or a pair; more than 0, at most 1e9 m"),
    "distance between neighbouring copies").title("pitch", "", "m");
#[rustfmt::skip]
const ARRAY_OF_COPIES: Key = key("array", "\"auto\"", Kind::Special("`\"auto\"`, or a pair from 1 to 1000"),
    "columns and rows of copies");
#[rustfmt::skip]
const LATTICE: Key = key("lattice", "\"square\"", Kind::Words(names_of::<Arrangement>), "how the copies are arranged");
#[rustfmt::skip]
const REPEAT: Key = key("repeat", "", Kind::Special("`{ array = [3, 3], pitch = \"20 um\", lattice = \"square\" }`"),
    "a pattern of such patterns");
const INVERT: Key = key(
    "invert",
    "false",
    Kind::Switch,
    "whether all but the inside is textured",
);

/// A time of a snapshot in a list of them.
pub(super) const SNAPSHOT_TIME: Kind = number(within(0.0, MAX_TIME_STAR), "snapshots are times t*");

const AUTO: &[&str] = &["auto"];

impl Key {
    /// The keys that set the same thing: a table has one of them.
    pub fn partners(&self) -> impl Iterator<Item = &'static str> + use<> {
        self.partners.into_iter().flatten()
    }

    const fn or(mut self, partner: &'static str) -> Self {
        let mut free = 0;
        while self.partners[free].is_some() {
            free += 1;
        }
        self.partners[free] = Some(partner);
        self
    }

    const fn title(mut self, words: &'static str, symbol: &'static str, unit: &'static str) -> Self {
        self.title = Some(Title { words, symbol, unit });
        self
    }
}

const fn section(is_shape: bool, name: &'static str, keys: &'static [Key]) -> Section {
    Section { name, is_shape, keys }
}

const fn key(name: &'static str, default: &'static str, kind: Kind, doc: &'static str) -> Key {
    Key {
        name,
        kind,
        default,
        partners: [None; 3],
        title: None,
        doc,
    }
}

const fn number(bounds: Bounds, remark: &'static str) -> Kind {
    or_word(bounds, remark, &[])
}

const fn or_word(bounds: Bounds, remark: &'static str, words: &'static [&'static str]) -> Kind {
    Kind::Number {
        bounds,
        remark,
        words,
    }
}

const fn quantity(unit: &'static str, bounds: Bounds) -> Kind {
    Kind::Quantity { unit, bounds }
}

const fn whole(least: u64, most: u64) -> Kind {
    Kind::Whole {
        least,
        most,
        noun: "",
        remark: "",
    }
}

/// From `low` to `high`, both included.
const fn within(low: f64, high: f64) -> Bounds {
    (Included(low), Included(high))
}

/// More than `low`, at most `high`.
const fn above(low: f64, high: f64) -> Bounds {
    (Excluded(low), Included(high))
}

/// More than `low`, less than `high`.
const fn between(low: f64, high: f64) -> Bounds {
    (Excluded(low), Excluded(high))
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
    keys.any(|key| matches!(key.kind, Kind::File(_)))
}

/// The sections of a top-level table.
fn sections_of(table: &str) -> impl Iterator<Item = &'static Section> {
    SECTIONS.iter().filter(move |section| section.table() == table)
}

/// The names of the keys that exclude `key` in a table: each sets the same thing.
pub(super) fn partners<'k>(table: &'k str, key: &'k str) -> impl Iterator<Item = &'static str> + 'k {
    let keys = sections_of(table).filter_map(move |section| section.key(key));
    keys.flat_map(Key::partners)
}
