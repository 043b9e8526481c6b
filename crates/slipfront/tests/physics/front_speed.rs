//! Slip fronts under a uniform prestress run at c/sqrt(1 - tau^2).

use slipfront::exact_solutions::{Facing, front_speed};
use slipfront::lattice::K_STRAIGHT;
use slipfront::observe::Front;
use slipfront::{DeadLoad, Drive, Edges, FrictionLaw, Lattice, Model, State, Stop, Surface};
use test_case::{test_case, test_matrix};

use crate::common::{at_rest, from_state};

const COLUMNS: usize = 80;
const KINETIC: f64 = 0.25;

/// A strip of columns under a dead load of prestress `tau`; its first column has
/// no static friction.
fn strip(columns: usize, rows: usize, direction: [f64; 2], tau: f64) -> Model {
    let edges = if rows == 1 { Edges::Free } else { Edges::Periodic };
    let lattice = Lattice::with_edges(columns, rows, [Edges::Free, edges]);
    let mut surface = Surface::uniform(&lattice, 1.0, KINETIC);
    for j in 0..rows {
        surface.mu_static[lattice.block(0, j)] = 0.0;
    }
    let force = KINETIC + tau * (1.0 - KINETIC);
    let drive = Drive {
        v_star: 0.0,
        direction,
        k_drive: 0.0,
        ..Drive::along_x(0.0)
    };
    Model::new(lattice, surface, drive, 0.0, 0.0, FrictionLaw::Projection)
        .with_dead_load(DeadLoad::uniform(direction.map(|d| force * d)))
}

/// Time for which the front stays at a column, over the second half of the strip.
fn measured_delay(model: &Model, dt: f64, expected: f64) -> f64 {
    let steps = (1.2 * COLUMNS as f64 * expected / dt) as u64;
    let mut simulation = at_rest(model, dt);
    simulation.run(Stop::at_step(steps), &mut []).unwrap();
    let first = simulation.snapshot().first_slip_time_star();
    let (from, to) = (COLUMNS / 2, COLUMNS - 10);
    (first[to] - first[from]) / (to - from) as f64
}

/// A steady front takes a whole number of steps from one column to the next, the nearest to the exact time:
/// hence half a step, 0.2 to 0.6 % of that time.
#[test_matrix(
    [0.6, 0.8, 0.9],
    [
        (1, [1.0, 0.0], K_STRAIGHT), (3, [1.0, 0.0], Facing::Across.row_stiffness()),
        (3, [0.0, 1.0], Facing::Along.row_stiffness())
    ]
)]
fn a_front_runs_at_its_speed(tau: f64, (rows, direction, stiffness): (usize, [f64; 2], f64)) {
    let dt = 0.005;
    let exact = 1.0 / front_speed(stiffness.sqrt(), tau);
    let found = measured_delay(&strip(COLUMNS, rows, direction, tau), dt, exact);
    assert!(
        (found - exact).abs() < 0.55 * dt,
        "{found} per column, exactly {exact}"
    );
}

/// The speed of a run, computed from planes through its first slips. Under a low prestress the front must be
/// started, by five columns that move at the start. It accelerates over the more columns, the lower the
/// prestress; the strip is several times as long, so that they do not affect the median. The remaining error
/// is half a step, as above.
#[test_matrix(
    [0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9],
    [
        (1, [1.0, 0.0], K_STRAIGHT), (3, [1.0, 0.0], Facing::Across.row_stiffness()),
        (3, [0.0, 1.0], Facing::Along.row_stiffness())
    ]
)]
fn planes_find_the_speed_of_a_front(tau: f64, (rows, direction, stiffness): (usize, [f64; 2], f64)) {
    let columns = match tau {
        ..0.25 => 240,
        ..0.35 => 160,
        _ => COLUMNS,
    };
    let (dt, exact) = (0.005, front_speed(stiffness.sqrt(), tau));
    let model = strip(columns, rows, direction, tau);
    let mut state = State::at_rest(model.lattice.n_blocks());
    let started = 0.5 * (1.0 - KINETIC) / stiffness.sqrt();
    for b in (0..state.velocity.x.len()).filter(|b| b % columns < 5) {
        state.velocity.x[b] = started * direction[0];
        state.velocity.y[b] = started * direction[1];
    }
    let steps = (1.2 * columns as f64 / (exact * dt)) as u64;
    let mut simulation = from_state(&model, dt, state);
    simulation.run(Stop::at_step(steps), &mut []).unwrap();
    let times = simulation.into_first_slip_time_star();
    let front = Front::find(&model.lattice, &times, times.len()).unwrap();
    let speed = front.speed.unwrap().median;
    assert!((speed / exact - 1.0).abs() < 0.01, "{speed}, exactly {exact}");
    assert_eq!(front.nucleations, [0]);
}

/// Ratios to the speed of long waves that `docs/validation/family.md` gives.
#[test_case(0.6, 1.25)]
#[test_case(0.8, 1.6667)]
#[test_case(0.9, 2.2942)]
fn the_closed_form_has_the_tabulated_values(tau: f64, factor: f64) {
    assert!((front_speed(1.0, tau) - factor).abs() < 5e-5);
}
