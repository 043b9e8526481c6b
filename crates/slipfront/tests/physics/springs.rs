//! The spring law (Eq. 3): exact at any strain, without loss of digits at the smallest strains.

use slipfront::lattice::{Bond, K_DIAGONAL, K_STRAIGHT};
use test_case::test_matrix;

/// sqrt(1 + x) - 1 by its series; the difference of lengths would have no correct digit at eps = 1e-12.
fn extension_by_series(bond: &Bond, e: [f64; 2], epsilon: f64) -> f64 {
    let d = bond.rest_length;
    let along = bond.rest[0] * e[0] + bond.rest[1] * e[1];
    let x = epsilon * (2.0 * along + epsilon * (e[0] * e[0] + e[1] * e[1])) / (d * d);
    let x_over_eps = (2.0 * along + epsilon * (e[0] * e[0] + e[1] * e[1])) / (d * d);
    d * x_over_eps * (0.5 - x / 8.0 + x * x / 16.0)
}

#[test_matrix([0.0, 1e-15, 1e-12, 1e-9, 1e-6], [[0.3, -0.7], [1e-6, 2e-6], [0.0, 1.0], [5.0, 5.0]])]
fn tiny_strains_lose_nothing(epsilon: f64, e: [f64; 2]) {
    for bond in &Bond::ALL {
        let extension = extension_by_series(bond, e, epsilon);
        let [fx, fy] = bond.force(e, epsilon);
        let (rx, ry) = (bond.rest[0] + epsilon * e[0], bond.rest[1] + epsilon * e[1]);
        let length = rx.hypot(ry);
        let exact = [
            bond.stiffness * extension * rx / length,
            bond.stiffness * extension * ry / length,
        ];
        let scale = bond.stiffness * extension.abs() + 1e-300;
        assert!((fx - exact[0]).abs() <= 4e-16 * 4.0 * scale && (fy - exact[1]).abs() <= 4e-16 * 4.0 * scale);
        let energy = 0.5 * bond.stiffness * extension * extension;
        assert!((bond.energy(e, epsilon) - energy).abs() <= 4e-15 * energy);
    }
}

/// The force is the slope of the energy, at any strain.
#[test_matrix([0.0, 1e-6, 0.1, 0.4])]
fn forces_derive_from_the_energy(epsilon: f64) {
    let (e, h) = ([0.4, -0.9], 1e-5);
    for bond in &Bond::ALL {
        let slope = |dx: f64, dy: f64| {
            (bond.energy([e[0] + dx, e[1] + dy], epsilon) - bond.energy([e[0] - dx, e[1] - dy], epsilon))
                / (2.0 * h)
        };
        let [fx, fy] = bond.force(e, epsilon);
        assert!((fx - slope(h, 0.0)).abs() < 1e-9 && (fy - slope(0.0, h)).abs() < 1e-9);
    }
}

/// Rotation by any angle does not change the length of a spring: no force.
#[test_matrix([0.1, 1.0, 3.0])]
fn a_rotation_stretches_no_spring(angle: f64) {
    let (s, c) = f64::sin_cos(angle);
    for bond in &Bond::ALL {
        let [x, y] = bond.rest;
        let e = [c * x - s * y - x, s * x + c * y - y];
        let [fx, fy] = bond.force(e, 1.0);
        assert!(fx.abs() < 1e-15 && fy.abs() < 1e-15);
    }
}

#[test]
fn there_are_four_springs_per_block_of_the_paper_s_lengths_and_stiffnesses() {
    assert_eq!((K_STRAIGHT, K_DIAGONAL), (0.75, 0.375));
    for bond in &Bond::ALL {
        let [x, y] = bond.rest;
        assert_eq!(bond.offset, [x as isize, y as isize]);
        let straight = x * y == 0.0;
        assert_eq!(bond.stiffness, if straight { 0.75 } else { 0.375 });
        assert_eq!(
            bond.rest_length,
            if straight { 1.0 } else { std::f64::consts::SQRT_2 }
        );
    }
}
