//! What a run needs to continue later with the same bits.
//!
//! A checkpoint holds the state of every block in the order of the lattice, so that it does not depend on how the kernel
//! lays out its arrays, on the number of threads or on the SIMD width. Everything else that a kernel keeps is found again
//! by its next sweep.

use std::fmt::Formatter;

use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::fixed_point::{FixedPoint, Window};
use crate::kernel::totals::Totals;
use crate::measure::Peak;
use crate::state::State;

/// A run between two steps. `N` is one value per block: [`BlockNumbers`] when read back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint<N = BlockNumbers> {
    /// Number of steps done.
    pub step: u64,
    pub(crate) totals: Totals,
    pub(crate) peak: Peak,
    /// Largest square of a contact stress so far.
    pub(crate) stress_square_max: f64,
    /// Of the fused kernel.
    pub(crate) motion_bounds: Option<MotionBounds>,
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

    /// Takes displacements and velocities out of it.
    pub(crate) fn take_state(&mut self) -> State {
        let take =
            |columns: &mut [BlockNumbers; 2]| columns.each_mut().map(|c| std::mem::take(&mut c.0)).into();
        State {
            displacement: take(&mut self.displacement),
            velocity: take(&mut self.velocity),
        }
    }
}

/// Upper bounds on displacements, on the differences of displacement between the ends of springs, and on speeds: those when they
/// were last measured, and by how much they may have grown since. By them the fused kernel chooses how to compute spring forces,
/// and the quanta of its sums. Part of a checkpoint, so that a resumed run chooses the same at every step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct MotionBounds {
    /// Largest u_x, -u_x, u_y, -u_y at the latest measurement.
    pub(crate) extent: [f64; 4],
    /// Largest difference of u_x and of u_y between the ends of a spring, likewise.
    pub(crate) difference: [f64; 2],
    /// By how much two displacements may have moved apart since.
    pub(crate) growth: f64,
    /// Highest speed after the latest sweep.
    pub(crate) speed: f64,
    /// Ranges of the displacements along x and y, for their sums.
    pub(crate) windows: [Window; 2],
    /// Differences of displacement between the ends of a spring, x and y together, for the sum of their energies.
    pub(crate) spring_range: FixedPoint,
}

impl Default for MotionBounds {
    /// At rest without displacement; not measured yet.
    fn default() -> Self {
        Self {
            extent: [f64::NEG_INFINITY; 4],
            difference: [0.0; 2],
            growth: 0.0,
            speed: 0.0,
            windows: [Window::around(0.0, 0.0); 2],
            spring_range: FixedPoint::new(0.0),
        }
    }
}

impl MotionBounds {
    /// Lowest and highest displacement along an axis.
    pub(crate) fn range(&self, axis: usize) -> [f64; 2] {
        let [high, low] = [self.extent[2 * axis], -self.extent[2 * axis + 1]];
        [low - self.growth, high + self.growth]
    }

    /// Largest difference of displacement along an axis between the ends of a spring.
    pub(crate) fn spring_difference(&self, axis: usize) -> f64 {
        self.difference[axis] + self.growth
    }

    /// Largest possible `|eps s|/d^2` of a spring, with `s = (r^2 - d^2)/eps`.
    pub(crate) fn max_strain(&self, epsilon: f64) -> f64 {
        let (ex, ey) = (self.spring_difference(0), self.spring_difference(1));
        epsilon * (2.0 * (ex + ey) + epsilon * (ex * ex + ey * ey))
    }

    /// Moves the ranges of sums that no longer hold all numbers; whether there were such.
    pub(crate) fn move_ranges(&mut self) -> bool {
        let mut moved = false;
        for axis in 0..2 {
            let [low, high] = self.range(axis);
            if !self.windows[axis].contains(low, high) {
                self.windows[axis] = Window::around(low, high);
                moved = true;
            }
        }
        let difference = self.spring_difference(0) + self.spring_difference(1);
        if moved || !(difference <= self.spring_range.limit()) {
            self.spring_range = FixedPoint::new(difference.max(MIN_SPRING_RANGE));
            moved = true;
        }
        moved
    }
}

/// Springs of blocks that slide are stretched by more.
const MIN_SPRING_RANGE: f64 = 1e-9;

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
