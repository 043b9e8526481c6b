//! Orders of convergence in the time step, asserted: 2 where the motion is smooth, 1 where blocks start and
//! stop.

use slipfront::exact_solutions::SlipCycle;
use slipfront::{Drive, Edges, FrictionLaw, Lattice, Model, Simulation, State, Surface, VectorField, scales};
use test_case::test_matrix;

use crate::common::{Slider, at_rest, from_state};

/// Slope of log(error) against log(step) by least squares: the order.
fn order(steps: &[f64], errors: &[f64]) -> f64 {
    let (x, y) = (logs(steps), logs(errors));
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let (mx, my) = (mean(&x), mean(&y));
    let covariance: f64 = x.iter().zip(&y).map(|(x, y)| (x - mx) * (y - my)).sum();
    covariance / x.iter().map(|x| (x - mx).powi(2)).sum::<f64>()
}

fn logs(v: &[f64]) -> Vec<f64> {
    v.iter().map(|v| v.ln()).collect()
}

fn assert_order(steps: &[f64], errors: &[f64], expected: f64, tolerance: f64) {
    let found = order(steps, errors);
    assert!(
        (found - expected).abs() < tolerance,
        "order {found:.3}, expected {expected}; errors {errors:?} at steps {steps:?}"
    );
    println!("order {found:.3} of {expected}; errors {errors:?}");
}

/// Displacement and velocity at `time`, the velocity as the mean of the half steps around it, of a lattice
/// without friction that starts at rest from a bent shape.
fn smooth_motion(model: &Model, time: f64, steps: u32) -> (VectorField, VectorField) {
    let dt = time / f64::from(steps);
    let n = model.lattice.n_blocks();
    let wave = |k: f64, shift: f64| (0..n).map(|b| (k * (b * b) as f64 + shift).sin()).collect();
    let bent = VectorField {
        x: wave(0.37, 0.2),
        y: wave(0.91, 1.4),
    };
    // At rest at t = 0: the velocity half a step before is minus the velocity half a step after.
    let state = |velocity| State {
        displacement: bent.clone(),
        velocity,
    };
    let at_rest = from_state(model, dt, state(VectorField::zeros(n)));
    let before = |axis: usize| {
        let pull = |b| {
            let block = at_rest.snapshot().block(b);
            -0.5 * dt * (block.force_drive[axis] + block.force_lattice[axis])
        };
        (0..n).map(pull).collect::<Vec<_>>()
    };
    let velocity = VectorField {
        x: before(0),
        y: before(1),
    };
    let mut simulation = from_state(model, dt, state(velocity));
    for _ in 1..steps {
        simulation.step();
    }
    let before = simulation.state().velocity;
    simulation.step();
    let State {
        displacement,
        velocity: after,
    } = simulation.state();
    let mean = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| 0.5 * (a + b)).collect();
    let velocity = VectorField {
        x: mean(&before.x, &after.x),
        y: mean(&before.y, &after.y),
    };
    (displacement, velocity)
}

fn distance(a: &VectorField, b: &VectorField) -> f64 {
    let square: f64 =
        a.x.iter()
            .zip(&b.x)
            .chain(a.y.iter().zip(&b.y))
            .map(|(a, b)| (a - b).powi(2))
            .sum();
    square.sqrt()
}

/// Leapfrog with centred damping is of second order, springs bent by a strain of 0.2 included.
#[test_matrix([0.0, 0.3, 3.0], [0.0, 0.2])]
fn smooth_motion_is_of_second_order(omega_star: f64, epsilon: f64) {
    let lattice = Lattice::with_edges(6, 5, [Edges::Periodic, Edges::Free]);
    let model = Model::new(
        lattice,
        Surface::uniform(&lattice, 0.0, 0.0),
        Drive::at_angle(0.1, 30.0),
        scales::damping(omega_star),
        epsilon,
        FrictionLaw::Projection,
    );
    let time = 6.0;
    let (u, v) = smooth_motion(&model, time, 20_000);
    let counts = [60, 120, 240, 480];
    let steps = counts.map(|n| time / f64::from(n));
    let runs = counts.map(|n| smooth_motion(&model, time, n));
    assert_order(&steps, &runs.each_ref().map(|run| distance(&run.0, &u)), 2.0, 0.1);
    assert_order(&steps, &runs.each_ref().map(|run| distance(&run.1, &v)), 2.0, 0.1);
}

