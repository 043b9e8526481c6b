//! Dampers in parallel with the springs between blocks.

use std::f64::consts::TAU;

use slipfront::exact_solutions::{lagged_decay_rate, lattice_waves, oscillation_growth, viscous_decay_rate};
use slipfront::lattice::K_DRIVE;
use slipfront::observe::{Curve, Scheduled};
use slipfront::{
    Drive, Edges, FrictionLaw, Lattice, Model, Slider, State, Stop, Surface, VectorField, scales,
};
use test_case::test_matrix;

use crate::common::{self, at_rest, from_state, thrown, varied};

/// A lattice without friction and with dampers.
fn floating(nx: usize, ny: usize, omega_star: f64, k_drive: f64, epsilon: f64, slider: Slider) -> Model {
    let edges = if slider.outline.is_some() {
        Edges::Free
    } else {
        Edges::Periodic
    };
    let lattice = Lattice::with_edges(nx, ny, [edges; 2]);
    let drive = Drive {
        k_drive,
        ..Drive::along_x(0.0)
    };
    let surface = Surface::uniform(&lattice, 0.0, 0.0);
    let damping = scales::damping(omega_star);
    Model::new(lattice, surface, drive, damping, epsilon, FrictionLaw::Projection).with_slider(slider)
}

fn damped(viscosity_time: f64) -> Slider {
    Slider {
        viscosity_time,
        ..Slider::default()
    }
}

/// Amplitude after each step of the standing wave of this mode, from 1 with a velocity of 0 half a step
/// before.
fn amplitudes(
    mode: (u32, u32),
    branch: usize,
    omega_star: f64,
    time: f64,
    dt: f64,
    steps: usize,
) -> (f64, Vec<f64>) {
    let model = floating(12, 8, omega_star, K_DRIVE, 0.0, damped(time));
    let (a, b) = (TAU * f64::from(mode.0) / 12.0, TAU * f64::from(mode.1) / 8.0);
    let wave = lattice_waves(a, b, K_DRIVE)[branch];
    let mut state = State::at_rest(96);
    for block in 0..96 {
        let (i, j) = model.lattice.column_row(block);
        let phase = (a * i as f64 + b * j as f64 + 0.3).cos();
        state.displacement.x[block] = wave.polarization[0] * phase;
        state.displacement.y[block] = wave.polarization[1] * phase;
    }
    let shape = state.displacement.clone();
    let inner = |u: &VectorField| -> f64 { (0..96).map(|b| u.x[b] * shape.x[b] + u.y[b] * shape.y[b]).sum() };
    let norm = inner(&shape);
    let mut simulation = from_state(&model, dt, state);
    let mut next = || {
        simulation.step();
        inner(&simulation.state().displacement) / norm
    };
    (wave.omega_squared, (0..steps).map(|_| next()).collect())
}

/// The amplitude obeys (1 + g) u+ - (2 - w^2 dt^2 - c) u + (1 - g - c) u- = 0 with g = Omega dt/2 and
/// c = tau_v (w^2 - k_s) dt: only rounding errors remain, 1e-12 in 500 steps.
#[test_matrix([(1, 0), (2, 1), (6, 4)], [0, 1], [0.0, 0.1, 1.0], [0.05, 0.365])]
fn a_mode_obeys_the_scheme(mode: (u32, u32), branch: usize, omega_star: f64, time: f64) {
    let dt = 0.2;
    let (omega_squared, found) = amplitudes(mode, branch, omega_star, time, dt, 500);
    let g = 0.5 * scales::damping(omega_star) * dt;
    let c = time * (omega_squared - K_DRIVE) * dt;
    // At rest half a step before, so that the amplitude was the same a step before.
    let (mut before, mut now) = (1.0, 1.0);
    for amplitude in found {
        let next = ((2.0 - omega_squared * dt * dt - c) * now - (1.0 - g - c) * before) / (1.0 + g);
        (before, now) = (now, next);
        assert!((amplitude - now).abs() < 1e-12, "{amplitude}, exactly {now}");
    }
}

/// The decay rate is exactly that of the lagged force, which is of first order in the step. The rate is
/// computed from amplitudes about a radian apart, so that it is as exact as they are: 1e-12.
#[test_matrix([(1, 0), (2, 1), (6, 4)], [0, 1])]
fn modes_decay_at_their_rate(mode: (u32, u32), branch: usize) {
    let time = 0.1;
    let error = |dt: f64| {
        let apart = (0.5 / dt) as usize;
        let (omega_squared, found) = amplitudes(mode, branch, 0.0, time, dt, 3 * apart + 1);
        let rate = -oscillation_growth([0, 1, 2, 3].map(|k| found[k * apart]), apart as f64 * dt);
        let lagged = lagged_decay_rate(omega_squared, time, dt);
        assert!((rate - lagged).abs() < 1e-11, "{rate}, exactly {lagged}");
        rate / viscous_decay_rate(omega_squared, 0.0, time) - 1.0
    };
    let [coarse, fine] = [0.01, 0.005].map(error);
    // The next term of the expansion is gamma dt of the first, below 0.5 %.
    let order = (coarse / fine).log2();
    assert!((order - 1.0).abs() < 0.01, "order {order}");
}

