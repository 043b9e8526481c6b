//! First slip: t* = (8/3) min_i max(mu_si, mu_ki)/(mu_s V*), in any direction.

use rstest::rstest;
use slipfront::communicator::Alone;
use slipfront::exact_solutions::first_slip_time_star;
use slipfront::surface::{Coefficients, Load};
use slipfront::{Drive, FrictionLaw, Lattice, Model, Simulation, Stop, Surface};

use crate::common::{Slider, at_rest};

fn slipping(model: &Model, dt_star: f64) -> Simulation {
    let steps = (4.0 / model.drive.v_star / dt_star) as u64;
    let mut simulation = at_rest(model, dt_star);
    simulation.run(Stop::at_step(steps), &mut []).unwrap();
    simulation
}

/// The first instant at which the force exceeds the threshold: at most one step late, never early; rounding
/// of a force and of its threshold moves an instant by 1e-12 at most.
fn assert_is_first_instant_after(found: f64, exact: f64, dt_star: f64) {
    let late = found - exact;
    assert!(
        -1e-12 * exact < late && late < dt_star * (1.0 + 1e-9),
        "first slip at {found}, exact {exact}: late by {late}"
    );
}

#[rstest]
#[case::baseline(Slider::default())]
#[case::any_direction(Slider { degrees: 37.0, ..Slider::default() })]
#[case::backwards(Slider { degrees: 225.0, sigma_static_star: 0.2, ..Slider::default() })]
#[case::some_draws_have_mu_k_above_mu_s(Slider { r_star: 0.95, sigma_static_star: 0.1, sigma_kinetic_star: 0.1, ..Slider::default() })]
#[case::faster(Slider { v_star: 0.2, sigma_static_star: 0.1, dt_star: 0.01, ..Slider::default() })]
#[case::reversal(Slider { law: FrictionLaw::Reversal, r_star: 0.95, sigma_kinetic_star: 0.1, ..Slider::default() })]
fn the_weakest_block_slips_when_its_drive_spring_reaches_its_threshold(#[case] slider: Slider) {
    let drawn = slider.coefficients();
    let exact = first_slip_time_star(&drawn.mu_static, &drawn.mu_kinetic, 1.0, slider.v_star);
    let model = slider.model();
    assert!((model.first_slip_estimate(&Alone) / exact - 1.0).abs() < 1e-14);
    let simulation = slipping(&model, slider.dt_star);
    let earliest = simulation.snapshot().earliest_first_slip().unwrap();
    assert_is_first_instant_after(earliest, exact, slider.dt_star);
    // The block that slips is the one with the least threshold.
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
        slipping(&model, 0.01).snapshot().earliest_first_slip().unwrap(),
        exact,
        0.01,
    );
}

/// D12: a block whose kinetic coefficient exceeds the static one sticks up to the kinetic threshold.
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
            slipping(&model, 0.02).snapshot().earliest_first_slip().unwrap(),
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
    while simulation.time_star() < model.first_slip_estimate(&Alone) - 0.1 {
        for b in 0..model.lattice.n_blocks() {
            let block = simulation.snapshot().block(b);
            assert_eq!(block.force_friction, block.force_drive.map(|f| -f));
            assert_eq!(block.force_lattice, [0.0, 0.0]);
            assert!(!block.slides());
        }
        simulation.step();
    }
    // The pull grows as k_s V* t*, all of it along the drive.
    let now = simulation.snapshot();
    assert!((now.point.mu_star - 0.375 * 0.03 * now.time_star).abs() < 1e-14);
    assert!(now.point.mu_lateral_star.abs() < 1e-15 && now.point.n_sliding == 0);
}
