//! The largest stable time step.

use slipfront::communicator::Alone;
use slipfront::lattice::{K_DRIVE, dt_star_limit};
use slipfront::{Drive, Edges, FrictionLaw, Lattice, Model, Slider, State, Surface};
use test_case::{test_case, test_matrix};

use crate::common::{from_state, thrown, varied};

fn floating(edges: Edges, slider: Slider) -> Model {
    let lattice = Lattice::with_edges(6, 4, [edges; 2]);
    let surface = Surface::uniform(&lattice, 0.0, 0.0);
    let drive = Drive::along_x(0.0);
    Model::new(lattice, surface, drive, 0.0, 0.0, FrictionLaw::Projection).with_slider(slider)
}

/// Largest displacement during the last steps of a run in steps of `dt`, from displacements of at most 1.
fn growth(model: &Model, dt: f64, steps: usize) -> f64 {
    let mut state = thrown(24, 1.0, 1);
    state.velocity = State::at_rest(24).velocity;
    let mut simulation = from_state(model, dt, state);
    let mut largest = 0.0_f64;
    for step in 0..steps {
        simulation.step();
        if step + 20 > steps {
            let u = simulation.state().displacement;
            let size = |u: &f64| if u.is_finite() { u.abs() } else { f64::INFINITY };
            largest = u.x.iter().chain(&u.y).map(size).fold(largest, f64::max);
        }
    }
    largest
}

/// Equal blocks with periodic edges have a wave that reaches the bound: the bound is sharp. At 0.999 of the
/// limit the undamped oscillation beats with an amplitude of 1/sqrt(1 - (dt/limit)^2) = 22, for each of the
/// waves in the initial state.
#[test_case(0.0, 0.9058)]
#[test_case(0.365, 0.6295)]
#[test_case(2.0, 0.21025)]
fn the_bound_of_equal_blocks_is_strict(viscosity_time: f64, limit: f64) {
    let slider = Slider {
        viscosity_time,
        ..Slider::default()
    };
    let model = floating(Edges::Periodic, slider);
    let found = model.stable_step_limit(&Alone);
    assert!((found - limit).abs() < 5e-5, "{found}");
    assert!(found <= dt_star_limit());
    assert!(growth(&model, 0.999 * found, 4000) < 100.0);
    assert!(growth(&model, 1.01 * found, 4000) > 1e6);
}

/// Heavy, soft blocks do not raise the limit; light, stiff blocks lower it: lambda_max = 4.5 E/rho + k_s
/// E/rho.
#[test_case(0.1, 1.0, 0.9058)]
#[test_case(4.0, 1.0, 0.4529)]
#[test_case(2.0, 0.125, 0.22645)]
fn stiffness_over_density_decides(stiffness: f64, density: f64, limit: f64) {
    let slider = Slider::new(
        Some(vec![stiffness; 24]),
        Some(vec![density; 24]),
        None,
        &slipfront::communicator::Alone,
    );
    let found = floating(Edges::Periodic, slider).stable_step_limit(&Alone);
    assert!((found - limit).abs() < 5e-5, "{found}");
}

/// The bound is safe for heterogeneous blocks. A light block among heavy ones oscillates alone, with half of
/// the contribution that the bound assumes for its neighbours: the bound is too strict by the square root of
/// 2, or by 2 where the dampers decide.
#[test_matrix([0.0, 0.2], [0.02, 0.5])]
fn the_bound_of_unequal_blocks_is_safe(viscosity_time: f64, lightest: f64) {
    let mut slider = varied(24, false);
    let density = (0..24).map(|b| lightest + f64::from(b * b % 7)).collect();
    slider.density = Some(density);
    slider.viscosity_time = viscosity_time;
    let model = floating(Edges::Free, slider);
    let limit = model.stable_step_limit(&Alone);
    assert!(limit < dt_star_limit());
    assert!(growth(&model, 0.999 * limit, 4000) < 100.0);
    assert!(growth(&model, 2.1 * limit, 4000) > 1e6);
}

/// A single block is held by its drive spring: 2/sqrt(k_s) = 3.27 exceeds the limit that applies to all
/// sliders.
#[test]
fn no_slider_exceeds_the_limit_of_the_paper() {
    let lattice = Lattice::free(1, 1);
    let surface = Surface::uniform(&lattice, 1.0, 0.5);
    let model = Model::new(
        lattice,
        surface,
        Drive::along_x(0.03),
        0.0,
        0.0,
        FrictionLaw::Projection,
    );
    assert_eq!(model.stable_step_limit(&Alone), dt_star_limit());
    assert!((slipfront::stability::stable_step(0.0, K_DRIVE, 0.0) - 3.266).abs() < 1e-3);
}
