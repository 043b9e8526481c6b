//! Forces between blocks: springs (Eq. 3) and the dampers in parallel with them.

use super::lattice::Spring;
use super::vector::{Vector, difference, dot, length, sum, times, unit};

/// Vector **r** = **d** + eps **e** along a spring with ends that have moved apart by **e** = u_j - u_i, in
/// blocks.
fn current(spring: &Spring, apart: Vector, epsilon: f64) -> Vector {
    sum(spring.rest, times(epsilon, apart))
}

/// Extension over the strain of the load, `(r - d)/eps = (2 d.e + eps e^2)/(r + d)`, without differences of
/// nearly equal lengths.
fn extension(spring: &Spring, apart: Vector, epsilon: f64) -> f64 {
    let (r, d) = (length(current(spring, apart, epsilon)), length(spring.rest));
    (2.0 * dot(spring.rest, apart) + epsilon * dot(apart, apart)) / (r + d)
}

/// Force of the springs on block `b` (Eq. 3): `F_c = sum_j k_ij (r_ij - d_ij) e_ij`.
pub(crate) fn elastic_force(b: usize, springs: &[Spring], displacements: &[Vector], epsilon: f64) -> Vector {
    let mut force = [0.0, 0.0];
    for spring in springs {
        let apart = difference(displacements[spring.to], displacements[b]);
        let tension = spring.stiffness * extension(spring, apart, epsilon);
        force = sum(force, times(tension, unit(current(spring, apart, epsilon))));
    }
    force
}

/// Force of the dampers on block `b`, for velocities half a step before:
/// `F_v = sum_j tau_v k_ij (e_ij . (v_j - v_i)) e_ij`.
pub(crate) fn damper_force(
    b: usize,
    springs: &[Spring],
    displacements: &[Vector],
    velocities: &[Vector],
    viscosity_time: f64,
    epsilon: f64,
) -> Vector {
    let mut force = [0.0, 0.0];
    for spring in springs {
        let apart = difference(displacements[spring.to], displacements[b]);
        let along = unit(current(spring, apart, epsilon));
        let rate = dot(along, difference(velocities[spring.to], velocities[b]));
        force = sum(force, times(viscosity_time * spring.stiffness * rate, along));
    }
    force
}

/// Energy of the springs of block `b`, half of each: `(1/2) sum_j (k_ij/2) (r_ij - d_ij)^2`.
pub(crate) fn elastic_energy(b: usize, springs: &[Spring], displacements: &[Vector], epsilon: f64) -> f64 {
    let mut energy = 0.0;
    for spring in springs {
        let apart = difference(displacements[spring.to], displacements[b]);
        energy += 0.25 * spring.stiffness * extension(spring, apart, epsilon).powi(2);
    }
    energy
}
