//! A slider that is driven at an edge: its drive springs, and its precursors.

use slipfront::communicator::Alone;
use slipfront::observe::{Curve, Precursors, Scheduled};
use slipfront::{Edge, Model, Stop};
use test_case::{test_case, test_matrix};

use crate::common::{Slider, at_rest};

/// A model with drive springs on one edge that have this stiffness in total.
fn driven_at(edge: Edge, slider: &Slider, total: f64) -> Model {
    let lattice = slider.lattice();
    let mut body = slider.body.clone();
    body.attach_edge(&lattice, &(0..lattice.ny), edge, &Alone);
    let slider = Slider {
        body,
        ..slider.clone()
    };
    let mut model = slider.model();
    model.drive.k_drive = total / [lattice.ny, lattice.nx][edge.axis()] as f64;
    model
}

/// Until the first slip the drive acts only on the driven blocks: `mu* = K V t/N`. The first of them slips
/// when its own spring pulls with its threshold, at most a step late.
#[test_matrix([Edge::Left, Edge::Right, Edge::Bottom, Edge::Top], [0.5, 30.0])]
fn the_weakest_driven_block_slips_first(edge: Edge, total: f64) {
    let slider = Slider {
        blocks: [14, 9],
        degrees: 20.0,
        ..Slider::default()
    };
    let lattice = slider.lattice();
    let model = driven_at(edge, &slider, total);
    let drawn = slider.coefficients();
    let driven = (0..lattice.n_blocks()).filter(|&b| edge.distance(&lattice, b) == 0);
    let threshold = |b: usize| drawn.mu_static[b].max(drawn.mu_kinetic[b]);
    let weakest = driven
        .min_by(|&a, &b| threshold(a).total_cmp(&threshold(b)))
        .unwrap();
    let exact = threshold(weakest) / (model.drive.k_drive * slider.v_star);
    assert!((model.first_slip_estimate(&Alone).unwrap() / exact - 1.0).abs() < 1e-14);
    let mut simulation = at_rest(&model, slider.dt_star);
    while simulation.snapshot().totals.n_slipping == 0 {
        let now = simulation.snapshot();
        let pull = total * slider.v_star * now.time_star / 126.0;
        assert!(
            (now.point.mu_star - pull).abs() < 1e-14,
            "{} {pull}",
            now.point.mu_star
        );
        simulation.step();
    }
    let now = simulation.snapshot();
    let late = now.time_star - exact;
    assert!(
        -1e-10 < late && late < slider.dt_star * (1.0 + 1e-9),
        "late by {late}"
    );
    assert_eq!(now.first_slip_time_star()[weakest], now.time_star);
}

/// Springs on all blocks load as fast as springs on one edge with the same total stiffness. For the plain
/// slider the loading speed is V* to the last bit.
#[test]
fn waiting_times_are_counted_in_the_speed_of_loading() {
    let slider = Slider::default();
    assert_eq!(slider.model().loading_speed().to_bits(), slider.v_star.to_bits());
    let model = driven_at(Edge::Left, &slider, 2.0);
    let expected = slider.v_star * 2.0 / (0.375 * 625.0);
    assert!((model.loading_speed() / expected - 1.0).abs() < 1e-15);
}

/// In steady sliding the blocks move with the drive, and mu* is the level of a slider driven everywhere: the
/// sum of the forces on all blocks is the same. The motion is overdamped, so that the level is reached:
/// alone, the drive springs would let deviations decay at K/(N Omega), and the slider along its length at
/// (pi/2 n_x)^2 k_1/Omega; the test waits until both in series have reduced deviations to exp(-12).
#[test]
fn the_level_of_steady_sliding_does_not_depend_on_the_place_of_the_drive() {
    let slider = Slider {
        blocks: [8, 3],
        omega_star: 1.5,
        v_star: 0.2,
        ..Slider::default()
    };
    let model = driven_at(Edge::Right, &slider, 3.0);
    let slowest = 24.0 * model.damping / 3.0 + (16.0 / std::f64::consts::PI).powi(2) * model.damping / 0.75;
    let duration = 12.0 * slowest + 2.5 / model.loading_speed();
    let mut simulation = at_rest(&model, slider.dt_star);
    simulation
        .run(Stop::at_step((duration / slider.dt_star) as u64), &mut [])
        .unwrap();
    let mu_star = simulation.snapshot().point.mu_star;
    assert!(
        (mu_star / model.steady_level(&Alone) - 1.0).abs() < 1e-4,
        "{mu_star}, exactly {}",
        model.steady_level(&Alone)
    );
}

