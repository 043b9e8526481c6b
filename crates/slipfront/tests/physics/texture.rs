//! Effects of a texture on load, friction, counts and times; and the three readings of the friction law.

use slipfront::communicator::Alone;
use slipfront::observe::Field;
use slipfront::observe::frames::Selection;
use slipfront::surface::{Load, Orientation};
use slipfront::{FrictionLaw, State, Stop, Surface, VectorField};
use test_case::test_matrix;

use crate::common::{Slider, at_rest, cavity, from_state, groove};

fn textured() -> Slider {
    Slider {
        textures: vec![cavity([25, 25], 10.0, 1, 0.0, false)],
        ..Slider::default()
    }
}

#[test]
fn blocks_in_contact_carry_the_whole_load() {
    for percent in [0.5, 10.0, 60.0] {
        let slider = Slider {
            textures: vec![cavity([25, 25], percent, 1, 0.2, true)],
            ..Slider::default()
        };
        let surface = slider.surface();
        let total = |surface: &Surface| (0..625).map(|b| surface.normal_force(b)).sum::<f64>();
        assert!((total(&surface) - 625.0).abs() < 1e-10);
        let share = 625.0 / surface.n_contact() as f64;
        let drawn = slider.coefficients();
        for b in 0..625 {
            let (load, hold, slide) = if surface.textured[b] {
                (0.0, 0.0, 0.0)
            } else {
                (share, share * drawn.mu_static[b], share * drawn.mu_kinetic[b])
            };
            assert_eq!(surface.normal_force(b), load);
            let over = surface.textured[b];
            let kept = |mu: f64| if over { 0.0 } else { mu };
            assert_eq!(surface.mu_static[b], kept(drawn.mu_static[b]));
            assert_eq!(surface.mu_kinetic[b], kept(drawn.mu_kinetic[b]));
            assert!(
                (surface.static_limit(b) - hold).abs() < 1e-15
                    && (surface.kinetic_force(b) - slide).abs() < 1e-15
            );
        }
        let kept = Slider {
            load: Load::Kept,
            ..slider
        };
        assert_eq!(total(&kept.surface()), surface.n_contact() as f64);
    }
}

/// A textured block has no friction, so that it moves as soon as any force acts: in the first step after
/// t = 0. N* counts it, first-slip times do not.
#[test_matrix([FrictionLaw::Projection, FrictionLaw::Reversal])]
fn textured_blocks_move_at_once(law: FrictionLaw) {
    let slider = Slider { law, ..textured() };
    let model = slider.model();
    let n_textured = 625 - model.surface.n_contact();
    let traction = Selection {
        fields: vec![Field::Traction],
        stride: 1,
    };
    let mut simulation = at_rest(&model, slider.dt_star);
    assert_eq!(simulation.snapshot().point.n_sliding, 0, "no force acts at t = 0");
    for _ in 0..20 {
        simulation.step();
        let now = simulation.snapshot();
        assert_eq!(now.point.n_sliding, n_textured);
        assert_eq!(now.point.sliding_percent, 100.0 * n_textured as f64 / 625.0);
        let traction = &traction.capture(&now).values[0];
        for (b, &over) in model.surface.textured.iter().enumerate() {
            assert_eq!(now.block(b).slides, over);
            assert_eq!(traction[b].is_nan(), over);
        }
    }
    simulation.run(Stop::at_step(1500), &mut []).unwrap();
    let first = simulation.snapshot().first_slip_time_star();
    for (b, time) in first.iter().enumerate() {
        assert_eq!(time.is_nan(), model.surface.textured[b], "block {b}");
    }
    let earliest = first.iter().copied().fold(f64::INFINITY, f64::min);
    assert_eq!(simulation.peak().first_slip_drive_time_star, Some(earliest));
    // The pull of the cavity's blocks makes its rim slip before an untextured surface would.
    assert!(earliest < model.first_slip_estimate(&Alone).unwrap());
}

