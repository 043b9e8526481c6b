//! What a run needs to go on later, to the last bit.
//!
//! A checkpoint holds the state of every block in the order of the lattice, so that it does not depend on how the kernel
//! lays out its arrays, on the number of threads or on the SIMD width. Everything else that a kernel keeps is found again
//! by its next sweep.

use std::fmt::Formatter;

use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::kernel::{Engine, Totals};
use crate::observe::Peak;

/// A run between two steps. `N` is one number per block: of a running simulation they are read off its arrays as they are
/// written, so that a checkpoint takes no memory.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint<N = BlockNumbers> {
    /// Number of steps done.
    pub step: u64,
    pub(crate) totals: Totals,
    pub(crate) peak: Peak,
    /// Largest square of a contact stress so far.
    pub(crate) stress_square_max: f64,
    /// What chooses between series and square root; none of the reference kernel.
    pub(crate) strains: Option<StrainBound>,
    /// At t_n.
    pub(crate) displacement: [N; 2],
    /// Half a step later; half a step earlier of the reference kernel, which evaluates t_n again.
    pub(crate) velocity: [N; 2],
    /// t* of the first slip, not a number where there was none.
    pub(crate) first_slip: N,
}

/// What bounds the strains of all springs from one look at the displacements to the next.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct StrainBound {
    /// Largest u_x, -u_x, u_y, -u_y at the latest look.
    pub(crate) extent: [f64; 4],
    /// How much they may have grown since.
    pub(crate) growth: f64,
    /// Highest speed after the latest sweep.
    pub(crate) speed: f64,
}

impl Checkpoint {
    /// Whether it is one of a lattice of `n` blocks.
    pub(crate) fn has_blocks(&self, n: usize) -> bool {
        let all = self.displacement.iter().chain(&self.velocity);
        all.chain([&self.first_slip]).all(|numbers| numbers.0.len() == n)
    }
}

/// One number of every block, read back. However many there are said to be, room is made for those that come, an eighth
/// more at a time: twice as much would be more than a large lattice leaves.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BlockNumbers(pub(crate) Vec<f64>);

impl<'de> Deserialize<'de> for BlockNumbers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Numbers;
        impl<'de> Visitor<'de> for Numbers {
            type Value = Vec<f64>;

            fn expecting(&self, formatter: &mut Formatter) -> std::fmt::Result {
                formatter.write_str("one number per block")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut read: A) -> Result<Vec<f64>, A::Error> {
                const ROOM: usize = 1 << 13;
                let mut numbers = Vec::new();
                while let Some(number) = read.next_element()? {
                    if numbers.len() == numbers.capacity() {
                        numbers.reserve_exact(ROOM.max(numbers.len() / 8));
                    }
                    numbers.push(number);
                }
                Ok(numbers)
            }
        }
        deserializer.deserialize_seq(Numbers).map(Self)
    }
}

/// One number of every block of a simulation.
#[derive(Clone, Copy)]
pub struct Numbers<'a> {
    pub(crate) engine: &'a Engine,
    pub(crate) n_blocks: usize,
    pub(crate) of: fn(&Engine, usize) -> f64,
}

impl Serialize for Numbers<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq((0..self.n_blocks).map(|b| (self.of)(self.engine, b)))
    }
}
