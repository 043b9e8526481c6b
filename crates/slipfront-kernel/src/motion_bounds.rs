//! Bounds on the motion of all blocks, which decide how springs are computed and how sums are rounded.

use serde::{Deserialize, Serialize};

use crate::fixed_point::{FixedPoint, Window};

/// Upper bounds on displacements, on the differences of displacement between the ends of springs, and on
/// speeds: the values of the latest measurement, and the most by which they may have grown since. From them
/// the fused kernel chooses how to compute spring forces, and the quanta of its sums. They are part of a
/// checkpoint, so that a resumed run makes the same choices at every step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotionBounds {
    /// Largest u_x, -u_x, u_y, -u_y at the latest measurement.
    pub extent: [f64; 4],
    /// Largest differences of u_x and of u_y between the ends of a spring at the latest measurement.
    pub difference: [f64; 2],
    /// Distance by which two displacements may have moved apart since the latest measurement.
    pub growth: f64,
    /// Highest speed after the latest sweep.
    pub speed: f64,
    /// Ranges of the displacements along x and y, for their sums.
    pub windows: [Window; 2],
    /// Range of the differences of displacement between the ends of a spring, for both axes, used by the sum
    /// of spring energies.
    pub spring_range: FixedPoint,
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
    pub const LEN: usize = 13;

    /// The bounds as numbers, in the order of the fields; a window gives its centre and the limit of its
    /// differences.
    pub fn to_numbers(self) -> [f64; Self::LEN] {
        let mut numbers = [0.0; Self::LEN];
        numbers[..4].copy_from_slice(&self.extent);
        numbers[4..6].copy_from_slice(&self.difference);
        (numbers[6], numbers[7]) = (self.growth, self.speed);
        for (numbers, window) in numbers[8..12].chunks_exact_mut(2).zip(self.windows) {
            numbers.copy_from_slice(&[window.centre(), window.differences().limit()]);
        }
        numbers[12] = self.spring_range.limit();
        numbers
    }

    /// Bounds from the numbers that [`to_numbers`](Self::to_numbers) returned.
    pub fn from_numbers(numbers: [f64; Self::LEN]) -> Self {
        let pair = |first: usize| [numbers[first], numbers[first + 1]];
        Self {
            extent: [numbers[0], numbers[1], numbers[2], numbers[3]],
            difference: pair(4),
            growth: numbers[6],
            speed: numbers[7],
            windows: [8, 10].map(|first| Window::new(pair(first))),
            spring_range: FixedPoint::with_limit(numbers[12]),
        }
    }

    /// Lowest and highest displacement along an axis.
    pub fn range(&self, axis: usize) -> [f64; 2] {
        let [high, low] = [self.extent[2 * axis], -self.extent[2 * axis + 1]];
        [low - self.growth, high + self.growth]
    }

    /// Largest difference of displacement along an axis between the ends of a spring.
    pub fn spring_difference(&self, axis: usize) -> f64 {
        self.difference[axis] + self.growth
    }

    /// Largest possible `|eps s|/d^2` of a spring, with `s = (r^2 - d^2)/eps`.
    pub fn max_strain(&self, epsilon: f64) -> f64 {
        let (ex, ey) = (self.spring_difference(0), self.spring_difference(1));
        epsilon * (2.0 * (ex + ey) + epsilon * (ex * ex + ey * ey))
    }

    /// Moves the ranges of sums that no longer hold all numbers; returns whether there were such ranges.
    pub fn move_ranges(&mut self) -> bool {
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
