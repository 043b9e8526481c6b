//! The quanta of all sums over blocks: see [`FixedPoint`]. They follow from bounds on the terms. These follow
//! from the extent of displacements and the highest speed, which every rank and thread knows.

use super::step::Step;
use super::variations::LargestFactors;
use crate::fixed_point::{FixedPoint, Window};
use crate::lattice::{K_DIAGONAL, K_STRAIGHT};
use crate::motion_bounds::MotionBounds;

/// Quanta of the sums in a sweep.
#[derive(Clone, Copy, Debug)]
pub struct Quanta {
    /// Windows of `u - c` for each axis; c is the centre of the window.
    pub displacement: [Window; 2],
    /// Quanta of `w (u - c)`, with the relative stiffness w of the drive springs.
    pub weighted_displacement: [FixedPoint; 2],
    /// Quanta of `w (u - c)^2`.
    pub displacement_square: FixedPoint,
    /// Quanta of `w v`.
    pub velocity: FixedPoint,
    /// Quanta of masses times squares of sums of two velocities.
    pub motion_square: FixedPoint,
    /// Quanta of products of a force and a sum of two velocities.
    pub friction_work: FixedPoint,
    /// Quanta of squares of spring forces over the factors of the springs.
    pub lattice_energy: FixedPoint,
}

/// Factor for rounding in the bounds and in the numbers that they bound.
const MARGIN: f64 = 1.0 + 1e-6;

impl Quanta {
    /// Quanta for a step from bounds on the motion and the largest factors of any block.
    pub fn new(step: &Step, bounds: &MotionBounds, largest: &LargestFactors) -> Self {
        let [x, y] = bounds.windows.map(|window| window.differences().limit());
        let spring_force = K_STRAIGHT * bounds.spring_range.limit();
        let speed = highest_speed(step, bounds, largest);
        let &LargestFactors {
            modulus,
            drive_spring,
            mass,
            ..
        } = largest;
        Self {
            displacement: bounds.windows,
            weighted_displacement: bounds.windows.map(|window| match drive_spring {
                1.0 => window.differences(),
                _ => FixedPoint::new(MARGIN * drive_spring * window.differences().limit()),
            }),
            displacement_square: FixedPoint::new(MARGIN * drive_spring * (x * x + y * y)),
            velocity: FixedPoint::new(drive_spring * speed),
            motion_square: FixedPoint::new(MARGIN * mass * 4.0 * speed * speed),
            // Friction is at most the force that stops a block.
            friction_work: FixedPoint::new(
                MARGIN * mass * step.integrator.velocity_to_force * 2.0 * speed * speed,
            ),
            // Two straight springs, and two diagonal ones, with force factor k_2/k_1 and weight k_1/k_2.
            lattice_energy: FixedPoint::new(
                MARGIN * modulus * (2.0 + 2.0 * (K_DIAGONAL / K_STRAIGHT)) * spring_force * spring_force,
            ),
        }
    }
}

/// A bound on all speeds half a step after `step`: speeds change by no more than without friction.
fn highest_speed(step: &Step, bounds: &MotionBounds, largest: &LargestFactors) -> f64 {
    let mut force = 0.0;
    for axis in 0..2 {
        let [low, high] = bounds.range(axis);
        let position = step.drive_position[axis];
        let stretch = (position - low).abs().max((position - high).abs());
        // The force of a spring is at most its stiffness times the difference of the displacements of its
        // ends.
        let dead_load = largest.load * step.dead_load[axis].abs();
        force += largest.modulus * 4.0 * (K_STRAIGHT + K_DIAGONAL) * bounds.spring_difference(axis)
            + (largest.drive_spring * (step.k_drive * stretch) + dead_load);
        if axis == 1 && largest.foundation > 0.0 {
            force += largest.foundation * low.abs().max(high.abs());
        }
    }
    MARGIN * (bounds.speed + largest.inverse_mass * step.integrator.force_to_velocity * force)
}
