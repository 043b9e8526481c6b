//! The step of a velocity under forces and damping.

/// Least component of a velocity, 2^-480 of its unit. Smaller ones become zero with their sign, so that
/// mirrored problems keep mirrored bits.
///
/// Ahead of a wave that runs into a large cavity, velocities after n steps are about `(dt^2/n^2)^n` at n
/// blocks. From a hundred blocks on, these and their squares would be subnormal numbers, which processors
/// compute slowly. Squares of the remaining velocities, and their products with small strains, are normal
/// numbers, and the zeroed velocities are too small to change sums over blocks.
pub const SMALLEST_VELOCITY: f64 = f64::from_bits((1023 - 480) << 52);

/// Time step and damping (Eq. 5). Damping is centred in time, so that stability does not depend on it.
#[derive(Clone, Copy, Debug)]
pub struct Integrator {
    /// Factor by which damping reduces the velocity in a step, `c-/c+`, with `c-+ = 1 -+ Omega dt/2`.
    pub velocity_decay: f64,
    /// Change of velocity per force, `dt/(m c+)`.
    pub force_to_velocity: f64,
    /// Force per change of velocity, `m c+/dt`.
    pub velocity_to_force: f64,
}

impl Integrator {
    /// Steps of `dt` under damping `Omega`.
    pub fn new(damping: f64, dt: f64) -> Self {
        let after = 1.0 + 0.5 * damping * dt;
        Self {
            velocity_decay: (1.0 - 0.5 * damping * dt) / after,
            force_to_velocity: dt / after,
            velocity_to_force: after / dt,
        }
    }

    /// Integrator of a block with another mass: damping is proportional to the mass.
    #[inline(always)]
    pub fn of_mass(self, mass: f64) -> Self {
        Self {
            force_to_velocity: self.force_to_velocity / mass,
            velocity_to_force: self.velocity_to_force * mass,
            ..self
        }
    }

    /// Velocity at `t + dt/2` under a force alone (Eqs. 5-8): `(c- v + dt F/m)/c+`, without components below
    /// [`SMALLEST_VELOCITY`].
    #[inline(always)]
    pub fn accelerate(&self, velocity: [f64; 2], force: [f64; 2]) -> [f64; 2] {
        let one = |v: f64, f: f64| {
            let after = self.velocity_decay * v + self.force_to_velocity * f;
            if after.abs() < SMALLEST_VELOCITY {
                0.0 * after
            } else {
                after
            }
        };
        [one(velocity[0], force[0]), one(velocity[1], force[1])]
    }
}