/// With both dampings, the rate in the limit of small steps is half the sum of both. The step of 1e-3 leaves
/// an error of first order, gamma dt/2 < 2e-4.
#[test]
fn both_dampings_add() {
    let (dt, time, omega_star) = (1e-3, 0.05, 0.2);
    let (omega_squared, found) = amplitudes((2, 1), 1, omega_star, time, dt, 4000);
    let rate = -oscillation_growth([999, 1999, 2999, 3999].map(|k| found[k]), 1000.0 * dt);
    let exact = viscous_decay_rate(omega_squared, scales::damping(omega_star), time);
    assert!((rate / exact - 1.0).abs() < 2e-4, "{rate}, exactly {exact}");
}

/// Dampers act in pairs: the momentum of a slider without external forces is conserved. It changes only by
/// the rounding of sums over 120 blocks and 400 steps.
#[test_matrix([0.0, 0.02], [false, true])]
fn momentum_is_conserved(epsilon: f64, has_outline: bool) {
    let slider = Slider {
        viscosity_time: 0.2,
        ..varied(120, has_outline)
    };
    let exists: Vec<bool> = (0..120).map(|b| slider.exists(b)).collect();
    let masses: Vec<f64> = (0..120).map(|b| slider.mass(b)).collect();
    let model = floating(12, 10, 0.0, 0.0, epsilon, slider);
    let mut state = thrown(120, 0.3, 1);
    for (b, exists) in exists.iter().enumerate() {
        if !exists {
            for field in [&mut state.displacement, &mut state.velocity] {
                (field.x[b], field.y[b]) = (0.0, 0.0);
            }
        }
    }
    let momentum = |state: &State| {
        [&state.velocity.x, &state.velocity.y].map(|v| -> f64 { (0..120).map(|b| masses[b] * v[b]).sum() })
    };
    let before = momentum(&state);
    let mut simulation = from_state(&model, 0.1, state);
    for _ in 0..400 {
        simulation.step();
    }
    let after = momentum(&simulation.state());
    for axis in 0..2 {
        assert!(
            (after[axis] - before[axis]).abs() < 1e-12,
            "{before:?}, {after:?}"
        );
    }
}

/// All blocks move equally, to the last bit: with exactly represented numbers no difference of velocities is
/// rounded.
#[test]
fn a_rigid_translation_feels_nothing() {
    let run = |time: f64| {
        let mut state = State::at_rest(96);
        state.velocity.x.fill(0.5);
        state.velocity.y.fill(-0.25);
        // The general kernel computes both.
        let slider = Slider {
            density: Some(vec![1.0; 96]),
            ..damped(time)
        };
        let model = floating(12, 8, 0.1, K_DRIVE, 1e-3, slider);
        let mut simulation = from_state(&model, 0.125, state);
        (0..300).for_each(|_| simulation.step());
        assert!(simulation.snapshot().totals.velocity_square > 0.0);
        simulation.state()
    };
    assert_eq!(run(0.0), run(0.3));
}

/// Without friction, the energy stored at the start is still stored, or lost to one of the two dampings.
/// Kinetic energy is the mean of two half steps, so that the missing energy is dt^2/4 times the difference of
/// sum F^2/m: of second order, at any time.
#[test]
fn dampers_take_what_is_missing() {
    let worst = |dt: f64| {
        let slider = Slider {
            viscosity_time: 0.2,
            ..varied(120, false)
        };
        let model = floating(12, 10, 0.05, K_DRIVE, 0.0, slider);
        let mut curve = Curve::every(1);
        from_state(&model, dt, thrown(120, 0.3, 1))
            .run(
                Stop::at_step((200.0 / dt) as u64),
                &mut [Scheduled::always(&mut curve)],
            )
            .unwrap();
        let last = curve.rows.last().unwrap().energies;
        assert!(last.viscous_loss > 0.5 * last.stored_at_start);
        assert!(last.damping_loss > 0.01 * last.stored_at_start);
        let errors = curve.rows.iter().map(|row| row.energies.error().abs());
        errors.fold(0.0, f64::max)
    };
    let [coarse, fine] = [0.02, 0.01].map(worst);
    // The next term is at most omega dt = 0.07 of the first.
    let order = (coarse / fine).log2();
    assert!((order - 2.0).abs() < 0.1, "{coarse}, {fine}: order {order}");
    assert!(fine < 1e-4);
}

/// The balance closes through onset and far beyond, as without dampers: it misses the kinetic energy of the
/// last step of a slip.
#[test]
fn the_ledger_closes_with_friction() {
    let slider = common::Slider {
        blocks: [12, 14],
        body: damped(0.365),
        dt_star: 0.02,
        ..common::Slider::default()
    };
    let mut curve = Curve::every(1);
    at_rest(&slider.model(), slider.dt_star)
        .run(
            Stop::at_step(slider.steps(8.0)),
            &mut [Scheduled::always(&mut curve)],
        )
        .unwrap();
    let late = curve.rows.iter().skip(curve.rows.len() / 4);
    let worst = late.map(|row| row.energies.error().abs()).fold(0.0, f64::max);
    assert!(worst < 5e-5, "closes to {worst}");
    assert!(curve.rows.last().unwrap().energies.viscous_loss > 0.0);
}
