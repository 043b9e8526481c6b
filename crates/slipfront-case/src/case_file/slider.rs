//! `[slider]`: the lattice of blocks and its material.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use slipfront::Edges;

use super::check::Check;
use super::error::CaseError;
use super::key::{ARRAY, Key, KeyKind, StarUnit, key, number, quantity, whole, within};
use super::motion::Along;
use super::probe::names_of;
use super::values::{Pair, pair, word};
use super::words::Outline;
use crate::key_rows;
use crate::quantity::{Density, Length, Pressure, Rate};
use slipfront_base::number_format::count;

/// Largest number of blocks along an axis.
pub(crate) const MAX_BLOCKS: u64 = 100_000;
/// Least and largest property of a block over that of the whole slider.
pub(crate) const MIN_RELATIVE: f64 = 1e-6;
pub(crate) const MAX_RELATIVE: f64 = 1e6;

key_rows! {
    /// `[slider]`: the blocks, their material, the damping and the edges.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(try_from = "SliderKeys", into = "SliderKeys")]
    pub struct Slider from SliderKeys {
        /// Blocks along x and along y.
        #[serde(deserialize_with = "pair")]
        pub blocks: [u32; 2] = key("[25, 25]", whole(1, MAX_BLOCKS)).paper("N_x, N_y")
            .title("blocks along a side", "", "")
            .further_bounds(" each, at most 4 000 000 000 together and [what memory holds](#what-a-run-needs); at least 3 along a periodic axis"),
        /// Edge of a block.
        pub block_size: Length = key("\"1 um\"", quantity("m", within(1e-12, 1e3))).paper("l")
            .title("block size", "l", "m"),
        /// Thickness of the sheet that the slider is; `block_size` if not given, as of the paper's cubes. A
        /// part is a sheet up to a third of the smallest feature and of the pitch of its texture; a thicker
        /// one is a bulk body, for which the effect of the texture is wrong, and has a note.
        pub thickness: Option<Length> = key("", quantity("m", within(1e-12, 1e3)))
            .title("thickness", "h", "m")
            .note("[Thickness and mount](../model.md#thickness-and-mount) tells what it changes, and what to write for a bulk body."),
        /// Young's modulus.
        pub young_modulus: Pressure = key("\"100 GPa\"", quantity("Pa", within(1e-3, 1e15))).paper("E")
            .title("Young's modulus", "E", "Pa"),
        /// Density.
        pub density: Density = key("\"10 g/cm^3\"", quantity("kg/m^3", within(1e-6, 1e9))).paper("rho")
            .title("density", "\u{3c1}", "kg/m\u{b3}"),
        [
            /// Damping of the blocks' motion: `omega_star` or `damping_rate`.
            pub damping: Damping or "the slider needs a damping: `omega_star` or `damping_rate`" {
                /// Damping of the blocks' motion.
                omega_star: f64 => OmegaStar = key("0.1", number(within(0.0, 1e3), "a slider that rings little has 1"))
                    .star(StarUnit::Rate)
                    .or("damping_rate").paper("Omega* = Omega sqrt(m/k_1)").title("damping", "\u{3a9}*", ""),
                /// Damping with its unit, in place of `omega_star`.
                damping_rate: Rate => Rate = key("", quantity("1/s", within(0.0, 1e24))).or("omega_star")
                    .paper("Omega")
                    .title("damping", "\u{3a9}", "1/s"),
            }
        ]
        /// Parts beyond the edges that bound x and those that bound y.
        #[serde(serialize_with = "write_edges", deserialize_with = "read_edges")]
        pub edges: [Edges; 2] = key("\"free\"", KeyKind::Words(names_of::<Edges>))
            .further_bounds(", or a pair of them"),
        /// Shape of the slider: blocks outside do not exist. A disc has as many blocks along x as along y.
        #[serde(deserialize_with = "word")]
        pub outline: Outline = key("\"rectangle\"", KeyKind::Words(names_of::<Outline>)),
        /// The shape as a mask: dark pixels, or 1 in an array, are blocks; for `outline = "mask"`.
        pub outline_file: Option<String> = key("", KeyKind::File(&["png", "npy"])),
        /// Damping constant of a damper beside every spring between blocks over the spring's stiffness, tau_v
        /// in t*.
        pub viscosity_time_star: f64 = key("0", number(within(0.0, 1e3), "it is a time in t*, of the order of 0.1 where it matters"))
            .star(StarUnit::Time)
            .title("viscosity", "\u{3c4}\u{1d65}*", ""),
        /// Young's modulus over `young_modulus`, block by block.
        pub stiffness_field: Option<String> = key("", ARRAY).or("stiffness_grade"),
        /// Young's modulus over `young_modulus`, from one edge to the other, in place of the field.
        pub stiffness_grade: Option<Grade> = key("", GRADE).or("stiffness_field"),
        /// Density over `density`, block by block.
        pub density_field: Option<String> = key("", ARRAY).or("density_grade"),
        /// Density over `density`, from one edge to the other, in place of the field.
        pub density_grade: Option<Grade> = key("", GRADE).or("density_field"),
    }
}

