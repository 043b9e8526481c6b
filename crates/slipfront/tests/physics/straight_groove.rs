//! A straight groove before anything slips: the load that the pull on the rows without contact adds to the
//! rows at the edge.

use slipfront::exact_solutions::{Facing, groove_edge_factor};
use slipfront::surface::Orientation;
use slipfront::{Edges, Stop};
use test_case::{test_case, test_matrix};

use crate::common::{Slider, at_rest, groove};

#[test_case(Facing::Across, 2.188312)]
#[test_case(Facing::Along, 1.611111)]
fn the_closed_form_has_the_tabulated_values(facing: Facing, factor: f64) {
    assert!((groove_edge_factor(facing, 5) - factor).abs() < 5e-7);
}

/// The blocks of the groove follow the drive with a constant lag and an oscillation that damping removes, so
/// that the *rate* at which the load of an edge row grows is exact; 1e-9 is rounding over the time between
/// two instants.
#[test_matrix(
    [(Facing::Across, Orientation::Across), (Facing::Along, Orientation::Along)],
    [1, 2, 5, 8],
    [0.0, 180.0]
)]
fn rows_beside_a_groove_bear_their_factor(
    (facing, orientation): (Facing, Orientation),
    n: usize,
    degrees: f64,
) {
    let blocks = match orientation {
        Orientation::Across => [20, 4],
        Orientation::Along => [4, 20],
    };
    let slider = Slider {
        blocks,
        edges: [Edges::Periodic; 2],
        textures: vec![groove(orientation, n as f64)],
        v_star: 1e-3,
        degrees,
        omega_star: 1.0,
        epsilon: 0.0,
        dt_star: 0.5,
        ..Slider::default().uniform()
    };
    let model = slider.model();
    let edge = model.surface.textured.iter().position(|&t| t).unwrap();
    let edge = edge
        - match orientation {
            Orientation::Across => 1,
            Orientation::Along => blocks[0],
        };
    let mut simulation = at_rest(&model, slider.dt_star);
    let mut loads = Vec::new();
    for _ in 0..2 {
        for _ in 0..800 {
            simulation.step();
        }
        let [x, y] = simulation.snapshot().block(edge).force_friction;
        assert!(y.abs() < 1e-12);
        loads.push(x.abs());
    }
    assert_eq!(
        simulation.snapshot().point.n_sliding,
        n * 4,
        "only the groove moves"
    );
    let rate = (loads[1] - loads[0]) / (400.0 * 0.375 * slider.v_star);
    let exact = groove_edge_factor(facing, n);
    assert!((rate / exact - 1.0).abs() < 1e-9, "{rate}, exactly {exact}");
}

/// The edge rows slip when the force on them reaches N/N_contact. The lag and the oscillation of the groove,
/// which the quasi-static answer leaves out, are of the order of V*.
#[test_case(Facing::Across, Orientation::Across)]
#[test_case(Facing::Along, Orientation::Along)]
fn the_first_slip_beside_a_groove_comes_as_much_earlier(facing: Facing, orientation: Orientation) {
    let slider = Slider {
        blocks: [20, 20],
        edges: [Edges::Periodic; 2],
        textures: vec![groove(orientation, 5.0)],
        v_star: 1e-3,
        omega_star: 0.3,
        dt_star: 0.5,
        ..Slider::default().uniform()
    };
    let model = slider.model();
    let mut simulation = at_rest(&model, slider.dt_star);
    simulation.run(Stop::at_step(slider.steps(2.5)), &mut []).unwrap();
    let exact = (20.0 / 15.0) / (0.375 * slider.v_star * groove_edge_factor(facing, 5));
    let found = simulation.peak().first_slip_drive_time_star.unwrap();
    assert!((found / exact - 1.0).abs() < 3e-3, "{found}, exactly {exact}");
}
