//! First slip: t* = (8/3) min_i max(mu_si, mu_ki)/(mu_s V*), in any direction.

use slipfront::communicator::Alone;
use slipfront::exact_solutions::first_slip_time_star;
use slipfront::lattice::{K_DRIVE, springs_on_a_lone_block};
use slipfront::surface::{Coefficients, Load};
use slipfront::{
    AfterBreak, ContactSprings, Drive, Friction, FrictionLaw, Lattice, Model, Simulation, Stop, Surface,
};
use test_case::test_case;

use crate::common::{Slider, at_rest};

fn slipping(model: &Model, dt_star: f64) -> Simulation {
    let steps = (4.0 / model.drive.v_star / dt_star) as u64;
    let mut simulation = at_rest(model, dt_star);
    simulation.run(Stop::at_step(steps), &mut []).unwrap();
    simulation
}

/// The first instant at which the force exceeds the threshold: at most one step late, never early; rounding
/// of the force and of the threshold shifts an instant by at most 1e-12.
fn assert_is_first_instant_after(found: f64, exact: f64, dt_star: f64) {
    let late = found - exact;
    assert!(
        -1e-12 * exact < late && late < dt_star * (1.0 + 1e-9),
        "first slip at {found}, exact {exact}: late by {late}"
    );
}

#[test_case(Slider::default(); "baseline")]
#[test_case(Slider { degrees: 37.0, ..Slider::default() }; "any direction")]
#[test_case(Slider { degrees: 225.0, sigma_static_star: 0.2, ..Slider::default() }; "backwards")]
#[test_case(
    Slider { r_star: 0.95, sigma_static_star: 0.1, sigma_kinetic_star: 0.1, ..Slider::default() }
    ; "some draws have mu k above mu s"
)]
#[test_case(Slider { v_star: 0.2, sigma_static_star: 0.1, dt_star: 0.01, ..Slider::default() }; "faster")]
#[test_case(Slider { law: FrictionLaw::Reversal, r_star: 0.95, sigma_kinetic_star: 0.1, ..Slider::default() }; "reversal")]
fn the_weakest_block_slips_when_its_drive_spring_reaches_its_threshold(slider: Slider) {
    let drawn = slider.coefficients();
    let exact = first_slip_time_star(&drawn.mu_static, &drawn.mu_kinetic, 1.0, slider.v_star);
    let model = slider.model();
    assert!((model.first_slip_estimate(&Alone).unwrap() / exact - 1.0).abs() < 1e-14);
    let simulation = slipping(&model, slider.dt_star);
    let earliest = simulation.peak().first_slip_drive_time_star.unwrap();
    assert_is_first_instant_after(earliest, exact, slider.dt_star);
    // The block that slips has the least threshold.
    let threshold = |b: usize| drawn.mu_static[b].max(drawn.mu_kinetic[b]);
    let weakest = (0..drawn.mu_static.len()).min_by(|&a, &b| threshold(a).total_cmp(&threshold(b)));
    let first = simulation.snapshot().first_slip_time_star();
    assert_eq!(first[weakest.unwrap()], earliest);
}

#[test]
fn the_scale_of_coefficients_is_their_static_mean() {
    let lattice = Lattice::free(3, 3);
    let given = Coefficients::given((0..9).map(|b| 0.2 + 0.01 * f64::from(b)).collect(), vec![0.1; 9]);
    let exact = first_slip_time_star(&given.mu_static, &given.mu_kinetic, 0.24, 0.05);
    let surface = Surface::new(given, vec![false; 9], Load::Redistributed, 0.24).unwrap();
    let model = Model::new(
        lattice,
        surface,
        Drive::along_x(0.05),
        0.1,
        1e-6,
        FrictionLaw::Projection,
    );
    assert_is_first_instant_after(
        slipping(&model, 0.01).peak().first_slip_drive_time_star.unwrap(),
        exact,
        0.01,
    );
}

/// D12: a block with a kinetic coefficient above the static one sticks up to the kinetic threshold.
#[test]
fn a_block_holds_up_to_the_larger_of_its_coefficients() {
    let lattice = Lattice::free(1, 1);
    for (mu_static, mu_kinetic) in [(1.0, 1.2), (0.7, 1.0), (1.0, 0.7)] {
        let model = Model::new(
            lattice,
            Surface::uniform(&lattice, mu_static, mu_kinetic),
            Drive::along_x(0.03),
            0.0,
            1e-6,
            FrictionLaw::Projection,
        );
        let exact = first_slip_time_star(&[mu_static], &[mu_kinetic], 1.0, 0.03);
        assert_is_first_instant_after(
            slipping(&model, 0.02).peak().first_slip_drive_time_star.unwrap(),
            exact,
            0.02,
        );
    }
}

