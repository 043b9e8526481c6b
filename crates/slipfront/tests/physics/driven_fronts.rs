//! Slip fronts in a chain of blocks with drive springs, under constant far ends.

use slipfront::lattice::K_STRAIGHT;
use slipfront::{DeadLoad, Drive, FrictionLaw, Lattice, Model, State, Stop, Surface};
use test_case::test_matrix;

use crate::common::from_state;

const BLOCKS: usize = 200;
const KINETIC: f64 = 0.5;

/// A chain under the prestress `tau = (F - mu_k)/(mu_s - mu_k)`, with drive springs of `kappa` times its own
/// stiffness.
fn chain(kappa: f64, tau: f64) -> Model {
    let lattice = Lattice::free(BLOCKS, 1);
    let drive = Drive {
        k_drive: kappa * K_STRAIGHT,
        ..Drive::along_x(0.0)
    };
    let surface = Surface::uniform(&lattice, 1.0, KINETIC);
    let force = [KINETIC + tau * (1.0 - KINETIC), 0.0];
    Model::new(lattice, surface, drive, 0.0, 0.0, FrictionLaw::Projection)
        .with_dead_load(DeadLoad::uniform(force))
}

/// The drive spring of a block pulls it back by `k_s s` after a slip of `s`: fronts are slower than without
/// drive springs, and under a low prestress slower than sound. No closed form is known. The reference speeds
/// come from an independent integration of the same chain, to all digits given. A front takes a whole number
/// of steps from block to block, hence half a step more.
#[test_matrix(
    [
        (1.0 / 3.0, 0.3, 0.9025), (1.0 / 3.0, 0.4, 1.006), (1.0 / 3.0, 0.5, 1.104), (1.0 / 3.0, 0.6, 1.218),
        (1.0 / 3.0, 0.7, 1.379), (1.0 / 3.0, 0.8, 1.654), (1.0 / 3.0, 0.9, 2.283), (1.0, 0.4, 0.801),
        (1.0, 0.5, 0.984), (1.0, 0.6, 1.144), (1.0, 0.7, 1.333), (1.0, 0.8, 1.626), (1.0, 0.9, 2.273)
    ]
)]
fn drive_springs_slow_fronts_down((kappa, tau, expected): (f64, f64, f64)) {
    let dt = 2e-3;
    let sound = K_STRAIGHT.sqrt();
    let mut state = State::at_rest(BLOCKS);
    state.velocity.x[..5].fill(0.5 * sound * (1.0 - KINETIC) / K_STRAIGHT);
    let mut simulation = from_state(&chain(kappa, tau), dt, state);
    let duration = 1.3 * BLOCKS as f64 / (expected * sound);
    simulation
        .run(Stop::at_step((duration / dt) as u64), &mut [])
        .unwrap();
    let first = simulation.snapshot().first_slip_time_star();
    let (from, to) = (BLOCKS / 2, BLOCKS - 20);
    let delay = (first[to] - first[from]) / (to - from) as f64;
    let found = 1.0 / (delay * sound);
    let digits = if expected == 0.9025 { 5e-5 } else { 5e-4 };
    assert!(
        (found - expected).abs() < digits + 0.5 * dt / delay * expected,
        "{found}, expected {expected}"
    );
}

/// Without drive springs the speed has the closed form `v = c/sqrt(1 - tau^2)`, which the speed of this chain
/// approaches as they soften.
#[test_matrix([0.6, 0.8])]
fn soft_drive_springs_change_little(tau: f64) {
    let speeds = [1e-4, 0.0].map(|kappa| {
        let mut state = State::at_rest(BLOCKS);
        state.velocity.x[..5].fill(0.3);
        let mut simulation = from_state(&chain(kappa, tau), 0.01, state);
        simulation.run(Stop::at_step(25_000), &mut []).unwrap();
        let first = simulation.snapshot().first_slip_time_star();
        80.0 / (first[180] - first[100]) / K_STRAIGHT.sqrt()
    });
    assert!((speeds[0] / speeds[1] - 1.0).abs() < 1e-2, "{speeds:?}");
}
