//! Kinetic friction that falls with speed.

use slipfront::communicator::Alone;
use slipfront::exact_solutions::weakening_growth;
use slipfront::lattice::K_DRIVE;
use slipfront::{Coulomb, Drive, Friction, FrictionLaw, Lattice, Model, Surface, Weakening, scales};
use test_case::{test_case, test_matrix};

use crate::common::Slider;
use crate::growth::growth_of_disturbance;

fn weakening(law: Weakening) -> Friction {
    Friction::Coulomb(Coulomb {
        weakening: Some(law),
        ..FrictionLaw::Projection.into()
    })
}

const LAW: Weakening = Weakening {
    critical_speed: 0.1,
    ratio: 0.4,
};

/// Growth rate of a small disturbance of steady sliding at `v`, of blocks that move as a rigid body.
fn measured_growth(v: f64, damping: f64, dt: f64) -> f64 {
    let lattice = Lattice::free(2, 2);
    let surface = Surface::uniform(&lattice, 1.0, 0.5);
    let model = Model::new(lattice, surface, Drive::along_x(v), damping, 0.0, weakening(LAW));
    growth_of_disturbance(&model, dt, [0.0, 2.4])
}

/// Friction is taken at the speed half a step before, F(v - dt v'/2), as if the mass were m - (dF/dv) dt/2:
/// the rate is smaller by this share, and half the step leaves half the error, to terms of the next order (a
/// fifth of the share, 10 % of the ratio). The test covers both sides of dF/dv + Omega = 0.
#[test_case(0.2, 0.0)]
#[test_case(0.2, 0.2)]
#[test_case(0.2, 0.4)]
#[test_case(0.05, 1.3)]
#[test_case(0.05, 1.5)]
fn disturbances_of_steady_sliding_grow_as_the_eigenvalue_says(v: f64, damping: f64) {
    let exact = weakening_growth(&LAW, 0.5, v, K_DRIVE, damping);
    let [coarse, fine] = [0.04, 0.02].map(|dt| measured_growth(v, damping, dt) - exact);
    let slope = -0.5 * 0.6 * 0.1 / (0.1 + v).powi(2);
    assert!(
        fine.abs() < 1.2 * 0.5 * -slope * 0.02 * exact.abs(),
        "{exact} {fine}"
    );
    assert!((coarse / fine - 2.0).abs() < 0.2, "{coarse} {fine}");
    assert_eq!(exact > 0.0, slope + damping < 0.0);
}

/// With strong damping all blocks keep sliding at the level of the law at V*; adhesion does not weaken.
#[test_matrix([0.0, 0.3])]
fn strong_damping_ends_at_the_level_of_the_law(adhesion: f64) {
    let mut slider = Slider {
        blocks: [12, 9],
        omega_star: 6.0,
        v_star: 0.1,
        ..Slider::default()
    };
    slider.adhesion.of_kinetic = adhesion;
    let mut model = slider.model();
    model.friction = weakening(LAW);
    let surface = &model.surface;
    let n = surface.n_blocks();
    let mean = (0..n).map(|b| surface.mu_kinetic[b]).sum::<f64>() / n as f64;
    // mu_k(V*) = mu_k (0.4 + 0.6/2).
    let exact = 0.7 * mean + adhesion + scales::damping(6.0) * 0.1;
    assert!((model.steady_level(&Alone) - exact).abs() < 1e-14);
    let mut simulation = crate::common::at_rest(&model, 0.1);
    slider.watch(&mut simulation, 40.0, &mut []);
    let now = simulation.snapshot();
    assert!(
        (now.point.mu_star - exact).abs() < 1e-9,
        "{} {exact}",
        now.point.mu_star
    );
    assert_eq!(now.point.sliding_percent, 100.0);
}
