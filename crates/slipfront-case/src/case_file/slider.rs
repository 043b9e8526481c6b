//! `[slider]`: the lattice of blocks and its material.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use slipfront::lattice::{K_STRAIGHT, POISSON_RATIO};
use slipfront::{Edges, Face, next_side};

use super::check::{Check, Checked};
use super::error::CaseError;
use super::key::{ARRAY, Key, KeyKind, StarUnit, key, number, quantity, whole, within};
use super::load::Along;
use super::serde_names::names_of;
use super::values::{Pair, is_default, pair};
use super::words::{Body, EdgeSprings, Outline};
use crate::key_rows;
use crate::quantity::{Density, Length, Pressure, Rate};
use slipfront_base::number_format::count;

/// Reason why properties that differ between blocks are refused for a bulk body.
const UNEQUAL: &str = "how far they reach into a bulk body is not known";
/// Largest number of blocks along an axis.
pub(crate) const MAX_BLOCKS: u64 = 100_000;
/// Smallest and largest ratio of a property of a block to that of the whole slider.
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
        /// Edge length of a block.
        pub block_size: Length = key("\"1 um\"", quantity("m", within(1e-12, 1e3))).paper("l")
            .title("block size", "l", "m"),
        /// Thickness of the sheet that the slider is; `block_size` if not given, as of the paper's cubes. A
        /// part is a sheet up to a third of the smallest feature and of the pitch of its texture; a thicker
        /// one is a bulk body, for which the effect of the texture is wrong, and has a note.
        pub thickness: Option<Length> = key("", quantity("m", within(1e-12, 1e3)))
            .title("thickness", "h", "m")
            .note("[Thickness and mount](../model.md#thickness-and-mount) tells what it changes, and what to write for a bulk body."),
        /// Kind of body: a sheet, or a bulk body, which has the exact elastic response of a periodic piece of
        /// a larger part, deep or glued to a rigid back.
        #[serde(skip_serializing_if = "is_default")]
        pub body: Body = key("\"sheet\"", KeyKind::Words(names_of::<Body>))
            .note("See [bulk bodies](../model.md#bulk-bodies)."),
        /// Height of a bulk body, from the contact to the driven back.
        pub height: Option<Length> = key("", quantity("m", within(1e-12, 1e6))).without("deep: many pitches")
            .title("height", "H", "m"),
        /// Poisson's ratio of a bulk body.
        pub poisson: Option<f64> = key("", number(within(0.0, 0.5), "most metals have 0.3, rubber nearly 0.5")).without("1/3")
            .title("Poisson's ratio", "\u{3bd}", ""),
        /// Support of the contact face of a bulk body: a pressure that is given at every place, as on a
        /// compliant foundation, or a rigid foundation that keeps the face flat. A flat face is 4 (1 -
        /// nu)^2/(3 - 4 nu) times as stiff along: a third more at nu = 0, nothing at 0.5.
        #[serde(skip_serializing_if = "is_default")]
        pub face: Face = key("\"pressure\"", KeyKind::Words(names_of::<Face>)),
        /// Young's modulus.
        pub young_modulus: Pressure = key("\"100 GPa\"", quantity("Pa", within(1e-3, 1e15))).paper("E")
            .title("Young's modulus", "E", "Pa"),
        /// Whether the slider is rigid: one block on a spring of `drive.total_stiffness`, without a Young's
        /// modulus. The units t* and u* use the modulus for which the spring has the paper's stiffness, 0.375
        /// E h. Results in newtons, metres and seconds do not depend on it.
        #[serde(skip_serializing_if = "std::ops::Not::not")]
        pub rigid: bool = key("false", KeyKind::Switch),
        /// Density.
        pub density: Density = key("\"10 g/cm^3\"", quantity("kg/m^3", within(1e-6, 1e9))).paper("rho")
            .title("density", "\u{3c1}", "kg/m\u{b3}"),
        [
            /// Damping of the blocks' motion: `omega_star` or `damping_rate`.
            pub damping: Damping or "the slider needs a damping: `omega_star` or `damping_rate`" {
                /// Damping of the motion of the blocks. A bulk body has the critical damping of its longest
                /// wave if not given.
                omega_star: f64 => OmegaStar = key("0.1", number(within(0.0, 1e3), "a slider that rings little has 1"))
                    .star(StarUnit::Rate)
                    .paper("Omega* = Omega sqrt(m/k_1)").title("damping", "\u{3a9}*", ""),
                /// Damping with its unit, instead of `omega_star`.
                damping_rate: Rate => Rate = key("", quantity("1/s", within(0.0, 1e24)))
                    .paper("Omega")
                    .title("damping", "\u{3a9}", "1/s"),
            }
        ]
        /// Boundary conditions at the edges that bound x, and at those that bound y.
        #[serde(serialize_with = "write_edges", deserialize_with = "read_edges")]
        pub edges: [Edges; 2] = key("\"free\"", KeyKind::Words(names_of::<Edges>))
            .further_bounds(", or a pair of them"),
        /// Springs between neighbours along a free edge: as stiff as those inside, as in the paper, or half
        /// as stiff, as a continuum of squares between four blocks has them.
        #[serde(skip_serializing_if = "is_default")]
        pub edge_springs: EdgeSprings = key("\"whole\"", KeyKind::Words(names_of::<EdgeSprings>))
            .note("See [springs along edges](../model.md#an-upright-sheet)."),
        /// Shape of the slider; there are no blocks outside it. A disc needs as many blocks along x as along
        /// y.
        pub outline: Outline = key("\"rectangle\"", KeyKind::Words(names_of::<Outline>)),
        /// Mask of the shape, for `outline = "mask"`: dark pixels, or 1 in an array, are blocks.
        pub outline_file: Option<String> = key("", KeyKind::File(&["png", "npy"])),
        /// Retardation time tau_v of the springs between blocks, in t*: each has a parallel damper with tau_v
        /// times its stiffness.
        pub viscosity_time_star: f64 = key("0", number(within(0.0, 1e3), "it is a time in t*, of the order of 0.1 where it matters"))
            .star(StarUnit::Time)
            .title("viscosity", "\u{3c4}\u{1d65}*", ""),
        /// Young's modulus relative to `young_modulus`, block by block.
        pub stiffness_field: Option<String> = key("", ARRAY).or(&["stiffness_grade"]),
        /// Young's modulus relative to `young_modulus`, from one edge to the other, instead of the field.
        pub stiffness_grade: Option<Grade> = key("", GRADE).or(&["stiffness_field"]),
        /// Density relative to `density`, block by block.
        pub density_field: Option<String> = key("", ARRAY).or(&["density_grade"]),
        /// Density relative to `density`, from one edge to the other, instead of the field.
        pub density_grade: Option<Grade> = key("", GRADE).or(&["density_field"]),
    }
}

