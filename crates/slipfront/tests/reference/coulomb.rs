//! Static and kinetic friction with memory (Eq. 4), in its three readings; weakening with speed and with
//! slip, and ageing.

use slipfront::{Ageing, FrictionLaw, SlipWeakening, Weakening};

use super::step::{Motion, Update};
use super::vector::{Vector, dot, length, sum, times, unit};

/// Share of kinetic friction that is left at a speed: `ratio + (1 - ratio)/(1 + |v|/v_c)`.
pub(crate) fn weakened(law: Option<Weakening>, speed: f64) -> f64 {
    law.map_or(1.0, |law| {
        law.ratio + (1.0 - law.ratio) / (1.0 + speed / law.critical_speed)
    })
}

/// Ratio of static friction after `age` to that at age 0: `1 + beta ln(1 + t_stuck/tau)`.
pub(crate) fn aged(law: Option<Ageing>, age: f64) -> f64 {
    law.map_or(1.0, |law| 1.0 + law.beta * (1.0 + age / law.time).ln())
}

/// Strength of a block while it is stuck and while it slides, after a slip `s`:
/// `f = K + (S - K) max(0, 1 - s/D_c)` for both, unless `K >= S`.
pub(crate) fn after_slip(law: Option<SlipWeakening>, [holds, slows]: [f64; 2], slip: f64) -> [f64; 2] {
    match law {
        Some(law) if holds > slows => [slows + (holds - slows) * (1.0 - slip / law.length).max(0.0); 2],
        _ => [holds, slows],
    }
}

/// Whether a block that has been stuck for so long has its full strength again.
pub(crate) fn is_whole_again(law: Option<SlipWeakening>, stuck_for: f64) -> bool {
    law.and_then(|law| law.healing_time)
        .is_some_and(|time| stuck_for >= time)
}

/// The update of a block under `force`, the sum of all forces except friction. Friction is at most `holds`
/// while the block is stuck and `slows` while it slides.
pub(crate) fn update(law: FrictionLaw, motion: &Motion, force: Vector, holds: f64, slows: f64) -> Update {
    match law {
        FrictionLaw::Projection => projection(motion, force, holds, slows),
        FrictionLaw::Reversal => reversal(motion, force, holds, slows),
        FrictionLaw::Literal => literal(motion, force, holds, slows),
    }
}

/// A block that stays stuck: friction balances the other forces.
fn stuck(force: Vector) -> Update {
    Update {
        velocity: [0.0, 0.0],
        friction: times(-1.0, force),
    }
}

/// Moreau's time-stepping: kinetic friction subtracts `q = dt mu_k F_n/(m c_+)` from the velocity that the
/// block would have without it.
fn projection(motion: &Motion, force: Vector, holds: f64, slows: f64) -> Update {
    if motion.is_at_rest() && length(force) <= holds {
        return stuck(force);
    }
    let free = motion.accelerated(force);
    let most = motion.change_of_velocity(slows);
    if length(free) <= most {
        return stuck(force);
    }
    Update {
        velocity: times(1.0 - most / length(free), free),
        friction: times(-slows, unit(free)),
    }
}

/// Explicit friction along `-v`, and along minus the force for a block that starts; a block with a velocity
/// that reverses within the static threshold sticks.
fn reversal(motion: &Motion, force: Vector, holds: f64, slows: f64) -> Update {
    let starts = motion.is_at_rest();
    // D12: a block starts only if the force also exceeds kinetic friction.
    if starts && length(force) <= holds.max(slows) {
        return stuck(force);
    }
    let friction = times(-slows, unit(if starts { force } else { motion.velocity }));
    let velocity = motion.accelerated(sum(force, friction));
    let turns = dot(velocity, motion.velocity) <= 0.0;
    if !starts && turns && length(force) <= holds {
        return stuck(force);
    }
    Update { velocity, friction }
}

/// Eq. 4 as printed, except for the sign (D1): friction balances the forces below the threshold, at any
/// velocity.
fn literal(motion: &Motion, force: Vector, holds: f64, slows: f64) -> Update {
    let against = if motion.is_at_rest() {
        force
    } else {
        motion.velocity
    };
    let friction = if length(force) <= holds {
        times(-1.0, force)
    } else {
        times(-slows, unit(against))
    };
    Update {
        velocity: motion.accelerated(sum(force, friction)),
        friction,
    }
}