#[test]
fn friction_balances_all_other_forces_until_then() {
    let slider = Slider {
        degrees: 30.0,
        ..Slider::default()
    };
    let model = slider.model();
    let mut simulation = at_rest(&model, 0.1);
    while simulation.time_star() < model.first_slip_estimate(&Alone).unwrap() - 0.1 {
        for b in 0..model.lattice.n_blocks() {
            let block = simulation.snapshot().block(b);
            assert_eq!(block.force_friction, block.force_drive.map(|f| -f));
            assert_eq!(block.force_lattice, [0.0, 0.0]);
            assert!(!block.slides);
        }
        simulation.step();
    }
    // The pull grows as k_s V* t*, all of it along the drive.
    let now = simulation.snapshot();
    assert!((now.point.mu_star - 0.375 * 0.03 * now.time_star).abs() < 1e-14);
    assert!(now.point.mu_lateral_star.abs() < 1e-15 && now.point.n_sliding == 0);
}

/// Only one block of 41 x 41 is in contact, under its own load alone. The others are free and push it with
/// the force of their drive springs, so that it slips earlier by the factor [`springs_on_a_lone_block`]. The
/// drive is slow and damping critical for the slider as a whole: its viscous force, Omega V of the moving
/// blocks, is 1e-3 of the threshold for each, and a step 1e-3 of the time.
#[test]
fn a_block_that_touches_alone_bears_its_neighbours_drive_too() {
    let lattice = Lattice::free(41, 41);
    let n = lattice.n_blocks();
    let middle = n / 2;
    let textured = (0..n).map(|b| b != middle).collect();
    let given = Coefficients::given(vec![1.0; n], vec![0.5; n]);
    let surface = Surface::new(given, textured, Load::Kept, 1.0).unwrap();
    let v_star = 1e-3;
    let model = Model::new(
        lattice,
        surface,
        Drive::along_x(v_star),
        1.2,
        1e-6,
        FrictionLaw::Projection,
    );
    assert_eq!(model.surface.load_factor(), 1.0);
    let found = slipping(&model, 0.5).peak().first_slip_drive_time_star.unwrap();
    let exact = 1.0 / (springs_on_a_lone_block(K_DRIVE) * K_DRIVE * v_star);
    assert!((found / exact - 1.0).abs() < 5e-3, "{found}, exactly {exact}");
}

/// Onset by the formula for all blocks in contact, for few blocks in contact, and for blocks without
/// redistributed load.
#[test]
fn an_onset_is_expected_between_that_of_lone_blocks_and_that_of_blocks_by_themselves() {
    let model = Slider::default().model();
    let usual = 2.5 / 0.03;
    assert_eq!(model.onset_estimate(Some(1.0)), [usual; 2]);
    assert_eq!(model.onset_estimate(None), [usual; 2]);
    let [from, to] = model.onset_estimate(Some(2.0));
    assert!(from == usual && (to / (2.0 * usual) - 1.0).abs() < 1e-14);
    let [from, to] = model.onset_estimate(Some(20.0));
    // 5.0635 is the integral on 400 x 400 waves.
    let lone = 20.0 / (5.0635 * 0.375 * 0.03);
    assert!((from / lone - 1.0).abs() < 1e-4, "{from} {lone}");
    assert!((to / (20.0 * usual) - 1.0).abs() < 1e-14);
}

/// The maximum of 2.5/V* for a slow drive, a block per t* for a fast one, and the period on soft springs;
/// contact springs share the path of the drive.
#[test]
fn a_transition_takes_no_longer_than_loading_crossing_or_a_swing() {
    let slow = Slider::default().model();
    assert_eq!(slow.longest_fall(), 2.5 / 0.03);
    let fast = Slider {
        v_star: 0.2,
        ..Slider::default()
    };
    assert_eq!(fast.model().longest_fall(), 25.0);
    let mut soft = fast.model();
    soft.drive.k_drive = 0.01;
    soft.drive.v_star = 10.0;
    assert!((soft.longest_fall() - 20.0 * std::f64::consts::PI).abs() < 1e-12);
    let mut yielding = slow;
    yielding.friction = Friction::ContactSprings(ContactSprings {
        stiffness: 0.125,
        after_break: AfterBreak::FormsAgain { redraw: None },
    });
    assert!((yielding.longest_fall() - 4.0 * 2.5 / 0.03).abs() < 1e-9);
}
