//! State that a run needs to continue later with the same bits.
//!
//! A checkpoint is small. The columns are stored next to it: numbers of every block in the order of the
//! lattice, so that they do not depend on how the kernel lays out its arrays, on the number of threads or
//! ranks, or on the SIMD width. They are passed part by part, so that no array of the size of the lattice is
//! copied. The next sweep computes everything else that a kernel keeps.

use serde::{Deserialize, Serialize};

use crate::clock::{Clock, Rest};
use crate::fixed_point::{FixedPoint, Window};
use crate::friction::ContactTotals;
use crate::measure::Peak;
use crate::model::Model;
use crate::totals::Totals;

/// A run between two steps, without the numbers of its blocks, which are the columns of the checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Number of steps done.
    pub step: u64,
    /// Number of steps in which the drive moved.
    pub drive_steps: u64,
    /// Number of consecutive steps up to this one in which the drive stood still.
    pub(crate) standing: u64,
    pub(crate) rest: Rest,
    pub(crate) totals: Totals,
    pub(crate) contact: ContactTotals,
    pub(crate) peak: Peak,
    /// Largest square of a contact stress so far.
    pub(crate) stress_square_max: f64,
    /// Bounds on displacements and speeds; present only for the fused kernel.
    pub(crate) motion_bounds: Option<MotionBounds>,
}

impl Checkpoint {
    /// The instant of the checkpoint, with times in steps of `dt_star`.
    pub(crate) fn clock(&self, dt_star: f64) -> Clock {
        Clock {
            step: self.step,
            drive_steps: self.drive_steps,
            standing: self.standing,
            rest: self.rest,
            dt_star,
        }
    }

    /// Whether a run of this model can have these counts of steps.
    pub fn is_consistent_with(&self, model: &Model) -> bool {
        let stood = self.step.checked_sub(self.drive_steps);
        let is_held = model.drive.is_held();
        (self.rest == Rest::Exact || is_held)
            && stood.is_some_and(|stood| self.standing <= stood && (stood == 0 || is_held))
    }
}

impl Model {
    /// Number of columns of a checkpoint; a column holds one number per block.
    pub fn n_columns(&self) -> usize {
        BlockColumn::ALL.len() + self.n_memory_columns()
    }

    /// Number of columns in addition to [`BlockColumn::ALL`]: those of the law of friction, then displacement
    /// and velocity along x and y of every sheet above the lowest one, at the same instants as for the lowest
    /// one.
    pub(crate) fn n_memory_columns(&self) -> usize {
        self.friction.n_columns() + 4 * self.sheets.len()
    }
}

/// A number that is kept for every block, whatever the law of friction. A law of friction with more memory
/// adds [columns](crate::Friction::n_columns) of its own after these.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlockColumn {
    /// u_x at t_n.
    DisplacementX,
    /// u_y at t_n.
    DisplacementY,
    /// v_x half a step after t_n for the fused kernel, half a step before t_n for the general kernel, which
    /// evaluates t_n again.
    VelocityX,
    /// v_y at the instant of [`VelocityX`](Self::VelocityX).
    VelocityY,
    /// t* of the first slip; NaN for a block that has not slipped.
    FirstSlip,
}

impl BlockColumn {
    /// All columns, in the order in which they are passed.
    pub const ALL: [Self; 5] = [
        Self::DisplacementX,
        Self::DisplacementY,
        Self::VelocityX,
        Self::VelocityY,
        Self::FirstSlip,
    ];

    /// Number of blocks in a part of a column.
    const PART: usize = 1 << 16;

    /// Passes all columns of `n_blocks` blocks part by part to `work`: the column, the first block, and room
    /// for the values. Stops at the first error.
    pub(crate) fn for_each_part<E>(
        n_blocks: usize,
        mut work: impl FnMut(Self, usize, &mut [f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        Self::ALL.into_iter().try_for_each(|column| {
            Self::for_each_part_of_one(n_blocks, |first, values| work(column, first, values))
        })
    }

    /// Passes one column of `n_blocks` blocks part by part to `work`, as [`for_each_part`] does for all
    /// columns.
    pub(crate) fn for_each_part_of_one<E>(
        n_blocks: usize,
        mut work: impl FnMut(usize, &mut [f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut values = vec![0.0; n_blocks.min(Self::PART)];
        (0..n_blocks).step_by(Self::PART).try_for_each(|first| {
            let len = Self::PART.min(n_blocks - first);
            work(first, &mut values[..len])
        })
    }
}

/// Upper bounds on displacements, on the differences of displacement between the ends of springs, and on
/// speeds: the values of the latest measurement, and the most by which they may have grown since. From them
/// the fused kernel chooses how to compute spring forces, and the quanta of its sums. They are part of a
/// checkpoint, so that a resumed run makes the same choices at every step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct MotionBounds {
    /// Largest u_x, -u_x, u_y, -u_y at the latest measurement.
    pub(crate) extent: [f64; 4],
    /// Largest differences of u_x and of u_y between the ends of a spring at the latest measurement.
    pub(crate) difference: [f64; 2],
    /// Distance by which two displacements may have moved apart since the latest measurement.
    pub(crate) growth: f64,
    /// Highest speed after the latest sweep.
    pub(crate) speed: f64,
    /// Ranges of the displacements along x and y, for their sums.
    pub(crate) windows: [Window; 2],
    /// Range of the differences of displacement between the ends of a spring, for both axes, used by the sum
    /// of spring energies.
    pub(crate) spring_range: FixedPoint,
}

impl Default for MotionBounds {
    /// Bounds of blocks at rest without displacement, not measured yet.
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
    /// Number of values in [`to_numbers`](Self::to_numbers).
    pub(crate) const LEN: usize = 13;

    /// The bounds as numbers, in the order of the fields; a window gives its centre and the limit of its
    /// differences.
    pub(crate) fn to_numbers(self) -> [f64; Self::LEN] {
        let [right, left, up, down] = self.extent;
        let [along_x, along_y] = self.difference;
        let [x, y] = self.windows;
        let (growth, speed, spring_range) = (self.growth, self.speed, self.spring_range.limit());
        let [x, y] = [x, y].map(|window| [window.centre(), window.differences().limit()]);
        [
            right,
            left,
            up,
            down,
            along_x,
            along_y,
            growth,
            speed,
            x[0],
            x[1],
            y[0],
            y[1],
            spring_range,
        ]
    }

    /// Bounds from the numbers that [`to_numbers`](Self::to_numbers) returned.
    pub(crate) fn of_numbers(numbers: [f64; Self::LEN]) -> Self {
        let [
            right,
            left,
            up,
            down,
            along_x,
            along_y,
            growth,
            speed,
            x0,
            x1,
            y0,
            y1,
            spring_range,
        ] = numbers;
        Self {
            extent: [right, left, up, down],
            difference: [along_x, along_y],
            growth,
            speed,
            windows: [Window::of([x0, x1]), Window::of([y0, y1])],
            spring_range: FixedPoint::of_limit(spring_range),
        }
    }

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

    /// Moves the ranges of sums that no longer hold all numbers; returns whether there were such ranges.
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
        // False for NaN, too.
        let is_within = difference <= self.spring_range.limit();
        if moved || !is_within {
            self.spring_range = FixedPoint::new(difference.max(MIN_SPRING_RANGE));
            moved = true;
        }
        moved
    }
}

/// Least range of spring stretches; blocks that slide stretch their springs by more.
const MIN_SPRING_RANGE: f64 = 1e-9;
