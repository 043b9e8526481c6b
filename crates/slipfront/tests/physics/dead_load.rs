//! Dead loads: how they change the force that the drive must add, the acceleration that they cause, their
//! contribution to mu*, and their work.

use slipfront::communicator::Alone;
use slipfront::lattice::K_DRIVE;
use slipfront::observe::{Curve, Scheduled};
use slipfront::{
    DeadLoad, Drive, Edge, FrictionLaw, Lattice, Model, Simulation, Slider, State, Stop, Surface,
};
use test_case::test_case;

use crate::common::{self, at_rest};

/// A lattice without damping, pulled along `degrees` at `v_star`, with static friction of 1 and kinetic of
/// 0.5.
fn model([nx, ny]: [usize; 2], v_star: f64, degrees: f64) -> Model {
    let lattice = Lattice::free(nx, ny);
    let surface = Surface::uniform(&lattice, 1.0, 0.5);
    let drive = Drive::at_angle(v_star, degrees);
    Model::new(lattice, surface, drive, 0.0, 0.0, FrictionLaw::Projection)
}

/// The load `tau` along the drive of a model.
fn along(model: &Model, tau: f64) -> [f64; 2] {
    model.drive.direction.map(|d| tau * d)
}

fn first_slips(simulation: &mut Simulation, until_star: f64, dt: f64) -> Vec<f64> {
    let steps = (until_star / dt).ceil() as u64;
    simulation.run(Stop::at_step(steps), &mut []).unwrap();
    simulation.snapshot().first_slip_time_star()
}

/// The drive adds only the difference: k_s V t = mu_s - F_0. The slip is seen at the first instant after it.
#[test_case(0.0, 0.7)]
#[test_case(137.0, 0.7)]
#[test_case(30.0, -0.4; "against the drive")]
fn a_block_slips_when_drive_and_load_reach_its_threshold(degrees: f64, tau: f64) {
    let (v_star, dt) = (0.03, 0.1);
    let model = model([1, 1], v_star, degrees);
    let load = DeadLoad::uniform(along(&model, tau));
    let model = model.with_dead_load(load);
    let exact = (1.0 - tau) / (K_DRIVE * v_star);
    // Some rounding errors.
    assert!((model.first_slip_estimate(&Alone).unwrap() / exact - 1.0).abs() < 1e-14);
    let found = first_slips(&mut at_rest(&model, dt), 1.5 * exact, dt)[0];
    assert!(
        found > exact * (1.0 - 1e-12) && found <= exact + dt * (1.0 + 1e-9),
        "{found} {exact}"
    );
}

/// A load across the drive and the pull of the drive are the legs of a right triangle with the threshold as
/// hypotenuse: 0.6 of 1 leaves 0.8.
#[test]
fn a_load_across_the_drive_leaves_the_other_leg() {
    let (v_star, dt) = (0.03, 0.1);
    let model = model([1, 1], v_star, 0.0).with_dead_load(DeadLoad::uniform([0.0, -0.6]));
    let exact = 0.8 / (K_DRIVE * v_star);
    assert!((model.first_slip_estimate(&Alone).unwrap() / exact - 1.0).abs() < 1e-14);
    let mut simulation = at_rest(&model, dt);
    assert_eq!(simulation.snapshot().point.mu_lateral_star, -0.6);
    let found = first_slips(&mut simulation, 1.5 * exact, dt)[0];
    assert!(found > exact && found <= exact + dt, "{found} {exact}");
}

/// Blocks far from each other slip one by one in the order of the force that their loads leave, exactly as
/// each would alone: nothing has moved near them before. Blocks without drive spring slip at once, or never
/// by themselves.
#[test]
fn loads_that_differ_leave_each_block_its_own_pull() {
    let (v_star, dt) = (0.01, 0.05);
    let plain = model([60, 1], v_star, 0.0);
    let mut relative = vec![0.0; 60];
    (relative[10], relative[50]) = (0.9, 0.75);
    let load = DeadLoad::of_blocks([1.0, 0.0], relative.clone(), plain.slider(), &Alone);
    let model = plain.with_dead_load(load);
    let exact = 0.1 / (K_DRIVE * v_star);
    assert!((model.first_slip_estimate(&Alone).unwrap() / exact - 1.0).abs() < 1e-14);
    // The mean of all loads, each of which is rounded.
    assert!((at_rest(&model, dt).snapshot().point.mu_star - 1.65 / 60.0).abs() < 1e-16);
    let found = first_slips(&mut at_rest(&model, dt), exact + 2.0 * dt, dt);
    assert!(found[10] > exact && found[10] <= exact + dt);
    assert!(found.iter().enumerate().all(|(b, time)| b == 10 || time.is_nan()));

    // Only the left end is driven. A load beyond the threshold moves its block from the first instant on.
    let lattice = Lattice::free(60, 1);
    let mut body = Slider::default();
    body.attach_edge(&lattice, &(0..1), Edge::Left, &Alone);
    relative[50] = 1.1;
    let load = DeadLoad::of_blocks([1.0, 0.0], relative, &body, &Alone);
    let model = self::model([60, 1], v_star, 0.0)
        .with_slider(body)
        .with_dead_load(load);
    assert!(model.slips_at_once(50) && !model.slips_at_once(10));
    assert_eq!(model.first_slip_estimate(&Alone).unwrap(), 0.0);
    let found = first_slips(&mut at_rest(&model, dt), 1.0, dt);
    assert!(found[50] == 0.0 && found[10].is_nan(), "{found:?}");
}

