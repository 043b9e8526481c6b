//! One block, and a uniform lattice that moves as a rigid body: slip, stop, stick, and slip again.

use slipfront::exact_solutions::SlipCycle;
use test_case::{test_case, test_matrix};

use crate::common::{Slider, at_rest};

fn one_block(omega_star: f64, v_star: f64, dt_star: f64) -> Slider {
    Slider {
        blocks: [1, 1],
        omega_star,
        v_star,
        dt_star,
        ..Slider::default().uniform()
    }
}

/// Values of the closed form at R* = 0.5, to the digits given.
#[test_case(0.0, 0.03, 5.25015, 0.0)]
#[test_case(0.1, 0.03, 5.27878, 0.104656)]
#[test_case(0.1, 0.1, 5.60003, 0.117239)]
#[test_case(0.3, 0.03, 5.43262, 0.259443)]
fn the_closed_form_has_the_tabulated_values(omega_star: f64, v_star: f64, duration: f64, at_stop: f64) {
    let cycle = SlipCycle::new(omega_star, 0.5, v_star);
    assert!(
        (cycle.slip_duration() - duration).abs() < 6e-6,
        "{}",
        cycle.slip_duration()
    );
    assert!(
        (cycle.force_at_stop() - at_stop).abs() < 6e-7,
        "{}",
        cycle.force_at_stop()
    );
    // Follows from its equation: the block is at rest at both ends and its force starts from the threshold.
    assert!((cycle.force(0.0) - 1.0).abs() < 1e-14 && cycle.velocity(0.0).abs() < 1e-14);
    assert!(cycle.velocity(cycle.slip_duration()).abs() < 1e-12);
    let (t, h) = (1.7, 1e-4);
    let acceleration = (cycle.velocity(t + h) - cycle.velocity(t - h)) / (2.0 * h);
    let balance = cycle.force(t) - 0.5 - slipfront::scales::damping(omega_star) * cycle.velocity(t);
    assert!((acceleration - balance).abs() < 1e-8, "{acceleration} {balance}");
}

#[test_matrix([0.01, 0.03, 0.2], [0.25, 0.5, 0.9])]
fn undamped_answers_are_elementary(v_star: f64, r: f64) {
    let cycle = SlipCycle::new(0.0, r, v_star);
    let (k, w) = (0.375_f64, 0.375_f64.sqrt());
    let duration = 2.0 / w * (std::f64::consts::PI - ((1.0 - r) * w / (k * v_star)).atan());
    assert!((cycle.slip_duration() - duration).abs() < 1e-9);
    assert!((cycle.force_at_stop() - (2.0 * r - 1.0)).abs() < 1e-9);
    assert!((cycle.peak() - (r + ((1.0 - r).powi(2) + k * v_star * v_star).sqrt())).abs() < 1e-12);
    assert!((cycle.mean_force() - r).abs() < 1e-9);
}

/// First slip and stop of a lattice that moves as a rigid body: step and mu* of both.
struct Slip {
    start: u64,
    stop: u64,
    force_at_stop: f64,
    /// Largest mu* before the slip, so that the second cycle does not count.
    largest: f64,
}

fn first_slip(slider: &Slider) -> Slip {
    let model = slider.model();
    let mut simulation = at_rest(&model, slider.dt_star);
    let (mut start, mut largest) = (None, 0.0_f64);
    loop {
        let now = simulation.snapshot();
        assert!(now.time_star * slider.v_star < 8.0, "neither slips nor stops");
        let sliding = now.point.n_sliding == model.lattice.n_blocks();
        assert!(
            sliding || now.point.n_sliding == 0,
            "a uniform lattice moves as one"
        );
        largest = largest.max(now.point.mu_star);
        match start {
            None if sliding => start = Some(now.step),
            Some(start) if !sliding => {
                return Slip {
                    start,
                    stop: now.step,
                    force_at_stop: now.point.mu_star,
                    largest,
                };
            }
            _ => {}
        }
        simulation.step();
    }
}

