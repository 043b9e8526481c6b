//! Steady sliding: mu_k* = mean(mu_ki)/mu_s + sqrt(3/4) Omega* V*, once damping is strong.

use slipfront::communicator::Alone;
use slipfront::exact_solutions::steady_level;
use slipfront::surface::{Adhesion, Load};
use test_case::test_case;

use crate::common::{Slider, cavity};

/// Every block slides and the slider settles to the level exponentially, at the slowest with
/// k_s/Omega = 0.014 to 0.2 per unit of time: by 20/V* the transition has decayed below 1e-9. (At Omega* = 1
/// a few blocks with high friction keep sticking for very long, which the tests of the paper's claims allow
/// for.)
#[test_case(Slider { omega_star: 2.0, ..Slider::default() })]
#[test_case(Slider { omega_star: 3.0, ..Slider::default() })]
#[test_case(Slider { omega_star: 3.0, v_star: 0.1, ..Slider::default() })]
#[test_case(Slider { omega_star: 30.0, v_star: 0.01, dt_star: 0.5, ..Slider::default() })]
#[test_case(Slider { omega_star: 2.0, r_star: 0.75, degrees: 40.0, ..Slider::default() })]
#[test_case(Slider { omega_star: 2.0, textures: vec![cavity([25, 25], 12.0, 1, 0.3, false)], ..Slider::default() })]
#[test_case(
    Slider { omega_star: 2.0, load: Load::Kept, textures: vec![cavity([25, 25], 12.0, 1, 0.3, false)], ..Slider::default() }
)]
#[test_case(
    Slider { omega_star: 2.0, pressure: Some((0, 0.7)), adhesion: Adhesion { of_static: 0.3, of_kinetic: 0.2 }, ..Slider::default() }
)]
#[test_case(
    Slider { omega_star: 2.0, pressure: Some((1, -0.4)), adhesion: Adhesion { of_static: 0.3, of_kinetic: 0.2 }, textures: vec![cavity([25, 25], 12.0, 1, 0.3, false)], ..Slider::default() }
)]
fn strong_damping_ends_in_steady_sliding(slider: Slider) {
    let surface = slider.surface();
    let n = surface.n_blocks();
    let mean = (0..n)
        .map(|b| surface.mu_kinetic[b] * surface.normal_force(b))
        .sum::<f64>()
        / n as f64
        + slider.adhesion.of_kinetic * surface.n_contact() as f64 / n as f64;
    let exact = steady_level(mean, slider.omega_star, slider.v_star);
    assert!((slider.model().steady_level(&Alone) - exact).abs() < 1e-13);
    let outcome = slider.run(20.0);
    let last = outcome.rows.last().unwrap().point;
    assert!((last.mu_star - exact).abs() < 1e-9, "{} {exact}", last.mu_star);
    assert_eq!(last.sliding_percent, 100.0);
    // The window opens before the transition has decayed completely.
    let kinetic = outcome.kinetic.unwrap();
    assert!(
        (kinetic.mu_star - exact).abs() < 1e-3,
        "{} {exact}",
        kinetic.mu_star
    );
    assert_eq!(kinetic.sliding_percent, 100.0);
}
