//! `[slider]`: the lattice of blocks and its material.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use slipfront::Edges;

use super::check::Check;
use super::choice::keys_with_choice;
use super::error::CaseError;
use super::values::{Pair, pair};
use crate::number_format::count;
use crate::quantity::{Density, Length, Pressure, Rate};

/// `[slider]`: the blocks, their material, the damping and the edges.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "SliderKeys", into = "SliderKeys")]
pub struct Slider {
    /// Blocks along x and along y (`N_x`, `N_y`): 1 to 100 000 each, at least 3 along a periodic axis.
    pub blocks: [u32; 2],
    /// Edge of a block (l), m.
    pub block_size: Length,
    /// Young's modulus (E), Pa.
    pub young_modulus: Pressure,
    /// Density (rho), kg/m^3.
    pub density: Density,
    /// Damping of the blocks' motion: `omega_star` or `damping_rate`.
    pub damping: Damping,
    /// The lattice's edges that bound x and those that bound y.
    pub edges: [Edges; 2],
}

/// How strongly the motion is damped.
#[derive(Clone, Debug, PartialEq)]
pub enum Damping {
    /// `omega_star`: Omega over the square root of `k_straight/block_mass`, dimensionless, 0 to 1000.
    OmegaStar(f64),
    /// `damping_rate`: Omega of Eq. 5, 1/s.
    Rate(Rate),
}

/// Most blocks altogether.
const MAX_BLOCKS_TOTAL: u64 = 4_000_000_000;
/// Fewest blocks along a periodic axis: a block has two neighbours there.
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
        check.value("young_modulus", &self.young_modulus)?;
        check.value("density", &self.density)?;
        self.damping.check(check)
    }
}

keys_with_choice! {
    Slider: SliderKeys {
        #[serde(deserialize_with = "pair")]
        blocks: [u32; 2],
        block_size: Length,
        young_modulus: Pressure,
        density: Density,
        (damping: Damping {
            omega_star: f64 => OmegaStar,
            damping_rate: Rate => Rate,
            _ => "the slider needs a damping: `omega_star` or `damping_rate`"
        }),
        #[serde(serialize_with = "write_edges", deserialize_with = "read_edges")]
        edges: [Edges; 2],
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
