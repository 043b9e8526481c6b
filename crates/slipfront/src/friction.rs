//! The friction law with memory (Eq. 4, D1, D2), damping included, in its three readings.
//!
//! A law is given what a block feels at t_n and answers with the velocity half a step later, the friction
//! force and whether the block slides. The [`kernel`](crate::kernel) calls it once per block and step.

use serde::{Deserialize, Serialize};

use crate::Contact;
use crate::state::contact_of;
use crate::vector_field::{add, dot, length};

/// Which reading of Eq. 4 is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FrictionLaw {
    /// Implicit Coulomb friction with memory (Moreau's time-stepping). The one to use.
    Projection,
    /// Explicit friction against the velocity; a block sticks when it turns round. For comparison.
    Reversal,
    /// Eq. 4 as printed: no memory, and the sign of D1. For comparison.
    Literal,
}

/// A block at t_n, as its friction law sees it.
pub(crate) struct Block {
    /// Velocity at `t - dt/2`; its memory of sticking, as a block is stuck if and only if it is zero (D12).
    pub velocity: [f64; 2],
    /// `F_s + F_c`, and any constant force.
    pub force: [f64; 2],
    /// Static threshold `mu_s F_n`.
    pub hold: f64,
    /// Magnitude of kinetic friction `mu_k F_n`.
    pub slide: f64,
}

/// What the update that starts at t_n does with the block.
pub(crate) struct Update {
    /// Velocity at `t + dt/2`.
    pub velocity: [f64; 2],
    /// Friction force `F_f`; for a block that rests or stops, what balances the others.
    pub friction: [f64; 2],
    /// Stuck or sliding from t_n on.
    pub contact: Contact,
}

/// Time step and damping (Eq. 5), centred in time so that stability does not depend on it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Integrator {
    /// `c-/c+`, with `c-+ = 1 -+ Omega dt/2`: what a free block keeps of its velocity.
    pub(crate) keeps: f64,
    /// `dt/(m c+)`: what a force adds to it.
    pub(crate) impulse: f64,
    /// `m c+/dt`.
    pub(crate) inverse_impulse: f64,
}

impl Integrator {
    pub(crate) fn new(damping: f64, dt: f64) -> Self {
        let after = 1.0 + 0.5 * damping * dt;
        Self {
            keeps: (1.0 - 0.5 * damping * dt) / after,
            impulse: dt / after,
            inverse_impulse: after / dt,
        }
    }

    /// Velocity at `t + dt/2` under a force alone (Eqs. 5-8): `(c- v + dt F/m)/c+`.
    #[inline(always)]
    fn push(&self, velocity: [f64; 2], force: [f64; 2]) -> [f64; 2] {
        let one = |v: f64, f: f64| self.keeps * v + self.impulse * f;
        [one(velocity[0], force[0]), one(velocity[1], force[1])]
    }
}

/// One reading of the law.
pub(crate) trait Law {
    fn update(&self, block: &Block, integrator: &Integrator) -> Update;
}

/// At rest, or stopped: friction balances all other forces.
#[inline(always)]
fn at_rest(force: [f64; 2]) -> Update {
    Update {
        velocity: [0.0, 0.0],
        friction: [-force[0], -force[1]],
        contact: Contact::Stuck,
    }
}

/// Friction of magnitude `slide` against the direction of `motion`.
#[inline(always)]
fn against(motion: [f64; 2], slide: f64) -> [f64; 2] {
    let speed = length(motion);
    if speed > 0.0 {
        [-slide * motion[0] / speed, -slide * motion[1] / speed]
    } else {
        [0.0, 0.0]
    }
}

/// Moreau's time-stepping: the velocity that friction could at most take away, q, is taken from the velocity
/// that the block would have without it.
pub(crate) struct Projection;

impl Law for Projection {
    /// Every block takes the same path, and the outcome is selected: the loop over blocks has no branch.
    #[inline(always)]
    fn update(&self, block: &Block, integrator: &Integrator) -> Update {
        let force = block.force;
        let stays = is_zero(block.velocity) & (dot(force, force) <= block.hold * block.hold);
        let free = integrator.push(block.velocity, force);
        let speed = length(free);
        // Where nothing moves, both may be 0 and their ratio no number: nothing is left then either.
        let taken = integrator.impulse * block.slide / speed;
        let left = 1.0 - taken;
        let slides = !stays & (left > 0.0);
        let pull = taken * integrator.inverse_impulse;
        Update {
            velocity: select(slides, [left * free[0], left * free[1]], [0.0, 0.0]),
            friction: select(slides, [-pull * free[0], -pull * free[1]], [-force[0], -force[1]]),
            contact: if slides { Contact::Sliding } else { Contact::Stuck },
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

/// Explicit kinetic friction against the old velocity (the force's direction for a block that breaks loose).
pub(crate) struct Reversal;

impl Law for Reversal {
    #[inline(always)]
    fn update(&self, block: &Block, integrator: &Integrator) -> Update {
        let total = length(block.force);
        let starts = contact_of(block.velocity) == Contact::Stuck;
        if starts && total <= block.hold.max(block.slide) {
            return at_rest(block.force);
        }
        let friction = against(if starts { block.force } else { block.velocity }, block.slide);
        let velocity = integrator.push(block.velocity, add(block.force, friction));
        if !starts && dot(velocity, block.velocity) <= 0.0 && total <= block.hold {
            return at_rest(block.force);
        }
        Update {
            velocity,
            friction,
            contact: contact_of(velocity),
        }
    }
}

/// Eq. 4 to the letter: below the threshold friction balances the forces on a block even while it moves.
pub(crate) struct Literal;

impl Law for Literal {
    #[inline(always)]
    fn update(&self, block: &Block, integrator: &Integrator) -> Update {
        let starts = contact_of(block.velocity) == Contact::Stuck;
        let friction = if length(block.force) <= block.hold {
            [-block.force[0], -block.force[1]]
        } else {
            against(if starts { block.force } else { block.velocity }, block.slide)
        };
        let velocity = integrator.push(block.velocity, add(block.force, friction));
        Update {
            velocity,
            friction,
            contact: contact_of(velocity),
        }
    }
}