key_rows! {
    /// A property relative to that of the whole slider, with a linear change along an axis, from one edge to
    /// the other.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Grade checked {
        /// The axis.
        pub along: Along = key("", KeyKind::Words(names_of::<Along>)),
        /// Value at the edge where the axis begins.
        pub from: f64 = key("", RELATIVE_PROPERTY),
        /// Value at the other edge.
        pub to: f64 = key("", RELATIVE_PROPERTY),
    }
}

/// Kind of a property of a block relative to that of the whole slider.
const RELATIVE_PROPERTY: KeyKind = number(
    within(MIN_RELATIVE, MAX_RELATIVE),
    "it is relative, so that 1 changes nothing",
);
const GRADE: KeyKind = KeyKind::Table("{ along = \"x\", from = 1, to = 0.1 }", Grade::KEYS);

/// Young's modulus of a case without the key, in Pa.
const DEFAULT_MODULUS: f64 = 100e9;

/// Largest total number of blocks.
pub(crate) const MAX_BLOCKS_TOTAL: u64 = 4_000_000_000;
/// Smallest number of blocks along a periodic axis, so that a block has two different neighbours.
const MIN_BLOCKS_PERIODIC: u32 = 3;

impl Slider {
    /// The bulk body, in units of the block size; none for a sheet.
    pub(crate) fn bulk_body(&self) -> Option<slipfront::Body> {
        let body = || slipfront::Body {
            height: self
                .height
                .as_ref()
                .map_or(f64::INFINITY, |height| height.si() / self.block_size.si()),
            poisson: self.poisson.unwrap_or(POISSON_RATIO),
            face: self.face,
        };
        (self.body == Body::Bulk).then(body)
    }

