//! Blocks of different stiffness and density.

use slipfront::communicator::Alone;
use slipfront::exact_solutions::{graded_first_slip_time_star, leapfrog_frequency, pair_modes, steady_level};
use slipfront::observe::{Curve, Scheduled};
use slipfront::surface::{Coefficients, Contact, Load};
use slipfront::{Drive, Edges, FrictionLaw, Lattice, Model, Slider, State, Stop, Surface, VectorField};
use test_case::test_matrix;

use crate::common::{self, at_rest, cavity, from_state, varied};

/// Moduli and densities of all blocks.
fn graded(stiffness: &[f64], density: &[f64]) -> Slider {
    Slider::new(Some(stiffness.to_vec()), Some(density.to_vec()), None, &Alone)
}

/// Arrays of ones do not change any bit, including energies, mu* and N*.
#[test_matrix(
    [[Edges::Free; 2], [Edges::Periodic, Edges::Free]],
    [FrictionLaw::Projection, FrictionLaw::Reversal]
)]
fn fields_of_ones_change_no_bit(edges: [Edges; 2], law: FrictionLaw) {
    let plain = common::Slider {
        blocks: [13, 9],
        edges,
        textures: vec![cavity([13, 9], 8.0, 1, 0.3, false)],
        degrees: 20.0,
        law,
        ..common::Slider::default()
    };
    // The general kernel computes both.
    let ones = common::Slider {
        body: graded(&[1.0; 117], &[1.0; 117]),
        ..plain.clone()
    };
    let plain = common::Slider {
        body: Slider {
            density: Some(vec![1.0; 117]),
            ..Slider::default()
        },
        ..plain
    };
    let run = |slider: &common::Slider| {
        let outcome = slider.run(6.0);
        (outcome.peak, outcome.rows)
    };
    assert_eq!(run(&plain), run(&ones));
    assert_eq!(
        plain.model().steady_level(&Alone),
        ones.model().steady_level(&Alone)
    );
}

/// Moduli, masses and all friction times four, a power of two: the same motion, to the last bit, as that of
/// the plain slider on the same kernel; mu* is four times as large.
#[test]
fn a_heavier_stiffer_and_rougher_slider_moves_the_same() {
    let plain = common::Slider {
        blocks: [12, 12],
        body: graded(&[1.0; 144], &[1.0; 144]),
        ..common::Slider::default()
    };
    let drawn = plain.coefficients();
    let rough = |mu: &[f64]| mu.iter().map(|mu| 4.0 * mu).collect();
    let rough = Coefficients::given(rough(&drawn.mu_static), rough(&drawn.mu_kinetic));
    let body = graded(&[4.0; 144], &[4.0; 144]);
    let contact = Contact::new(Load::Redistributed, 1.0);
    let surface = Surface::of_ranks(rough, vec![false; 144], contact, &body, &Alone).unwrap();
    let model = plain.model();
    let mut heavy = model.clone().with_slider(body);
    heavy.surface = surface;
    let (mut one, mut other) = (at_rest(&model, plain.dt_star), at_rest(&heavy, plain.dt_star));
    for step in 0..plain.steps(5.0) {
        one.step();
        other.step();
        assert_eq!(one.state(), other.state(), "step {step}");
        let [one, other] = [&one, &other].map(|simulation| simulation.snapshot().point.mu_star);
        // The terms of the sums are rounded to quanta that follow from their bounds: 2^-51 of displacements
        // of up to 20.
        assert!((4.0 * one - other).abs() < 1e-13, "step {step}: {one} {other}");
    }
    assert!(one.peak().ended);
}

/// Nothing moves before the first slip, which is seen at most a step late. The first block to slip is the
/// first with a spring that is stretched far enough.
#[test_matrix([0.0, 0.05, 0.3])]
fn the_block_with_the_least_threshold_for_its_spring_slips_first(sigma: f64) {
    let slider = common::Slider {
        blocks: [9, 9],
        body: varied(81, false),
        sigma_static_star: sigma,
        ..common::Slider::default()
    };
    let (drawn, stiffness) = (slider.coefficients(), slider.body.stiffness.as_ref().unwrap());
    let limits: Vec<f64> = (0..81)
        .map(|b| drawn.mu_static[b].max(drawn.mu_kinetic[b]))
        .collect();
    let exact = graded_first_slip_time_star(&limits, stiffness, slider.v_star);
    let model = slider.model();
    assert!((model.first_slip_estimate(&Alone).unwrap() / exact - 1.0).abs() < 1e-14);
    let mut simulation = at_rest(&model, slider.dt_star);
    while simulation.peak().first_slip_drive_time_star.is_none() {
        simulation.step();
    }
    let now = simulation.snapshot();
    let late = now.peak.first_slip_drive_time_star.unwrap() - exact;
    assert!(-1e-10 < late && late < slider.dt_star * (1.0 + 1e-9), "{late}");
    let first = |a: &usize, b: &usize| (limits[*a] / stiffness[*a]).total_cmp(&(limits[*b] / stiffness[*b]));
    let expected = (0..81).min_by(first).unwrap();
    assert!(!now.first_slip_time_star()[expected].is_nan());
}

