//! The friction law with memory (Eq. 4, D1, D2), damping included, in its three readings.
//!
//! From the velocity of a block, the forces on it and its thresholds at t_n, a law finds the velocity half a
//! step later, the friction force and whether the block slides. The general kernel calls it once per block
//! and step.

use serde::{Deserialize, Serialize};

use crate::vector_field::{add, dot, length};
use slipfront_kernel::Integrator;

/// Reading of Eq. 4.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FrictionLaw {
    /// Implicit Coulomb friction with memory (Moreau's time-stepping). The default.
    Projection,
    /// Explicit friction against the velocity; a block sticks when its velocity reverses. For comparison.
    Reversal,
    /// Eq. 4 as printed: no memory, and the sign of D1. For comparison.
    Literal,
}

/// State of a block at t_n that a friction law reads.
pub(crate) struct BlockState {
    /// Velocity at `t - dt/2`, which is zero if and only if the block is stuck (D12).
    pub velocity: [f64; 2],
    /// Force of the springs, `F_s + F_c`, with any constant force.
    pub force: [f64; 2],
    /// Static threshold `mu_s F_n`.
    pub static_limit: f64,
    /// Magnitude of kinetic friction `mu_k F_n`.
    pub kinetic_force: f64,
}

/// Outcome of the update of a block that starts at t_n.
pub(crate) struct Update {
    /// Velocity at `t + dt/2`.
    pub velocity: [f64; 2],
    /// Friction force `F_f`; for a block that sticks, minus the sum of the other forces.
    pub friction: [f64; 2],
    /// Whether the block slides from t_n on.
    pub slides: bool,
}

/// One reading of Eq. 4.
pub(crate) trait LawReading {
    /// The update that starts at t_n.
    fn update(&self, block: &BlockState, integrator: &Integrator) -> Update;
}

/// Friction of magnitude `kinetic_force` against the direction of `motion`.
#[inline(always)]
fn friction_against(motion: [f64; 2], kinetic_force: f64) -> [f64; 2] {
    let speed = length(motion);
    let component = |component: f64| {
        let friction = -kinetic_force * component / speed;
        if speed > 0.0 { friction } else { 0.0 }
    };
    [component(motion[0]), component(motion[1])]
}

/// Moreau's time-stepping: friction reduces the velocity that the block would have without it by
/// `q = mu_k F_n dt/(m c+)`, and to zero at most.
pub(crate) struct Projection;

impl LawReading for Projection {
    /// The update of [`Projection`], without branches, so that the loop over blocks is vectorised.
    #[inline(always)]
    fn update(&self, block: &BlockState, integrator: &Integrator) -> Update {
        let force = block.force;
        let stays = is_zero(block.velocity) & (dot(force, force) <= block.static_limit * block.static_limit);
        let free = integrator.accelerate(block.velocity, force);
        let speed = length(free);
        // Fraction of the free velocity that friction removes. It is NaN if both are zero, and `slides` is
        // false then.
        let removed_fraction = integrator.force_to_velocity * block.kinetic_force / speed;
        let remaining = 1.0 - removed_fraction;
        let slides = !stays & (remaining > 0.0);
        let pull = removed_fraction * integrator.velocity_to_force;
        Update {
            velocity: select(slides, [remaining * free[0], remaining * free[1]], [0.0, 0.0]),
            friction: select(slides, [-pull * free[0], -pull * free[1]], [-force[0], -force[1]]),
            slides,
        }
    }
}

#[inline(always)]
fn is_zero(vector: [f64; 2]) -> bool {
    (vector[0] == 0.0) & (vector[1] == 0.0)
}

#[inline(always)]
fn select(first: bool, one: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    [
        if first { one[0] } else { other[0] },
        if first { one[1] } else { other[1] },
    ]
}

/// Explicit kinetic friction against the old velocity; against the force for a block that starts to slide.
pub(crate) struct Reversal;

impl LawReading for Reversal {
    /// The update of [`Reversal`], without branches, so that the loop over blocks is vectorised.
    #[inline(always)]
    fn update(&self, block: &BlockState, integrator: &Integrator) -> Update {
        let (force, total) = (block.force, length(block.force));
        let starts = is_zero(block.velocity);
        let friction = friction_against(select(starts, force, block.velocity), block.kinetic_force);
        let velocity = integrator.accelerate(block.velocity, add(force, friction));
        let stays = starts & (total <= block.static_limit.max(block.kinetic_force));
        let turns = !starts & (dot(velocity, block.velocity) <= 0.0) & (total <= block.static_limit);
        let sticks = stays | turns;
        Update {
            velocity: select(sticks, [0.0, 0.0], velocity),
            friction: select(sticks, [-force[0], -force[1]], friction),
            slides: !sticks & !is_zero(velocity),
        }
    }
}

/// Eq. 4 to the letter: below the threshold friction balances the forces on a block even while it moves.
pub(crate) struct Literal;

impl LawReading for Literal {
    /// The update of [`Literal`], without branches, so that the loop over blocks is vectorised.
    #[inline(always)]
    fn update(&self, block: &BlockState, integrator: &Integrator) -> Update {
        let (force, starts) = (block.force, is_zero(block.velocity));
        let kinetic = friction_against(select(starts, force, block.velocity), block.kinetic_force);
        let balances = length(force) <= block.static_limit;
        let friction = select(balances, [-force[0], -force[1]], kinetic);
        let velocity = integrator.accelerate(block.velocity, add(force, friction));
        Update {
            velocity,
            friction,
            slides: !is_zero(velocity),
        }
    }
}