    /// Omega* of the critical damping of the longest wave of a bulk body, `2 sqrt(K/k_1)`. Less lets inertia
    /// carry blocks on after each local slip, which lowers the strength; more makes slow waves come to rest
    /// slowly.
    pub(super) fn critical_damping(&self) -> Option<f64> {
        let longest = f64::from(self.blocks[0].max(self.blocks[1]));
        let stiffness = self.bulk_body()?.along(std::f64::consts::TAU / longest);
        Some(2.0 * (stiffness / K_STRAIGHT).sqrt())
    }

    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        let [nx, ny] = self.blocks;
        self.check_values(check)?;
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
        self.check_body(check)?;
        self.check_rigid(check)?;
        self.check_edge_springs(check)?;
        self.check_outline(check)
    }

    /// Refuses halved springs unless every edge is that of a sheet of squares between blocks.
    fn check_edge_springs(&self, check: &Check) -> Result<(), CaseError> {
        let [nx, ny] = self.blocks;
        let why = if self.edge_springs == EdgeSprings::Whole {
            return Ok(());
        } else if self.body == Body::Bulk {
            "a bulk body has no springs"
        } else if self.outline != Outline::Rectangle {
            "an outline has corners and necks of single blocks, between which there is no square"
        } else if nx.min(ny) == 1 {
            "a chain has no square between four blocks"
        } else {
            return Ok(());
        };
        check.refuse("edge_springs", |key| {
            format!("`{key}` = \"halved\" does not apply here: {why}; use \"whole\"")
        })
    }

    /// Refuses a rigid slider of several blocks, or with a modulus.
    fn check_rigid(&self, check: &Check) -> Result<(), CaseError> {
        let has_modulus = self.young_modulus.si() != DEFAULT_MODULUS;
        let keys = [
            ("blocks", self.blocks != [1, 1], "is one block: set it to [1, 1]"),
            ("young_modulus", has_modulus, "has none: leave it out"),
        ];
        let wrong = keys.iter().find(|(_, is_wrong, _)| self.rigid && *is_wrong);
        wrong.map_or(Ok(()), |(key, _, why)| {
            check.refuse(key, |key| {
                format!("`{key}` cannot be combined with `slider.rigid`: a rigid slider {why}")
            })
        })
    }

    /// Refuses keys of a bulk body for a sheet, and vice versa.
    fn check_body(&self, check: &Check) -> Result<(), CaseError> {
        let of_bulk = [
            ("height", self.height.is_some()),
            ("poisson", self.poisson.is_some()),
            ("face", self.face == Face::Flat),
        ];
        if self.body == Body::Sheet {
            let given = of_bulk.iter().find(|(_, is_given)| *is_given);
            return given.map_or(Ok(()), |(key, _)| {
                check.refuse(key, |key| {
                    format!("`{key}` belongs to `slider.body` = \"bulk\": set that, or leave it out")
                })
            });
        }
        let has_outline = self.outline != Outline::Rectangle;
        let is_viscous = self.viscosity_time_star > 0.0;
        let of_sheet = [
            (
                "thickness",
                self.thickness.is_some(),
                "a bulk body has a `height`",
            ),
            ("outline", has_outline, "it is a periodic piece of a larger part"),
            ("stiffness_field", self.stiffness_field.is_some(), UNEQUAL),
            ("stiffness_grade", self.stiffness_grade.is_some(), UNEQUAL),
            ("density_field", self.density_field.is_some(), UNEQUAL),
            ("density_grade", self.density_grade.is_some(), UNEQUAL),
            (
                "viscosity_time_star",
                is_viscous,
                "no dampers of a bulk body are derived",
            ),
        ];
        if let Some((key, _, why)) = of_sheet.iter().find(|(_, is_given, _)| *is_given) {
            return check.refuse(key, |key| {
                format!("`{key}` does not apply to `slider.body` = \"bulk\": {why}; leave it out, or use \"sheet\"")
            });
        }
        if let Some(height) = &self.height
            && height.si() < self.block_size.si()
        {
            return check.refuse("height", |key| {
                format!(
                    "`{key}` is \"{height}\", less than a block of \"{}\": use smaller blocks, or a sheet of this `thickness`",
                    self.block_size
                )
            });
        }
        let is_undamped = match &self.damping {
            Damping::OmegaStar(damping) => *damping == 0.0,
            Damping::Rate(damping) => damping.si() == 0.0,
        };
        if is_undamped {
            return check.refuse(self.damping.key(), |key| {
                format!(
                    "`{key}` is 0: a bulk body without damping never rests, and gives wrong strengths; leave it out, for the \
                     critical damping of its longest wave"
                )
            });
        }
        self.check_sides(check)
    }

    /// Refuses edges and sides that the transform of a bulk body does not have.
    fn check_sides(&self, check: &Check) -> Result<(), CaseError> {
        if self.edges.contains(&Edges::Free) {
            return check.refuse("edges", |key| {
                format!(
                    "`{key}` = \"free\" does not apply to `slider.body` = \"bulk\", which is computed as a piece of a larger part: \
                     leave it out, and cut the piece to whole cells of the texture. A pad of its own loses 17 to 37 % of its \
                     strength to its edges, or 4 to 17 % where its face is held flat, which no key computes"
                )
            });
        }
        let [nx, ny] = self.blocks;
        let next = self.blocks.map(|n| next_side(n as usize));
        if next != [nx as usize, ny as usize] {
            return check.refuse("blocks", |key| {
                format!(
                    "`{key}` is [{nx}, {ny}]: the sides of a bulk body are products of 2, 3 and 5; the next ones are [{}, {}]",
                    next[0], next[1]
                )
            });
        }
        Ok(())
    }

    /// Whether the slider is as thick as a block because no key gives its thickness.
    pub(crate) fn thickness_is_a_block(&self) -> bool {
        self.body == Body::Sheet && self.thickness.is_none()
    }

    fn check_outline(&self, check: &Check) -> Result<(), CaseError> {
        let [nx, ny] = self.blocks;
        match (self.outline, &self.outline_file) {
            (Outline::Mask, None) => check.refuse("outline", |key| {
                format!("`{key}` = \"mask\" needs `outline_file`, the image or array of the existing blocks")
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
                        "`{key}` does not apply to periodic edges, because the slider has no boundary: use `edges` = \"free\", \
                         or leave it out"
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
