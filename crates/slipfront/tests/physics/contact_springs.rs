//! Springs between the blocks and the substrate, which break and form again.

use slipfront::communicator::Alone;
use slipfront::lattice::K_DRIVE;
use slipfront::observe::Curve;
use slipfront::surface::Coefficients;
use slipfront::surface::Load;
use slipfront::{ContactSprings, Drive, Friction, Lattice, Model, Surface, scales};
use test_case::test_matrix;

use crate::common::{Slider, at_rest, cavity};

/// Blocks whose thresholds are spread evenly over 1 - w to 1 + w, in an order without a pattern.
fn spread(w: f64, law: ContactSprings, damping: f64, v_star: f64) -> Model {
    let lattice = Lattice::free(20, 20);
    let n = lattice.n_blocks();
    // 7 and 400 have no common factor.
    let place = |b: usize| ((7 * b * 7 * 7 * 7 + 3) % n) as f64;
    let thresholds: Vec<f64> = (0..n)
        .map(|b| 1.0 + w * ((2.0 * place(b) + 1.0) / n as f64 - 1.0))
        .collect();
    let given = Coefficients::given(thresholds, vec![0.0; n]);
    let surface = Surface::new(given, vec![false; n], Load::Redistributed, 1.0).unwrap();
    Model::new(
        lattice,
        surface,
        Drive::along_x(v_star),
        damping,
        0.0,
        Friction::ContactSprings(law),
    )
}

/// Springs that slide pull with half the mean of their thresholds.
#[test_matrix([0.05, 0.1, 0.2], [None, Some(5)])]
fn the_level_of_sliding_is_half_the_mean_threshold(w: f64, redraw: Option<u64>) {
    let stiffness = 1e-3 * K_DRIVE;
    let (v_star, damping) = (2.5, scales::damping(0.5));
    let model = spread(w, ContactSprings { stiffness, redraw }, damping, v_star);
    assert!((model.steady_level(&Alone) - (0.5 + damping * v_star)).abs() < 1e-12);
}

/// Until the first spring breaks the slider moves as one against all of them: k_t u = k_t k_s V t/(k_t + k_s)
/// in equilibrium, about which it swings by the jerk of the start, at most V/w_0 with w_0^2 = k_s + k_t; the
/// step adds V dt.
#[test]
fn the_weakest_spring_breaks_first() {
    let law = ContactSprings {
        stiffness: 0.2,
        redraw: None,
    };
    let model = spread(0.2, law, 0.0, 1e-3);
    let mut simulation = at_rest(&model, 0.1);
    while simulation.snapshot().totals.n_slipping == 0 {
        simulation.step();
    }
    let found = simulation.time_star();
    let off = (found - model.first_slip_estimate(&Alone)).abs();
    assert!(
        off < 1.0 / (K_DRIVE + 0.2_f64).sqrt() * (1.0 + 0.2) + 0.1,
        "{off}"
    );
    assert_eq!(simulation.snapshot().earliest_first_slip(), Some(found));
    // Which block it was is known: the one of the least threshold.
    let weakest = (0..400).min_by(|&a, &b| model.surface.mu_static[a].total_cmp(&model.surface.mu_static[b]));
    assert!(!simulation.snapshot().first_slip_time_star()[weakest.unwrap()].is_nan());
}

/// The whole energy is found again: stored, lost to damping, or lost with the springs that broke, which is
/// threshold^2/(2 k_t) of each up to the overshoot of a step. The error falls with the square of the step.
#[test]
fn the_balance_of_energy_closes() {
    let error = |dt: f64| {
        let slider = Slider {
            blocks: [12, 10],
            textures: vec![cavity([12, 10], 12.0, 1, 0.2, false)],
            v_star: 0.1,
            degrees: 20.0,
            dt_star: dt,
            ..Slider::default()
        };
        let mut model = slider.model();
        let law = ContactSprings {
            stiffness: 0.3,
            redraw: Some(1),
        };
        model.friction = Friction::ContactSprings(law);
        let mut simulation = at_rest(&model, dt);
        let mut curve = Curve::every(1);
        slider.watch(&mut simulation, 20.0, &mut [&mut curve]);
        let energies = curve.rows.last().unwrap().energies;
        assert_eq!(energies.friction_loss, 0.0);
        assert!(energies.broken_springs_loss > 0.1 * energies.work && energies.contact_springs > 0.0);
        energies.error().abs()
    };
    let [coarse, fine] = [0.2, 0.05].map(error);
    assert!(coarse < 1e-2 && fine < 1e-3, "{coarse} {fine}");
}
