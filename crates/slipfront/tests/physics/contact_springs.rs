//! Springs between the blocks and the substrate, which break and form again.

use slipfront::communicator::Alone;
use slipfront::exact_solutions::{chain_slip_force, static_over_kinetic_of_springs};
use slipfront::lattice::{K_DRIVE, K_STRAIGHT};
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

/// With springs a thousand times softer than those of the drive the slider is rigid. The peak is off by the rise of friction, k_t V, in
/// the Omega/k_s by which the pull lags and in the step in which it is read, and by w/400, where the weakest of 400 springs lies. The mean
/// goes over 40 cycles, after ten that spread the phases of springs that keep their thresholds over 20 w cycles: the mean of 40 sawteeth,
/// 1/(4 40) off if all were cut at once, is off by an eighth of that over 20 w. The mean of 16000 thresholds that are drawn anew scatters
/// by w/sqrt(3 16000), and is given three times that.
#[test_matrix([0.05, 0.1, 0.2], [None, Some(5)])]
fn static_over_kinetic_friction_of_a_rigid_slider(w: f64, redraw: Option<u64>) {
    let stiffness = 1e-3 * K_DRIVE;
    let (v_star, dt, damping) = (2.5, 0.8, scales::damping(0.5));
    let model = spread(w, ContactSprings { stiffness, redraw }, damping, v_star);
    let viscous = damping * v_star;
    assert!((model.steady_level(&Alone) - (0.5 + viscous)).abs() < 1e-12);
    let mut simulation = at_rest(&model, dt);
    let steps_per_length = (1.0 / stiffness / v_star / dt) as u64;
    let (mut peak, mut sum, mut count) = (0.0_f64, 0.0, 0);
    for step in 0..50 * steps_per_length {
        let force = simulation.snapshot().point.mu_star - viscous;
        // The slider begins at rest and is at its speed long before the first spring breaks.
        if step > steps_per_length / 2 {
            peak = peak.max(force);
        }
        if step >= 10 * steps_per_length {
            sum += force;
            count += 1;
        }
        simulation.step();
    }
    let found = peak / (sum / f64::from(count));
    let exact = static_over_kinetic_of_springs(w, redraw.is_some());
    let peak = 1e-3 * v_star * (damping + K_DRIVE * dt) + w / 400.0;
    let scatter = redraw.map_or(0.0, |_| 3.0 * w / (3.0_f64 * 16000.0).sqrt());
    let tolerance = peak / (1.0 - w) + 1.0 / (160.0 * 8.0 * 20.0 * w) + scatter;
    assert!(
        (found / exact - 1.0).abs() < tolerance,
        "{found}, exactly {exact}, to {tolerance}"
    );
}

/// Until the first spring breaks the slider moves as one against all of them: k_t u = k_t k_s V t/(k_t + k_s) in equilibrium, about which it
/// swings by the jerk of the start, at most V/w_0 with w_0^2 = k_s + k_t; the step adds V dt.
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

/// A chain that is pulled at its first block alone is in equilibrium until the spring there breaks: displacements decay along the chain.
/// The drive is slow and damping critical for the chain as a whole. Its viscous force is Omega V times the displacements of all
/// blocks over that of the first, which is the exact force, and the pull grows by k_s V dt in a step.
#[test_matrix([1, 2, 5, 20])]
fn the_first_block_of_a_chain_that_is_pulled_there_breaks(n: usize) {
    let (stiffness, v_star, dt) = (0.1, 2e-4, 0.2);
    let lattice = Lattice::free(n, 1);
    let law = ContactSprings {
        stiffness,
        redraw: None,
    };
    let surface = Surface::uniform(&lattice, 1.0, 0.0);
    let friction = Friction::ContactSprings(law);
    let mut slider = slipfront::Slider::default();
    slider.attach(n, |b| b == 0, &Alone);
    let model = Model::new(lattice, surface, Drive::along_x(v_star), 0.5, 0.0, friction).with_slider(slider);
    let mut simulation = at_rest(&model, dt);
    while simulation.snapshot().totals.n_slipping == 0 {
        simulation.step();
    }
    let now = simulation.snapshot();
    let found = now.block(0).force_drive[0];
    let exact = chain_slip_force(n, K_STRAIGHT, stiffness);
    let tolerance = v_star * (0.5 * exact + K_DRIVE * dt);
    assert!((found - exact).abs() < tolerance, "{found}, exactly {exact}");
    let slipped = now.first_slip_time_star();
    assert!(!slipped[0].is_nan() && slipped[1..].iter().all(|time| time.is_nan()));
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
