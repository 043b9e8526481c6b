//! Pressure that is not uniform, and friction that does not depend on pressure.

use slipfront::Edges;
use slipfront::Stop;
use slipfront::communicator::Alone;
use slipfront::exact_solutions::{Facing, groove_edge_factor};
use slipfront::surface::{Adhesion, Orientation};
use test_case::test_matrix;

use crate::common::{Slider, at_rest, groove};

fn adhesive(of_static: f64) -> Adhesion {
    Adhesion {
        of_static,
        of_kinetic: 0.0,
    }
}

/// Nothing moves before the first slip, so that the force is `k_s V t` on every block and the block with the
/// least threshold slips first: `k_s V t = min_i (mu_si p_i/P + tau_a/(P mu_s))`. The slip is seen at most a
/// step late.
#[test_matrix([None, Some((0, 0.8)), Some((1, -0.5))], [0.0, 0.4])]
fn the_weakest_block_slips_first(pressure: Option<(usize, f64)>, adhesion: f64) {
    let slider = Slider {
        pressure,
        adhesion: adhesive(adhesion),
        ..Slider::default()
    };
    let drawn = slider.coefficients();
    // p/P = 1 + slope (2 x/L - 1) at the centre of a block.
    let relative = |b: usize| {
        let place = |axis: usize| [b % 25, b / 25][axis] as f64;
        pressure.map_or(1.0, |(axis, slope)| {
            1.0 + slope * ((2.0 * place(axis) + 1.0) / 25.0 - 1.0)
        })
    };
    let threshold = |b: usize| drawn.mu_static[b].max(drawn.mu_kinetic[b]) * relative(b) + adhesion;
    let weakest = (0..625)
        .min_by(|&a, &b| threshold(a).total_cmp(&threshold(b)))
        .unwrap();
    let exact = threshold(weakest) / (0.375 * slider.v_star);
    let model = slider.model();
    assert!((model.first_slip_estimate(&Alone).unwrap() / exact - 1.0).abs() < 1e-14);
    let mut simulation = at_rest(&model, slider.dt_star);
    simulation.run(Stop::at_step(slider.steps(5.0)), &mut []).unwrap();
    let now = simulation.snapshot();
    let earliest = now.peak.first_slip_drive_time_star.unwrap();
    let late = earliest - exact;
    assert!(
        -1e-10 < late && late < slider.dt_star * (1.0 + 1e-9),
        "late by {late}"
    );
    assert_eq!(now.first_slip_time_star()[weakest], earliest);
}

/// Equal blocks slip in the same step: `mu_s* = 1 + tau_a/(P mu_s)`, exceeded by less than one step of the
/// pull.
#[test_matrix([0.0, 0.1, 1.5])]
fn adhesion_adds_to_static_friction_without_texture(adhesion: f64) {
    let slider = Slider {
        adhesion: adhesive(adhesion),
        ..Slider::default().uniform()
    };
    let peak = slider.run(4.0 * (1.0 + adhesion)).peak.mu_star;
    let below = 1.0 + adhesion - peak;
    let pull = 0.375 * slider.v_star * slider.dt_star;
    assert!(-1e-12 < below + pull && below < pull, "{peak}");
}

/// Only the adhesive part depends on the area that a groove leaves: the load is redistributed, the area is
/// not. The first slip comes at `k_s V t f = N/N_c + tau_a/(P mu_s)`, f the factor of the edge. It is later
/// by at most a step, and by the drag of the five free rows, at most Omega V* each; each edge bears half of
/// it.
#[test_matrix([(Facing::Across, Orientation::Across), (Facing::Along, Orientation::Along)], [0.25, 1.0])]
fn adhesion_is_not_redistributed((facing, orientation): (Facing, Orientation), adhesion: f64) {
    let slider = Slider {
        blocks: [20, 20],
        edges: [Edges::Periodic; 2],
        textures: vec![groove(orientation, 5.0)],
        adhesion: adhesive(adhesion),
        v_star: 1e-3,
        omega_star: 0.3,
        dt_star: 0.5,
        ..Slider::default().uniform()
    };
    let model = slider.model();
    let mut simulation = at_rest(&model, slider.dt_star);
    simulation.run(Stop::at_step(slider.steps(5.0)), &mut []).unwrap();
    let factor = groove_edge_factor(facing, 5);
    let exact = (20.0 / 15.0 + adhesion) / (0.375 * slider.v_star * factor);
    let found = simulation.peak().first_slip_drive_time_star.unwrap();
    let late = slider.dt_star + 2.5 * model.damping / (0.375 * factor);
    assert!(
        (found - exact).abs() < late,
        "{found}, exactly {exact}, to {late}"
    );
}