/// Each mode oscillates at the frequency of leapfrog; rounding errors accumulate to less than 1e-10 in 2000
/// steps.
#[test_matrix([[1.0, 0.1], [3.0, 0.5], [0.2, 0.2]], [[1.0, 1.0], [0.5, 4.0]], [0, 1])]
fn two_blocks_have_the_modes_of_their_moduli_and_masses(
    stiffness: [f64; 2],
    masses: [f64; 2],
    number: usize,
) {
    let lattice = Lattice::free(2, 1);
    let body = graded(&stiffness, &masses);
    let contact = Contact::new(Load::Redistributed, 1.0);
    let none = || Coefficients::given(vec![0.0; 2], vec![0.0; 2]);
    let surface = Surface::of_ranks(none(), vec![false; 2], contact, &body, &Alone).unwrap();
    let drive = Drive::along_x(0.0);
    let plain = Model::new(lattice, surface, drive, 0.0, 0.0, FrictionLaw::Projection);
    let model = plain.with_slider(body);
    let mode = pair_modes(stiffness, masses)[number];
    let dt = 0.1;
    let frequency = leapfrog_frequency(mode.omega_squared.sqrt(), dt);
    let shape = |scale: f64| VectorField {
        x: vec![scale, scale * mode.ratio],
        y: vec![0.0; 2],
    };
    let mut simulation = from_state(
        &model,
        dt,
        State {
            displacement: shape(1.0),
            velocity: shape((1.0 - (frequency * dt).cos()) / dt),
        },
    );
    for step in 1..=2000 {
        simulation.step();
        let exact = (frequency * f64::from(step) * dt).cos();
        let u = simulation.state().displacement.x;
        let size = 1.0 + mode.ratio.abs();
        assert!((u[0] - exact).abs() < 1e-10 * size && (u[1] - mode.ratio * exact).abs() < 1e-10 * size);
    }
}

/// Steady sliding has mu* = mean(mu_k F_n) + Omega V* mean(m), at any stiffness. The slowest remaining motion
/// decays at a rate of at least k_s min(E)/(Omega max(m)) = 0.027, so that at t* = 1200 only rounding errors
/// remain.
#[test_matrix([0.05, 0.1])]
fn heavier_blocks_raise_the_drag(v_star: f64) {
    let slider = common::Slider {
        blocks: [12, 10],
        body: graded(
            varied(120, false).stiffness.as_ref().unwrap(),
            &(0..120)
                .map(|b| 0.5 + 0.25 * f64::from(b % 7))
                .collect::<Vec<_>>(),
        ),
        omega_star: 2.0,
        v_star,
        ..common::Slider::default()
    };
    let density = slider.body.density.as_ref().unwrap();
    let mean_mass = density.iter().sum::<f64>() / 120.0;
    assert!((slider.body.mean_mass / mean_mass - 1.0).abs() < 1e-14 && (mean_mass - 1.0).abs() > 1e-3);
    let drawn = slider.coefficients();
    let mean_kinetic = drawn.mu_kinetic.iter().sum::<f64>() / 120.0;
    let exact = steady_level(mean_kinetic, slider.omega_star, v_star * mean_mass);
    assert!((slider.model().steady_level(&Alone) - exact).abs() < 1e-13);
    let last = slider.run(120.0).rows.last().copied().unwrap();
    assert_eq!(last.point.sliding_percent, 100.0);
    assert!(
        (last.point.mu_star - exact).abs() < 1e-9,
        "{} and {exact}",
        last.point.mu_star
    );
}

/// As for equal blocks, the balance misses the kinetic energy of the last step of a slip, of second order in
/// dt.
#[test]
fn the_ledger_closes() {
    let slider = common::Slider {
        blocks: [12, 14],
        body: varied(168, true),
        dt_star: 0.02,
        ..common::Slider::default()
    };
    let mut curve = Curve::every(1);
    let mut simulation = at_rest(&slider.model(), slider.dt_star);
    let steps = slider.steps(8.0);
    simulation
        .run(Stop::at_step(steps), &mut [Scheduled::always(&mut curve)])
        .unwrap();
    let late = curve.rows.iter().skip(curve.rows.len() / 4);
    let worst = late.map(|row| row.energies.error().abs()).fold(0.0, f64::max);
    assert!(worst < 1e-4, "closes to {worst}");
    assert!(curve.rows.last().unwrap().energies.friction_loss > 0.0);
}
