//! Programs of speeds: velocity steps, holds, reversals.

use std::sync::Arc;

use slipfront::communicator::Alone;
use slipfront::observe::{Curve, Cycles, Scheduled};
use slipfront::{Model, Program, Stop};
use test_case::test_matrix;

use crate::common::{Slider, at_rest};

const END: f64 = f64::INFINITY;

fn programmed(slider: &Slider, segments: &[(f64, f64)]) -> Model {
    let mut model = slider.model();
    let largest = segments.iter().map(|(v_star, _)| v_star.abs());
    model.drive.v_star = largest.fold(0.0, f64::max);
    model.drive.program = Some(Arc::new(Program::new(segments.iter().copied())));
    model
}

/// After a hold from the start the drive takes as long to the first slip as without the hold:
/// `k_s V (t - t_h) = min_i threshold_i`, seen at most a step late.
#[test_matrix([0.0, 12.5, 400.0])]
fn a_hold_before_the_first_slip_delays_it(hold: f64) {
    let slider = Slider::default();
    let exact = hold + slider.model().first_slip_estimate(&Alone).unwrap();
    let segments = [(0.0, hold), (slider.v_star, END)];
    let model = programmed(&slider, if hold > 0.0 { &segments } else { &segments[1..] });
    assert!((model.first_slip_estimate(&Alone).unwrap() / exact - 1.0).abs() < 1e-14);
    let mut simulation = at_rest(&model, 0.1);
    while simulation.snapshot().totals.n_slipping == 0 {
        simulation.step();
    }
    let late = simulation.time_star() - exact;
    assert!(-1e-10 < late && late < 0.1 + 1e-9, "late by {late}");
}

/// If the drive reverses before the first slip, the pull is still `k_s X` of the path, and the slip backwards
/// is the mirror image of the slip forwards. Its time follows from the path.
#[test]
fn a_reversal_loads_backwards() {
    let slider = Slider::default().uniform();
    let model = programmed(&slider, &[(0.03, 40.0), (-0.03, END)]);
    // Forwards to 1.2, then back to -8/3.
    let exact = 40.0 + (1.2 + 1.0 / 0.375) / 0.03;
    assert!((model.first_slip_estimate(&Alone).unwrap() / exact - 1.0).abs() < 1e-14);
    let mut simulation = at_rest(&model, 0.1);
    while simulation.snapshot().totals.n_slipping == 0 {
        let now = simulation.snapshot();
        let path = 0.03 * (40.0 - (now.time_star - 40.0).abs());
        assert!((now.point.mu_star - 0.375 * path).abs() < 1e-13);
        simulation.step();
    }
    let late = simulation.time_star() - exact;
    assert!(-1e-10 < late && late < 0.1 + 1e-9, "late by {late}");
}

/// A program of one speed equals this speed, and a program of negative speeds equals the run backwards, to
/// the last bit, without geometric nonlinearity, which has a sign.
#[test]
fn a_program_changes_nothing_but_the_speed() {
    let slider = Slider {
        blocks: [11, 7],
        epsilon: 0.0,
        v_star: 0.2,
        ..Slider::default()
    };
    let run = |segments: &[(f64, f64)]| {
        let mut simulation = at_rest(&programmed(&slider, segments), 0.1);
        simulation.run(Stop::at_step(1000), &mut []).unwrap();
        (simulation.state(), simulation.snapshot().totals.n_slipping)
    };
    let (constant, _) = run(&[(0.2, END)]);
    let mut plain = at_rest(&slider.model(), 0.1);
    plain.run(Stop::at_step(1000), &mut []).unwrap();
    assert_eq!(constant, plain.state());
    let (there, slipping) = run(&[(0.2, 50.0), (0.0, 70.0), (0.1, END)]);
    let (back, _) = run(&[(-0.2, 50.0), (0.0, 70.0), (-0.1, END)]);
    assert!(slipping > 0);
    for (one, other) in [
        (&there.displacement, &back.displacement),
        (&there.velocity, &back.velocity),
    ] {
        assert!(one.x.iter().zip(&other.x).all(|(a, b)| *a == -b));
        assert!(one.y.iter().zip(&other.y).all(|(a, b)| *a == -b));
    }
}

/// The work of a step is the mean of the forces at its ends times the path between them. It is exact while
/// only the springs take up work. Later the balance misses the energy that blocks lose when they stop, in
/// proportion to the square of the step.
#[test]
fn the_ledger_closes_under_a_program() {
    let slider = Slider {
        blocks: [12, 10],
        ..Slider::default()
    };
    let segments = [
        (0.25, 8.0),
        (-0.1, 12.0),
        (0.0, 16.0),
        (0.5, 50.0),
        (0.0, 70.0),
        (-0.5, END),
    ];
    let energies = |dt_star: f64, until: f64| {
        let model = programmed(&slider, &segments);
        let mut curve = Curve::every(u64::MAX);
        let mut simulation = at_rest(&model, dt_star);
        let stop = Stop::at_step((until / dt_star).round() as u64);
        simulation
            .run(stop, &mut [Scheduled::always(&mut curve)])
            .unwrap();
        curve.rows.last().unwrap().energies
    };
    // X goes to 0.25 x 8 = 2, where k_s X = 0.75 is below every threshold, and back to 1.6.
    let stuck = energies(0.1, 16.0);
    assert!((stuck.work / (120.0 * 0.5 * 0.375 * 1.6 * 1.6) - 1.0).abs() < 1e-12);
    assert!(stuck.friction_loss == 0.0 && stuck.error().abs() < 1e-12);
    let [coarse, fine] = [0.1, 0.025].map(|dt_star| energies(dt_star, 120.0));
    assert!(coarse.friction_loss > 0.3 * coarse.work);
    // Only half of the factor of 16 is required, since blocks stop at other instants.
    let errors = [coarse, fine].map(|energies| energies.error().abs());
    assert!(errors[0] < 1e-2 && errors[1] < errors[0] / 8.0, "{errors:?}");
}

/// The peak of each segment in which the drive moves forwards: for a stuck slider `k_s X` at its end. The
/// values at an instant belong to the segment that ends there.
#[test]
fn every_slide_has_its_peak() {
    let model = programmed(
        &Slider::default(),
        &[(0.1, 10.0), (0.0, 20.0), (-0.05, 30.0), (0.2, END)],
    );
    let mut cycles = Cycles::default();
    let mut simulation = at_rest(&model, 0.1);
    simulation
        .run(Stop::at_step(350), &mut [Scheduled::always(&mut cycles)])
        .unwrap();
    let found: Vec<_> = cycles
        .cycles()
        .iter()
        .map(|cycle| [cycle.from_star, cycle.v_star, cycle.time_star])
        .collect();
    assert_eq!(found, [[0.0, 0.1, 10.0], [30.0, 0.2, 35.0]]);
    let peaks = [0.375, 0.375 * 1.5];
    for (cycle, peak) in cycles.cycles().iter().zip(peaks) {
        assert!((cycle.mu_star - peak).abs() < 1e-13, "{cycle:?}");
    }
}
