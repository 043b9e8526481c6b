//! Scale invariance: at equal groups V*, R*, Omega*, sigma* the dimensional quantities do not matter (Eqs.
//! 11, 12), except for the strain of the load eps = P mu_s/E, which makes the springs slightly nonlinear.

use slipfront::surface::{Coefficients, Distribution, Load};
use slipfront::{Drive, FrictionLaw, Lattice, Model, Scales, Surface, scales};
use test_case::test_matrix;

use crate::common::at_rest;

const SLIDERS: [Scales; 4] = [
    // Cases 8 and 1 of Table 1, and two of other materials, block sizes and coefficients.
    Scales {
        block_size: 1e-6,
        thickness: 1e-6,
        contact_width: 1e-6,
        young_modulus: 100e9,
        density: 10e3,
        pressure: 100e3,
        mu_static_mean: 1.0,
    },
    Scales {
        block_size: 1e-6,
        thickness: 1e-6,
        contact_width: 1e-6,
        young_modulus: 100e6,
        density: 1e3,
        pressure: 1e3,
        mu_static_mean: 0.1,
    },
    Scales {
        block_size: 3e-3,
        thickness: 3e-3,
        contact_width: 3e-3,
        young_modulus: 2.1e11,
        density: 7.8e3,
        pressure: 1e6,
        mu_static_mean: 0.3,
    },
    Scales {
        block_size: 0.2,
        thickness: 0.2,
        contact_width: 0.2,
        young_modulus: 1e7,
        density: 950.0,
        pressure: 100.0,
        mu_static_mean: 0.9,
    },
];

/// A rigid slider of thickness `h` on a mount of stiffness `K` per area oscillates with `sqrt(K/(rho h))`, at
/// any size of its blocks.
#[test]
fn a_mount_sets_a_frequency_that_no_block_does() {
    let (thickness, per_area) = (2e-3, 1e13);
    for block_size in [1e-6, 2e-5, 1e-3] {
        for scales in SLIDERS {
            let scales = Scales {
                block_size,
                thickness,
                contact_width: block_size,
                ..scales
            };
            let frequency = scales.stiffness_of_area(per_area).sqrt() / scales.time();
            let exact = (per_area / (scales.density * thickness)).sqrt();
            // Some rounding errors.
            assert!(
                (frequency / exact - 1.0).abs() < 1e-14,
                "{frequency}, exact {exact}"
            );
        }
    }
}

/// A slider of 16 x 16 blocks given in SI: speed and damping rate chosen so that V* = 0.03 and Omega* = 0.1.
fn model(scales: &Scales, epsilon: f64) -> Model {
    let lattice = Lattice::free(16, 16);
    let speed = 0.03 * scales.speed();
    let damping_rate = scales.damping_rate(0.1);
    let gauss = |mean: f64| Distribution {
        mean,
        deviation: 0.05 * mean,
    };
    let mean = scales.mu_static_mean;
    let drawn = Coefficients::draw(256, gauss(mean), gauss(0.5 * mean), 4);
    let surface = Surface::new(drawn, vec![false; 256], Load::Redistributed, mean).unwrap();
    Model::new(
        lattice,
        surface,
        Drive::at_angle(speed / scales.speed(), 20.0),
        scales::damping(scales.omega_star(damping_rate)),
        epsilon,
        FrictionLaw::Projection,
    )
}

/// Largest difference of mu* between two sliders up to a little past the peak of the first.
fn difference(one: &Model, other: &Model) -> f64 {
    let dt = 0.1;
    let (mut one, mut other) = (at_rest(one, dt), at_rest(other, dt));
    let mut largest = 0.0_f64;
    while !one.peak().ended {
        assert!(one.time_star() < 200.0, "no transition");
        one.step();
        other.step();
        largest = largest.max((one.snapshot().point.mu_star - other.snapshot().point.mu_star).abs());
    }
    assert!(one.time_star() > 70.0);
    largest
}

/// With linear springs (eps = 0) only the rounding of the conversions differs, 1e-16 each, which does not
/// shift any event by a step.
#[test_matrix([1, 2, 3])]
fn without_strain_the_groups_alone_decide(slider: usize) {
    let found = difference(&model(&SLIDERS[0], 0.0), &model(&SLIDERS[slider], 0.0));
    assert!(found < 1e-12, "{found}");
}

/// Sliders with different strains, from 1e-6 to 9e-6, agree to first order in the strain. The stretch between
/// neighbours, e = 0.1 to 1, changes the force of a spring by eps e^2, and mu* by the mean of this over
/// slipping and stuck blocks: 1e-4 eps here, bounded by 1e-3 of the strain.
#[test_matrix([1, 2, 3])]
fn a_small_strain_changes_little(slider: usize) {
    let (one, other) = (&SLIDERS[0], &SLIDERS[slider]);
    let found = difference(&model(one, one.epsilon()), &model(other, other.epsilon()));
    let strain = one.epsilon().max(other.epsilon());
    assert!(found < 1e-3 * strain, "{found} at strain {strain}");
}

/// The difference is proportional to the strain: for a strain of 1e-9 it is a thousandth of that for 1e-6.
#[test]
fn the_change_is_of_first_order_in_the_strain() {
    let linear = model(&SLIDERS[0], 0.0);
    let found = [1e-4, 1e-6, 1e-8].map(|epsilon| difference(&linear, &model(&SLIDERS[0], epsilon)) / epsilon);
    // Discrete events (who slips at which step) do not change at such strains; the rest is smooth.
    assert!(
        (found[1] / found[2] - 1.0).abs() < 0.05 && (found[0] / found[1] - 1.0).abs() < 0.2,
        "{found:?}"
    );
}

/// Units of case 8 in SI, computed by hand: E = 1e11, rho = 1e4, P = 1e5, mu_s = 1, l = 1e-6.
#[test]
fn units_of_case_8() {
    let case8 = &SLIDERS[0];
    let close = |found: f64, exact: f64| assert!((found / exact - 1.0).abs() < 1e-14, "{found} {exact}");
    close(case8.epsilon(), 1e-6);
    close(case8.displacement(), 1e-12);
    close(case8.stress(), 1e5);
    close(case8.time(), 1e-6 * 1e-7_f64.sqrt());
    close(case8.energy(), 1e5 * 1e-12 * 1e-12);
    // Omega* = Omega sqrt(m/k_1): k_1 = (3/4) E l = 7.5e4, m = rho l^3 = 1e-14.
    close(case8.omega_star(1e9), 1e9 * (1e-14_f64 / 7.5e4).sqrt());
}

/// Units agree with each other: speed is displacement over time, energy is mass times its square.
#[test]
fn units_agree_with_each_other() {
    for scales in &SLIDERS {
        let close = |found: f64, exact: f64| assert!((found / exact - 1.0).abs() < 1e-14, "{found} {exact}");
        close(scales.speed(), scales.displacement() / scales.time());
        let mass = scales.density * scales.block_size.powi(3);
        close(scales.energy(), mass * scales.speed().powi(2));
        close(scales.damping_rate(scales.omega_star(123.0)), 123.0);
    }
}
