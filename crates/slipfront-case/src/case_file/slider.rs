//! `[slider]`: the lattice of blocks and its material.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use slipfront::Edges;

use super::check::Check;
use super::choice::keys_with_choice;
use super::error::CaseError;
use super::key_table::RELATIVE_PROPERTY;
use super::motion::Along;
use super::values::{Pair, pair, word};
use super::words::Outline;
use crate::quantity::{Density, Length, Pressure, Rate};
use slipfront_base::number_format::count;

/// `[slider]`: the blocks, their material, the damping and the edges.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "SliderKeys", into = "SliderKeys")]
pub struct Slider {
    /// Blocks along x and along y (`N_x`, `N_y`): 1 to 100 000 each, at least 3 along a periodic axis.
    pub blocks: [u32; 2],
    /// Edge of a block (l), m.
    pub block_size: Length,
    /// Thickness of the sheet (h), m; `block_size` if not given.
    pub thickness: Option<Length>,
    /// Young's modulus (E), Pa.
    pub young_modulus: Pressure,
    /// Density (rho), kg/m^3.
    pub density: Density,
    /// Damping of the blocks' motion: `omega_star` or `damping_rate`.
    pub damping: Damping,
    /// The lattice's edges that bound x and those that bound y.
    pub edges: [Edges; 2],
    /// Shape of the slider.
    pub outline: Outline,
    /// The file of an outline that is a mask: `.png` or `.npy`.
    pub outline_file: Option<String>,
    /// Damping constant of the damper beside every spring between blocks over the stiffness of the spring (`tau_v`), in t*.
    pub viscosity_time_star: f64,
    /// A file of Young's moduli over `young_modulus`, block by block: `.npy` or `.csv`, shape (ny, nx).
    pub stiffness_field: Option<String>,
    /// A relative modulus that changes along an axis.
    pub stiffness_grade: Option<Grade>,
    /// A file of densities over `density`, block by block: `.npy` or `.csv`, shape (ny, nx).
    pub density_field: Option<String>,
    /// A relative density that changes along an axis.
    pub density_grade: Option<Grade>,
}

/// A property relative to that of the whole slider that changes linearly along an axis, from one edge to the other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grade {
    /// The axis.
    #[serde(deserialize_with = "word")]
    pub along: Along,
    /// Value at the edge where the axis begins, 1e-6 to 1e6.
    pub from: f64,
    /// Value at the other edge, 1e-6 to 1e6.
    pub to: f64,
}

/// Damping of the motion.
#[derive(Clone, Debug, PartialEq)]
pub enum Damping {
    /// `omega_star`: Omega over the square root of `k_straight/block_mass`, dimensionless, 0 to 1000.
    OmegaStar(f64),
    /// `damping_rate`: Omega of Eq. 5, 1/s.
    Rate(Rate),
}

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

keys_with_choice! {
    Slider: SliderKeys {
        #[serde(deserialize_with = "pair")]
        blocks: [u32; 2],
        block_size: Length,
        #[serde(skip_serializing_if = "Option::is_none")]
        thickness: Option<Length>,
        young_modulus: Pressure,
        density: Density,
        (damping: Damping {
            omega_star: f64 => OmegaStar,
            damping_rate: Rate => Rate,
            _ => "the slider needs a damping: `omega_star` or `damping_rate`"
        }),
        #[serde(serialize_with = "write_edges", deserialize_with = "read_edges")]
        edges: [Edges; 2],
        #[serde(deserialize_with = "word")]
        outline: Outline,
        #[serde(skip_serializing_if = "Option::is_none")]
        outline_file: Option<String>,
        viscosity_time_star: f64,
        #[serde(skip_serializing_if = "Option::is_none")]
        stiffness_field: Option<String>,
        #[serde(skip_serializing_if = "Option::is_none")]
        stiffness_grade: Option<Grade>,
        #[serde(skip_serializing_if = "Option::is_none")]
        density_field: Option<String>,
        #[serde(skip_serializing_if = "Option::is_none")]
        density_grade: Option<Grade>,
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