key_rows! {
    /// A property relative to that of the whole slider that changes linearly along an axis, from one edge to
    /// the other.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Grade {
        /// The axis.
        #[serde(deserialize_with = "word")]
        pub along: Along = key("", KeyKind::Words(names_of::<Along>)),
        /// Value at the edge where the axis begins.
        pub from: f64 = key("", RELATIVE_PROPERTY),
        /// Value at the other edge.
        pub to: f64 = key("", RELATIVE_PROPERTY),
    }
}

/// A property of a block over that of the whole slider.
const RELATIVE_PROPERTY: KeyKind = number(
    within(MIN_RELATIVE, MAX_RELATIVE),
    "it is relative, so that 1 changes nothing",
);
const GRADE: KeyKind = KeyKind::Table("{ along = \"x\", from = 1, to = 0.1 }", Grade::KEYS);

/// Largest number of all blocks.
pub(crate) const MAX_BLOCKS_TOTAL: u64 = 4_000_000_000;
/// Smallest number of blocks along a periodic axis, where a block has two neighbours.
const MIN_BLOCKS_PERIODIC: u32 = 3;

impl Slider {
    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        let [nx, ny] = self.blocks;
        check.value("blocks", &self.blocks)?;
        let total = u64::from(nx) * u64::from(ny);
        if total > MAX_BLOCKS_TOTAL {
            return check.refuse("blocks", |key| {
                format!(
                    "`{key}` is [{nx}, {ny}], {total} blocks together: more than {MAX_BLOCKS_TOTAL}; take fewer along one \
                     axis"
                )
            });
        }
        for (axis, n, edge) in [("x", nx, self.edges[0]), ("y", ny, self.edges[1])] {
            if edge == Edges::Periodic && n < MIN_BLOCKS_PERIODIC {
                let key = if check.has("blocks") { "blocks" } else { "edges" };
                return check.refuse(key, |_| {
                    format!(
                        "{} along {axis}: periodic edges need at least {MIN_BLOCKS_PERIODIC}; take more, or free edges along {axis}",
                        count(n as usize, "block")
                    )
                });
            }
        }
        check.value("block_size", &self.block_size)?;
        check.value("thickness", &self.thickness)?;
        check.value("young_modulus", &self.young_modulus)?;
        check.value("density", &self.density)?;
        self.damping.check(check)?;
        check.value("viscosity_time_star", &self.viscosity_time_star)?;
        let properties = [
            (
                "stiffness_field",
                &self.stiffness_field,
                "stiffness_grade",
                &self.stiffness_grade,
            ),
            (
                "density_field",
                &self.density_field,
                "density_grade",
                &self.density_grade,
            ),
        ];
        for (field, file, grade, ends) in properties {
            check.value(field, file)?;
            if let Some(Grade { from, to, .. }) = ends {
                check.value_of(&RELATIVE_PROPERTY, &format!("{grade}.from"), from)?;
                check.value_of(&RELATIVE_PROPERTY, &format!("{grade}.to"), to)?;
            }
        }
        self.check_outline(check)
    }

    fn check_outline(&self, check: &Check) -> Result<(), CaseError> {
        check.value("outline_file", &self.outline_file)?;
        let [nx, ny] = self.blocks;
        match (self.outline, &self.outline_file) {
            (Outline::Mask, None) => check.refuse("outline", |key| {
                format!("`{key}` = \"mask\" needs `outline_file`, the image or array that says which blocks exist")
            }),
            (Outline::Rectangle | Outline::Disc, Some(_)) => check.refuse("outline_file", |key| {
                format!("`{key}` is not read: it belongs to `outline` = \"mask\"; set that, or leave the file out")
            }),
            (Outline::Disc, None) if nx != ny => check.refuse("blocks", |key| {
                format!("`{key}` is [{nx}, {ny}]: a disc has as many blocks along x as along y")
            }),
            (Outline::Disc | Outline::Mask, _) if self.edges.contains(&Edges::Periodic) => {
                check.refuse("outline", |key| {
                    format!(
                        "`{key}` has no meaning with periodic edges, where a slider has no end: take `edges` = \"free\", or \
                         leave it out"
                    )
                })
            }
            _ => Ok(()),
        }
    }
}

#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "expected \"free\", \"periodic\", or a pair for x and y such as [\"periodic\", \"free\"]"
)]
enum EdgesKey {
    Both(Edges),
    Each(Pair<Edges>),
}

fn read_edges<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[Edges; 2], D::Error> {
    Ok(match EdgesKey::deserialize(deserializer)? {
        EdgesKey::Both(edge) => [edge; 2],
        EdgesKey::Each(Pair(edges)) => edges,
    })
}

fn write_edges<S: Serializer>(edges: &[Edges; 2], serializer: S) -> Result<S::Ok, S::Error> {
    if edges[0] == edges[1] {
        edges[0].serialize(serializer)
    } else {
        edges.serialize(serializer)
    }
}