/// Numbers of the steps in which one block starts and stops its first slip.
fn first_slip(v_star: f64, dt_star: f64) -> (u64, u64) {
    let slider = Slider {
        blocks: [1, 1],
        v_star,
        dt_star,
        ..Slider::default().uniform()
    };
    let model = slider.model();
    let mut simulation = at_rest(&model, dt_star);
    let slides = |simulation: &Simulation| {
        assert!(simulation.time_star() * v_star < 8.0, "neither slips nor stops");
        simulation.snapshot().point.n_sliding > 0
    };
    while !slides(&simulation) {
        simulation.step();
    }
    let start = simulation.snapshot().step;
    while slides(&simulation) {
        simulation.step();
    }
    (start, simulation.snapshot().step)
}

/// Events occur at steps, so that the errors of their times are proportional to the step. They are averaged
/// over 300 phases of the first slip relative to the steps, by slightly different speeds: the error of this
/// mean is 0.6/sqrt(300) = 3 % of it.
#[test]
fn times_of_slip_and_stop_are_of_first_order() {
    let steps = [0.1, 0.05, 0.025, 0.0125, 0.00625];
    let speeds: Vec<f64> = (0..300)
        .map(|phase| 0.3 * (1.0 + 0.000_618 * f64::from(phase)))
        .collect();
    let mean = |error: &dyn Fn(f64, f64) -> f64| {
        steps.map(|dt| speeds.iter().map(|&v| error(v, dt)).sum::<f64>() / speeds.len() as f64)
    };
    let start = mean(&|v, dt| {
        (first_slip(v, dt).0 as f64 * dt - SlipCycle::new(0.1, 0.5, v).onset_time_star()).abs()
    });
    let duration = mean(&|v, dt| {
        let (start, stop) = first_slip(v, dt);
        ((stop - start) as f64 * dt - SlipCycle::new(0.1, 0.5, v).slip_duration()).abs()
    });
    let stop = mean(&|v, dt| {
        let exact = SlipCycle::new(0.1, 0.5, v);
        (first_slip(v, dt).1 as f64 * dt - exact.onset_time_star() - exact.slip_duration()).abs()
    });
    assert_order(&steps, &start, 1.0, 0.05);
    assert_order(&steps, &duration, 1.0, 0.05);
    assert_order(&steps, &stop, 1.0, 0.05);
}

/// Displacements of a small slider in the middle of its transition, when most blocks have slipped.
fn in_transition(seed: u64, steps: u32) -> VectorField {
    let slider = Slider {
        blocks: [5, 4],
        v_star: 0.1,
        sigma_static_star: 0.2,
        omega_star: 0.5,
        seed,
        dt_star: TRANSITION / f64::from(steps),
        ..Slider::default()
    };
    let model = slider.model();
    let mut simulation = at_rest(&model, slider.dt_star);
    for _ in 0..steps {
        simulation.step();
    }
    simulation.state().displacement
}

const TRANSITION: f64 = 27.0;

/// With friction whole trajectories are of first order, since blocks start and stop at steps. The median over
/// 24 surfaces is used: on some of them a slip that just happens with one time step does not happen with
/// another.
#[test]
fn motion_with_friction_is_of_first_order() {
    let counts = [270, 540, 1080, 2160];
    let steps = counts.map(|n| TRANSITION / f64::from(n));
    let exact: Vec<VectorField> = (0..24).map(|seed| in_transition(seed, 43_200)).collect();
    assert!(
        exact.iter().all(|u| u.x.iter().filter(|&&x| x > 0.0).count() > 4),
        "blocks have slipped"
    );
    let errors = counts.map(|n| {
        let mut found: Vec<f64> = (0..24)
            .map(|seed| distance(&in_transition(seed as u64, n), &exact[seed]))
            .collect();
        found.sort_by(f64::total_cmp);
        0.5 * (found[11] + found[12])
    });
    assert_order(&steps, &errors, 1.0, 0.15);
}

/// The error of the energy balance: in the last step of every slip the block loses at most (mu_k F_n dt)^2/2,
/// so that the error is of second order although the times of the events are of first.
#[test]
fn energy_closes_to_second_order() {
    let steps = [0.1, 0.05, 0.025, 0.0125];
    let errors = steps.map(|dt_star| {
        let mean = |seed: u64| {
            let slider = Slider {
                blocks: [8, 8],
                seed,
                dt_star,
                v_star: 0.1,
                ..Slider::default()
            };
            slider.run(8.0).rows.last().unwrap().energies.error().abs()
        };
        (1..=6).map(mean).sum::<f64>() / 6.0
    });
    assert_order(&steps, &errors, 2.0, 0.15);
}
