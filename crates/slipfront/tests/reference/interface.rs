//! Friction of an upright sheet: along x alone, with normal forces that follow a foundation along y.

use slipfront::Interface;

use super::step::{Motion, Update};
use super::vector::Vector;

/// Normal force `N = max(0, F_n - K u_y)` on a block in contact.
fn normal_force(interface: &Interface, load: f64, rise: f64) -> f64 {
    if interface.foundation == 0.0 {
        load
    } else {
        (load - interface.foundation * rise).max(0.0)
    }
}

/// Force along y on a block in contact from the change of its normal force, `N - F_n`.
pub(crate) fn reaction(interface: &Interface, load: f64, rise: f64) -> f64 {
    normal_force(interface, load, rise) - load
}

/// Factor of both thresholds, `N/F_n`; 1 without load.
pub(crate) fn factor(interface: &Interface, load: f64, rise: f64) -> f64 {
    if load > 0.0 {
        normal_force(interface, load, rise) / load
    } else {
        1.0
    }
}

/// The update of a block with friction along x alone, by Moreau's time-stepping.
pub(crate) fn update(motion: &Motion, force: Vector, holds: f64, slows: f64) -> Update {
    let free = motion.accelerated(force);
    let most = motion.change_of_velocity(slows);
    let is_held = motion.velocity[0] == 0.0 && force[0].abs() <= holds;
    if is_held || free[0].abs() <= most {
        return Update {
            velocity: [0.0, free[1]],
            friction: [-force[0], 0.0],
        };
    }
    let sign = free[0].signum();
    Update {
        velocity: [free[0] - sign * most, free[1]],
        friction: [-sign * slows, 0.0],
    }
}
