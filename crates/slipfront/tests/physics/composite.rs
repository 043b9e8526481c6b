//! Surfaces of two zones.

use slipfront::communicator::Alone;
use slipfront::exact_solutions::composite_peak;
use slipfront::surface::{Coefficients, Contact, Load};
use slipfront::{Drive, FrictionLaw, Lattice, Model, Outline, Slider, Stop, Surface, scales};
use test_case::test_matrix;

use crate::common::at_rest;

const V_STAR: f64 = 0.005;
const OMEGA_STAR: f64 = 1.5;
const DT_STAR: f64 = 0.1;

/// A slider of 10 x 10 blocks. The first `weak` rows have `mu_1`, the others `mu_2`; `apart`: blocks are not
/// joined by springs.
fn model(weak: usize, [mu_1, mu_2]: [f64; 2], r_star: f64, apart: bool) -> Model {
    let step = if apart { 2 } else { 1 };
    let size = 10 * step;
    let lattice = Lattice::free(size, size);
    let exists = (0..size * size).map(|b| (b % size).is_multiple_of(step) && (b / size).is_multiple_of(step));
    let slider = Slider::new(None, None, Some(Outline::new(exists.collect(), &Alone)), &Alone);
    let mu_static: Vec<f64> = (0..size * size)
        .map(|b| if b / size < weak * step { mu_1 } else { mu_2 })
        .collect();
    let mu_kinetic = mu_static.iter().map(|mu| r_star * mu).collect();
    let coefficients = Coefficients::given(mu_static, mu_kinetic);
    let contact = Contact::new(Load::Redistributed, 1.0);
    let surface =
        Surface::of_ranks(coefficients, vec![false; size * size], contact, &slider, &Alone).unwrap();
    let (drive, damping) = (Drive::along_x(V_STAR), scales::damping(OMEGA_STAR));
    let plain = Model::new(lattice, surface, drive, damping, 0.0, FrictionLaw::Projection);
    plain.with_slider(slider)
}

fn largest(model: &Model) -> f64 {
    let mut simulation = at_rest(model, DT_STAR);
    let steps = (6.0 / V_STAR / DT_STAR) as u64;
    simulation.run(Stop::at_step(steps), &mut []).unwrap();
    simulation.peak().largest.mu_star
}

/// The drag of the zone that slides already adds at most f Omega V*, and a slip is seen late by at most the
/// increase of the pull in one step.
#[test_matrix([2, 5, 8], [[0.5, 1.0], [0.8, 1.0], [0.3, 1.5]], [0.2, 0.6])]
fn the_largest_friction_of_zones_apart(weak: usize, mu: [f64; 2], r_star: f64) {
    let f = weak as f64 / 10.0;
    let exact = composite_peak(f, mu, r_star);
    let found = largest(&model(weak, mu, r_star, true));
    let (drag, pull) = (f * scales::damping(OMEGA_STAR) * V_STAR, 0.375 * V_STAR * DT_STAR);
    assert!(
        exact <= found + 1e-12 && found <= exact + drag + pull + 1e-12,
        "{found}, exactly {exact}"
    );
}

/// The sum of the thresholds of both zones is a bound that no slider reaches, joined or not.
#[test_matrix([false, true])]
fn no_slider_has_both_thresholds_at_once(apart: bool) {
    let (mu, r_star) = ([0.5, 1.0], 0.5);
    let found = largest(&model(5, mu, r_star, apart));
    assert!(found < 0.5 * mu[0] + 0.5 * mu[1] - 0.02, "{found}");
}