/// The slip starts at the first instant past the threshold and stops at the first instant past the stop, so
/// that its duration may be wrong by two steps. The force at the stop changes by at most k_s V dt per step.
/// The start, late by up to a step, increases all forces of the slip by up to k_s V dt.
#[test_matrix([[1, 1], [2, 2], [7, 5]], [(0.0, 0.03), (0.1, 0.03), (0.1, 0.1), (0.3, 0.03)], [0.0, 77.0])]
fn one_block_and_a_uniform_lattice_slip_as_the_closed_form(
    blocks: [usize; 2],
    (omega_star, v_star): (f64, f64),
    degrees: f64,
) {
    let dt = 1e-3;
    let slider = Slider {
        blocks,
        degrees,
        ..one_block(omega_star, v_star, dt)
    };
    let exact = SlipCycle::new(omega_star, 0.5, v_star);
    let slip = first_slip(&slider);
    let late = slip.start as f64 * dt - exact.onset_time_star();
    assert!(-1e-10 < late && late <= dt * 1.000_001, "slips {late} late");
    let duration = (slip.stop - slip.start) as f64 * dt;
    assert!(
        (duration - exact.slip_duration()).abs() < 2.0 * dt,
        "slips for {duration}, exactly {}",
        exact.slip_duration()
    );
    let reach = 0.375 * v_star * dt;
    assert!(
        (slip.force_at_stop - exact.force_at_stop()).abs() < 2.0 * reach + 1e-5,
        "stops at {}, exactly {}",
        slip.force_at_stop,
        exact.force_at_stop()
    );
    assert!(
        (slip.largest - exact.peak()).abs() < reach + 1e-6,
        "peak {}, exactly {}",
        slip.largest,
        exact.peak()
    );
}

/// Over a whole period the mean force is R* plus the contribution of damping; a step counts 1/period of it.
#[test_matrix([0.0, 0.1, 0.3], [[1, 1], [6, 6]])]
fn the_mean_force_over_a_cycle(omega_star: f64, blocks: [usize; 2]) {
    let slider = Slider {
        blocks,
        ..one_block(omega_star, 0.1, 2e-3)
    };
    let exact = SlipCycle::new(omega_star, 0.5, 0.1);
    let model = slider.model();
    let mut simulation = at_rest(&model, slider.dt_star);
    let (mut starts, mut sum, mut slid) = (Vec::new(), 0.0, false);
    while starts.len() < 4 {
        let now = simulation.snapshot();
        assert!(now.time_star * slider.v_star < 20.0, "the cycle does not repeat");
        let slides = now.point.n_sliding > 0;
        if slides && !slid {
            starts.push(now.step);
        }
        slid = slides;
        if !starts.is_empty() && starts.len() < 4 {
            sum += now.point.mu_star;
        }
        simulation.step();
    }
    let steps = (starts[3] - starts[0]) as f64;
    // The error is of first order in the step, through the instants of slip and stop.
    let tolerance = 0.1 * slider.dt_star;
    assert!(
        (sum / steps - exact.mean_force()).abs() < tolerance,
        "{} {}",
        sum / steps,
        exact.mean_force()
    );
    let period = steps * slider.dt_star / 3.0;
    assert!(
        (period - exact.period()).abs() < 2.0 * slider.dt_star,
        "{period} {}",
        exact.period()
    );
}

/// The first peak counts, although a later cycle may start up to a step later past the threshold and climb
/// higher.
#[test]
fn the_first_peak_of_a_uniform_lattice_is_that_of_its_first_cycle() {
    let slider = Slider {
        blocks: [5, 5],
        omega_star: 0.1,
        dt_star: 0.07,
        ..Slider::default().uniform()
    };
    let exact = SlipCycle::new(0.1, 0.5, 0.03);
    let outcome = slider.run(8.0);
    let peak = outcome.peak;
    let per_step = 0.375 * 0.03 * slider.dt_star;
    assert!(peak.ended);
    assert!((peak.time_star - exact.onset_time_star() - exact.peak_delay()).abs() < 2.0 * slider.dt_star);
    assert!((peak.mu_star - exact.peak()).abs() < per_step);
    let later = peak.largest.mu_star - peak.mu_star;
    assert!(
        (1e-5..per_step).contains(&later),
        "a later cycle exceeds the first by {later}"
    );
    assert!(
        outcome
            .rows
            .iter()
            .filter(|row| row.point.mu_star > peak.mu_star)
            .all(|row| row.step > peak.step)
    );
}

/// A single block, driven at an angle, moves along this direction; the other component never appears.
#[test]
fn one_block_moves_along_the_drive() {
    let slider = Slider {
        degrees: 25.0,
        ..one_block(0.1, 0.03, 0.05)
    };
    let model = slider.model();
    let mut simulation = at_rest(&model, slider.dt_star);
    for _ in 0..slider.steps(8.0) {
        simulation.step();
        let [x, y] = simulation.state().displacement.at(0);
        let [c, s] = model.drive.direction;
        assert!((x * s - y * c).abs() < 1e-12);
        assert!(simulation.snapshot().point.mu_lateral_star.abs() < 1e-13);
    }
}