/// Under a load beyond friction a = F_0 - mu_k. The scheme, with velocity 0 half a step before t = 0, gives
/// exactly u_n = a dt^2 n (n + 1)/2. mu* contains the sum of load and drive, and the load does work along the
/// whole path.
#[test_case(false)]
#[test_case(true; "given block by block")]
fn a_block_is_accelerated_by_what_friction_leaves(given: bool) {
    let (tau, dt, steps) = (1.25, 0.01, 500);
    let mut model = model([9, 2], 1e-9, 60.0);
    model.drive.k_drive = 0.0;
    let force = along(&model, 0.5 * tau);
    let load = if given {
        DeadLoad::of_blocks(force, vec![2.0; 18], model.slider(), &Alone)
    } else {
        DeadLoad::uniform(along(&model, tau))
    };
    let model = model.with_dead_load(load);
    let mut simulation = at_rest(&model, dt);
    let mut curve = Curve::every(1);
    simulation
        .run(Stop::at_step(steps), &mut [Scheduled::always(&mut curve)])
        .unwrap();
    let way = (tau - 0.5) * dt * dt * (steps * (steps + 1)) as f64 / 2.0;
    let state = simulation.state();
    for b in 0..18 {
        let [x, y] = state.displacement.at(b);
        // A rounding error in each of 500 steps, and of the springs, which only rounding errors stretch.
        assert!((x.hypot(y) / way - 1.0).abs() < 1e-12, "{x} {y} {way}");
    }
    let last = curve.rows.last().unwrap();
    assert!((last.point.mu_star - tau).abs() < 1e-15);
    assert!((last.energies.work / (18.0 * tau * way) - 1.0).abs() < 1e-12);
    // As for a constant force without friction, the scheme keeps the balance in every step, except for the
    // power of friction at t = 0, since the block has no velocity half a step before.
    assert!(last.energies.error().abs() < dt * dt, "{}", last.energies.error());
}

/// The balance closes while blocks slip and stop, as without a load: its error is proportional to the square
/// of the step.
#[test]
fn the_balance_of_energy_closes_with_a_load_on_a_varied_slider() {
    let error = |dt_star: f64| {
        let slider = common::Slider {
            blocks: [20, 10],
            body: common::varied(200, true),
            dt_star,
            ..common::Slider::default()
        };
        let model = slider.model();
        let relative = (0..200).map(|b| 0.4 + 0.3 * f64::from(b).sin()).collect();
        let load = DeadLoad::of_blocks([0.6, 0.2], relative, model.slider(), &Alone);
        let model = model.with_dead_load(load);
        let mut simulation = common::from_state(&model, dt_star, State::at_rest(200));
        let mut curve = Curve::every(1);
        let steps = (150.0 / dt_star) as u64;
        simulation
            .run(Stop::at_step(steps), &mut [Scheduled::always(&mut curve)])
            .unwrap();
        let last = curve.rows.last().unwrap();
        assert!(last.energies.friction_loss > 10.0, "blocks slide");
        last.energies.error().abs()
    };
    let [coarse, fine] = [error(0.1), error(0.025)];
    assert!(coarse < 1e-3 && fine < 0.2 * coarse, "{coarse:e} {fine:e}");
}

/// In steady sliding drive springs and load balance friction: mu* is L, for any load.
#[test]
fn steady_sliding_takes_the_level_of_sliding_with_any_load() {
    let level = |tau: f64| {
        let lattice = Lattice::free(5, 5);
        let surface = Surface::uniform(&lattice, 1.0, 0.6);
        let drive = Drive::along_x(0.1);
        let model = Model::new(lattice, surface, drive, 1.0, 0.0, FrictionLaw::Projection)
            .with_dead_load(DeadLoad::uniform([tau, 0.0]));
        let mut simulation = at_rest(&model, 0.1);
        simulation.run(Stop::at_step(3000), &mut []).unwrap();
        (simulation.snapshot().point.mu_star, model.steady_level(&Alone))
    };
    for tau in [0.0, 0.3, 0.9] {
        let (found, exact) = level(tau);
        // The oscillation after the onset has died away: exp(-Omega t/2) with t* of 200 and more.
        assert!((found - exact).abs() < 1e-12, "{tau}: {found} {exact}");
    }
}

/// The path to the onset is shorter by tau/k_2.
#[test]
fn an_onset_is_expected_as_much_earlier_as_the_load_bears() {
    let plain = model([5, 5], 0.03, 0.0);
    let [usual, _] = plain.onset_estimate(Some(1.0));
    let loaded = plain.clone().with_dead_load(DeadLoad::uniform([0.3, 0.1]));
    let [from, to] = loaded.onset_estimate(Some(1.0));
    let expected = usual - 0.3 / K_DRIVE / 0.03;
    assert!((from / expected - 1.0).abs() < 1e-14 && from == to);
    let beyond = plain.with_dead_load(DeadLoad::uniform([1.2, 0.0]));
    assert_eq!(beyond.onset_estimate(None), [0.0; 2]);
}
