//! What a run needs to continue later with the same bits.
//!
//! A checkpoint holds the state of every block in the order of the lattice, so that it does not depend on how the kernel
//! lays out its arrays, on the number of threads or on the SIMD width. Everything else that a kernel keeps is found again
//! by its next sweep.

use std::fmt::Formatter;

use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::kernel::strain_bound::StrainBound;
use crate::kernel::totals::Totals;
use crate::measure::Peak;

/// A run between two steps. `N` is one value per block: [`BlockNumbers`] when read back, [`BlockColumn`](crate::kernel::BlockColumn) of a
/// running simulation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint<N = BlockNumbers> {
    /// Number of steps done.
    pub step: u64,
    pub(crate) totals: Totals,
    pub(crate) peak: Peak,
    /// Largest square of a contact stress so far.
    pub(crate) stress_square_max: f64,
    /// What the fused kernel chooses its spring formula by; none of the reference kernel.
    pub(crate) strain_bound: Option<StrainBound>,
    /// At t_n.
    pub(crate) displacement: [N; 2],
    /// Half a step after t_n; half a step before it of the reference kernel, which evaluates t_n again.
    pub(crate) velocity: [N; 2],
    /// t* of the first slip; NaN for a block that has not slipped.
    pub(crate) first_slip: N,
}

impl Checkpoint {
    /// Whether it is one of a lattice of `n` blocks.
    pub(crate) fn has_blocks(&self, n: usize) -> bool {
        let all = self.displacement.iter().chain(&self.velocity);
        all.chain([&self.first_slip]).all(|column| column.0.len() == n)
    }
}

/// One value of every block, read back. Memory is reserved for values as they arrive, whatever length the data claims, and
/// by an eighth at a time: doubling could ask for more than a large lattice leaves free.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BlockNumbers(pub(crate) Vec<f64>);

impl<'de> Deserialize<'de> for BlockNumbers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct BlockNumbersVisitor;
        impl<'de> Visitor<'de> for BlockNumbersVisitor {
            type Value = Vec<f64>;

            fn expecting(&self, formatter: &mut Formatter) -> std::fmt::Result {
                formatter.write_str("one number per block")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Vec<f64>, A::Error> {
                const MIN_RESERVED: usize = 1 << 13;
                let mut numbers = Vec::new();
                while let Some(number) = sequence.next_element()? {
                    if numbers.len() == numbers.capacity() {
                        numbers.reserve_exact(MIN_RESERVED.max(numbers.len() / 8));
                    }
                    numbers.push(number);
                }
                Ok(numbers)
            }
        }
        deserializer.deserialize_seq(BlockNumbersVisitor).map(Self)
    }
}