/// Eq. 10 for a stuck block is the pull of its own drive spring; the traction shows the concentration at the
/// rim.
#[test]
fn contact_stress_and_traction_of_stuck_blocks() {
    let slider = textured().uniform();
    let model = slider.model();
    let mut simulation = at_rest(&model, slider.dt_star);
    for _ in 0..300 {
        simulation.step();
    }
    let now = simulation.snapshot();
    let pull = 0.375 * 0.03 * now.time_star;
    let mut largest = 0.0_f64;
    for b in (0..625).filter(|&b| !model.surface.textured[b]) {
        let block = now.block(b);
        assert!((block.contact_stress() - pull).abs() < 1e-12);
        largest = largest.max(block.traction());
    }
    assert!(largest > 1.5 * pull, "the rim bears {largest}, the rest {pull}");
    // The sum of all pulls on stuck and sliding blocks is that of the drive.
    let total = (0..625).map(|b| now.block(b).force_drive[0]).sum::<f64>() / 625.0;
    assert!((total - now.point.mu_star).abs() < 1e-13);
}

/// The scale of tau_c* is the maximum over blocks in contact and steps, at every step. The recomputed stress
/// of a sliding block may differ by rounding: by some 1e-16 of its forces, which are of the order of 1.
#[test]
fn the_largest_contact_stress_is_over_blocks_in_contact_and_all_steps() {
    let slider = textured();
    let model = slider.model();
    let mut simulation = at_rest(&model, slider.dt_star);
    let mut by_hand = 0.0_f64;
    for _ in 0..1200 {
        let now = simulation.snapshot();
        for b in (0..625).filter(|&b| !model.surface.textured[b]) {
            by_hand = by_hand.max(now.block(b).contact_stress());
        }
        let found = simulation.contact_stress_max();
        assert!((found - by_hand).abs() < 1e-14, "{found}, by hand {by_hand}");
        simulation.step();
    }
    assert!(by_hand > 1.0);
}

/// Implicit and explicit friction with memory agree on the peak; without memory mu* never falls.
#[test]
fn two_readings_of_the_law_agree_and_the_literal_one_does_not() {
    let with = |law| Slider {
        law,
        dt_star: 0.02,
        ..Slider::default()
    };
    let (projection, reversal) = (
        with(FrictionLaw::Projection).onset(),
        with(FrictionLaw::Reversal).onset(),
    );
    let difference = (projection.mu_star - reversal.mu_star).abs();
    assert!(
        projection.ended && reversal.ended && difference < 1e-6,
        "{difference}"
    );
    let literal = with(FrictionLaw::Literal).run(8.0);
    assert!(!literal.peak.ended);
}

/// The peak with a frictionless groove, next to which blocks stop and start often, does not depend on the
/// friction law either.
#[test]
fn two_readings_agree_beside_a_groove() {
    let with = |law| {
        let slider = Slider {
            law,
            dt_star: 0.02,
            textures: vec![groove(Orientation::Across, 3.0)],
            ..Slider::default().uniform()
        };
        slider.onset().mu_star
    };
    let difference = (with(FrictionLaw::Projection) - with(FrictionLaw::Reversal)).abs();
    assert!(difference < 1e-3, "{difference}");
}

/// The largest contact stress includes only blocks in contact, however large the stress of a block over a
/// texture is.
#[test]
fn the_largest_contact_stress_leaves_textured_blocks_out() {
    let slider = textured();
    let model = slider.model();
    let mut u = VectorField::zeros(625);
    let middle = model.lattice.block(12, 12);
    u.x[middle] = 100.0;
    assert!(model.surface.textured[middle]);
    let torn = State {
        displacement: u,
        velocity: VectorField::zeros(625),
    };
    let simulation = from_state(&model, 0.1, torn);
    assert!(simulation.snapshot().block(middle).contact_stress() > 100.0);
    let largest = simulation.contact_stress_max();
    assert!(largest < 1e-12, "all others rest without a pull: {largest}");
}
