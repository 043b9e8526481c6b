//! Static friction that grows while blocks are stuck.

use std::sync::Arc;

use slipfront::communicator::Alone;
use slipfront::exact_solutions::{StopOfSteadySliding, ageing_slip_time};
use slipfront::lattice::K_DRIVE;
use slipfront::surface::{Adhesion, Coefficients, Contact, Load};
use slipfront::{
    Ageing, Coulomb, Drive, Friction, FrictionLaw, Lattice, Model, Program, Simulation, State, Surface,
    VectorField, scales,
};
use test_case::test_matrix;

use crate::common::{at_rest, from_state};

const LAW: Ageing = Ageing {
    beta: 0.15,
    time: 3.0,
};
const V: f64 = 0.03;

/// Nine blocks that move as a rigid body.
fn model(law: Ageing, damping: f64, segments: &[(f64, f64)], adhesion: Adhesion) -> Model {
    let lattice = Lattice::free(3, 3);
    let coefficients = Coefficients::given(vec![1.0 - adhesion.of_static; 9], vec![0.5; 9]);
    let contact = Contact {
        adhesion,
        ..Contact::new(Load::Redistributed, 1.0)
    };
    let surface = Surface::of_ranks(
        coefficients,
        vec![false; 9],
        contact,
        &slipfront::Slider::default(),
        &Alone,
    )
    .unwrap();
    let drive = Drive {
        program: Some(Arc::new(Program::new(segments.iter().copied()))),
        ..Drive::along_x(V)
    };
    let friction = Friction::Coulomb(Coulomb {
        ageing: Some(law),
        ..FrictionLaw::Projection.into()
    });
    Model::new(lattice, surface, drive, damping, 0.0, friction)
}

/// Steps until all blocks begin to slide, and returns the time.
fn next_slip(simulation: &mut Simulation) -> f64 {
    loop {
        simulation.step();
        let now = simulation.snapshot();
        if now.point.n_sliding > 0 {
            assert_eq!(now.point.n_sliding, 9);
            return now.time_star;
        }
    }
}

fn advance_to(simulation: &mut Simulation, time_star: f64) {
    while simulation.time_star() < time_star - 1e-9 {
        simulation.step();
    }
}

/// Nothing moves before, so that the time is exact, except that it is seen up to a step late.
#[test_matrix([0.0, 0.05, 0.15])]
fn the_time_to_the_first_slip_counts_in_the_age(beta: f64) {
    let law = Ageing { beta, ..LAW };
    let model = model(law, 0.1, &[(V, f64::INFINITY)], Adhesion::default());
    let exact = ageing_slip_time(&law, 0.0, 0.0, K_DRIVE, V);
    let dt = 0.1;
    let late = next_slip(&mut at_rest(&model, dt)) - exact;
    assert!(-1e-9 < late && late < dt + 1e-9, "late by {late}");
    assert!((model.first_slip_estimate(&Alone).unwrap() / exact - 1.0).abs() < 1e-14);
}

/// Adhesion, a part of a threshold of 1, does not age: only the rest does.
#[test]
fn adhesion_does_not_age() {
    let adhesion = Adhesion {
        of_static: 0.4,
        of_kinetic: 0.0,
    };
    let model = model(LAW, 0.1, &[(0.0, 100.0), (V, f64::INFINITY)], adhesion);
    let part = Ageing {
        beta: 0.6 * LAW.beta,
        ..LAW
    };
    let exact = ageing_slip_time(&part, 0.0, 100.0, K_DRIVE, V);
    let late = next_slip(&mut at_rest(&model, 0.1)) - exact;
    assert!(-1e-9 < late && late < 0.1 + 1e-9, "late by {late}");
}

/// The age counts from the stop of the block, which comes after the stop of the drive. The stop is located to
/// first order in the step: its time to within a step, and the pull there to within k V times a step. So the
/// next slip is found to within two steps, plus the step in which it is seen.
#[test_matrix([0.3, 0.6, 1.2], [0.05, 0.01])]
fn after_steady_sliding_age_counts_from_the_stop(omega_star: f64, dt: f64) {
    let damping = scales::damping(omega_star);
    let (stopped, restarted) = (5.0, 400.0);
    let segments = [(V, stopped), (0.0, restarted), (V, f64::INFINITY)];
    let model = model(LAW, damping, &segments, Adhesion::default());
    let steady = 0.5 + damping * V;
    let everywhere = |x: f64| VectorField {
        x: vec![x; 9],
        y: vec![0.0; 9],
    };
    let state = State {
        displacement: everywhere(-steady / K_DRIVE),
        velocity: everywhere(V),
    };
    let mut simulation = from_state(&model, dt, state);
    advance_to(&mut simulation, stopped);
    let now = simulation.snapshot();
    assert_eq!(now.point.n_sliding, 9);
    assert!((now.point.mu_star - steady).abs() < 1e-12);
    let stop = StopOfSteadySliding::new(0.5, V, K_DRIVE, damping);
    advance_to(&mut simulation, restarted);
    let now = simulation.snapshot();
    assert_eq!(now.point.n_sliding, 0);
    assert!(
        (now.point.mu_star - stop.pull).abs() < K_DRIVE * V * dt,
        "{} {}",
        now.point.mu_star,
        stop.pull
    );
    let exact = stop.next_slip_time(&LAW, stopped, restarted, K_DRIVE, V);
    let late = next_slip(&mut simulation) - exact;
    assert!(-2.0 * dt < late && late < 3.0 * dt, "late by {late}");
}