/// The work of the drive at an edge is stored or lost. Because of blocks that stop, the balance falls short,
/// in proportion to the square of the step.
#[test]
fn energy_is_accounted_for() {
    let error = |dt_star: f64| {
        let slider = Slider {
            blocks: [30, 4],
            v_star: 0.5,
            dt_star,
            ..Slider::default()
        };
        let model = driven_at(Edge::Left, &slider, 4.0);
        let mut curve = Curve::every(u64::MAX);
        let mut simulation = at_rest(&model, dt_star);
        simulation
            .run(
                Stop::at_step((120.0 / dt_star) as u64),
                &mut [Scheduled::always(&mut curve)],
            )
            .unwrap();
        let energies = curve.rows.last().unwrap().energies;
        println!("{dt_star} {:e}", energies.error());
        assert!(energies.work > 1.0 && energies.friction_loss > 0.4 * energies.work);
        energies.error().abs()
    };
    // The order of the method is two. Events at other steps scatter its constant, so that the test requires a
    // factor of 8 instead of 16.
    let (coarse, fine) = (error(0.1), error(0.025));
    assert!(coarse < 1e-2 && fine < coarse / 8.0, "{coarse:e} {fine:e}");
}

/// A slider of equal blocks that slides long enough for some events.
fn eventful() -> Slider {
    Slider {
        blocks: [25, 6],
        v_star: 0.05,
        ..Slider::default().uniform()
    }
}

/// A chain under a pressure that varies along it; halves of the pressures and their differences are exact.
fn chain() -> Slider {
    Slider {
        blocks: [128, 1],
        pressure: Some((0, 0.833)),
        body: slipfront::Slider {
            viscosity_time: 0.365,
            ..slipfront::Slider::default()
        },
        v_star: 1.0,
        r_star: 0.45 / 0.7,
        omega_star: 0.0,
        dt_star: 0.4,
        ..Slider::default().uniform()
    }
}

/// A mirrored slider that is driven at the opposite edge in the opposite direction is the mirror image, with
/// the same bits, including events, whether it is pulled or pushed.
#[test_case(eventful(), 3.0, [180.0, 0.0], 5000)]
#[test_case(chain(), 0.242 / 128.0, [0.0, 180.0], 100_000)]
fn the_mirror_image_of_an_edge_is_the_edge_opposite(
    slider: Slider,
    total: f64,
    degrees: [f64; 2],
    steps: u64,
) {
    let [left, right] = [(Edge::Left, 1.0), (Edge::Right, -1.0)].map(|(edge, sign)| {
        let slider = Slider {
            degrees: degrees[usize::from(edge == Edge::Right)],
            pressure: slider.pressure.map(|(axis, slope)| (axis, sign * slope)),
            ..slider.clone()
        };
        let mut precursors = Precursors::new(edge);
        let mut simulation = at_rest(&driven_at(edge, &slider, total), slider.dt_star);
        simulation
            .run(Stop::at_step(steps), &mut [Scheduled::always(&mut precursors)])
            .unwrap();
        (simulation.state().displacement, precursors)
    });
    let [nx, ny] = slider.blocks;
    for b in 0..nx * ny {
        let mirrored = b / nx * nx + nx - 1 - b % nx;
        let [x, y] = left.0.at(b);
        assert_eq!(right.0.at(mirrored), [-x, y], "block {b}");
    }
    assert!(left.1.events().len() > 5);
    assert_eq!(left.1.events(), right.1.events());
}

/// The load of a chain that has been crossed grows no further: at mu_s = 0.7 and mu_k = 0.45 its distance
/// from 0.45 never exceeds the threshold of the last block, plus the gain of the driven block before it slips
/// again, plus the load that the drive adds while sound travels there and back. `slipfront family` checks the
/// events before that to the same tolerance.
#[test_matrix([0.0, 0.833, -0.833])]
fn a_chain_that_was_crossed_bears_no_more_than_kinetic_friction(slope: f64) {
    let n = 100;
    let slider = Slider {
        blocks: [n, 1],
        pressure: Some((0, slope)),
        ..chain()
    };
    let model = driven_at(Edge::Left, &slider, 0.242 / n as f64);
    // Until the springs would pull a slider at rest with 1.3 times the kinetic friction of the whole chain.
    let duration = 1.3 * slider.r_star / (0.375 * model.loading_speed());
    let mut simulation = at_rest(&model, slider.dt_star);
    let stop = Stop::at_step((duration / slider.dt_star) as u64);
    simulation.run(stop, &mut []).unwrap();
    let peak = 0.7 * simulation.peak().largest.mu_star;
    let crossing = 2.0 * 0.242 / 0.75_f64.sqrt();
    let most = (0.7 * (1.0 + slope + crossing) + (0.7 - 0.45) * (1.0 - slope)) / n as f64;
    assert!((peak - 0.45).abs() < most, "{peak}, at most {most} from 0.45");
}
