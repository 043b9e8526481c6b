//! Newton's law with the damping (Eqs. 5 to 7), centred in time, over one step of leapfrog (Eq. 8, D6).

use super::vector::{Vector, sum, times};

/// Motion of a block at t_n, and the parameters that determine the change of its velocity.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    /// Velocity half a step before t_n.
    pub(crate) velocity: Vector,
    /// Mass `m`.
    pub(crate) mass: f64,
    /// Damping `Omega` (Eq. 5).
    pub(crate) damping: f64,
    /// Time step.
    pub(crate) dt: f64,
}

/// Outcome of a step for a block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Update {
    /// Velocity half a step after t_n.
    pub(crate) velocity: Vector,
    /// Friction `F_f` at t_n.
    pub(crate) friction: Vector,
}

impl Motion {
    /// Whether the block is stuck: it slides if and only if it moves.
    pub(crate) fn is_at_rest(&self) -> bool {
        self.velocity == [0.0, 0.0]
    }

    /// Factor `c_+ = 1 + Omega dt/2`.
    fn c_plus(&self) -> f64 {
        1.0 + 0.5 * self.damping * self.dt
    }

    /// Factor `c_- = 1 - Omega dt/2`.
    fn c_minus(&self) -> f64 {
        1.0 - 0.5 * self.damping * self.dt
    }

    /// Change of velocity by a force in a step, `dt F/(m c_+)`.
    pub(crate) fn change_of_velocity(&self, force: f64) -> f64 {
        self.dt * force / (self.mass * self.c_plus())
    }

    /// Velocity half a step after t_n under a force, `(c_- v + dt F/m)/c_+`.
    pub(crate) fn accelerated(&self, force: Vector) -> Vector {
        let gained = times(self.dt / self.mass, force);
        times(
            1.0 / self.c_plus(),
            sum(times(self.c_minus(), self.velocity), gained),
        )
    }
}
