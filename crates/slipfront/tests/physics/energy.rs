//! Energy: the work of the drive is stored in blocks and springs or lost to friction and damping. For one
//! block each loss is known exactly.

use slipfront::communicator::Alone;
use slipfront::exact_solutions::SlipCycle;
use slipfront::observe::energy::Energies;
use slipfront::observe::{Curve, Scheduled};
use slipfront::{DeadLoad, Drive, Edges, FrictionLaw, Lattice, Model, State, Stop, Surface, VectorField};
use test_case::{test_case, test_matrix};

use crate::common::{Slider, cavity, from_state, thrown};

fn energies(model: &Model, dt: f64, steps: u64, state: State) -> Vec<Energies> {
    let mut curve = Curve::every(1);
    from_state(model, dt, state)
        .run(Stop::at_step(steps), &mut [Scheduled::always(&mut curve)])
        .unwrap();
    curve.rows.iter().map(|row| row.energies).collect()
}

/// Through onset and far beyond. The balance misses the kinetic energy that a block loses in the last step of
/// a slip, at most (mu_k F_n dt)^2/2 = 5e-5, in slips that dissipate R V T = 1 each: a few 1e-5. It is less
/// where few blocks stop because of strong damping.
#[test_case(Slider { dt_star: 0.02, ..Slider::default() }, 5e-5; "baseline")]
#[test_case(Slider { dt_star: 0.02, omega_star: 0.0, ..Slider::default() }, 5e-5; "undamped")]
#[test_case(Slider { dt_star: 0.02, omega_star: 3.0, ..Slider::default() }, 1e-5; "steady")]
#[test_case(
    Slider { dt_star: 0.02, textures: vec![cavity([12, 14], 10.0, 1, 0.0, false)], ..Slider::default() }, 5e-5
    ; "textured"
)]
#[test_case(
    Slider { dt_star: 0.02, edges: [Edges::Periodic; 2], degrees: 30.0, ..Slider::default() }, 5e-5
    ; "periodic and oblique"
)]
#[test_case(Slider { dt_star: 0.02, epsilon: 0.03, ..Slider::default() }, 5e-5; "large strain")]
fn the_ledger_closes(slider: Slider, bound: f64) {
    let slider = Slider {
        blocks: [12, 14],
        ..slider
    };
    let model = slider.model();
    let at_rest = State::at_rest(model.lattice.n_blocks());
    let found = energies(&model, slider.dt_star, slider.steps(8.0), at_rest);
    let last = found.last().unwrap();
    assert!(last.work > 0.0 && last.friction_loss > 0.0);
    let worst = found
        .iter()
        .skip(found.len() / 4)
        .map(|e| e.error().abs())
        .fold(0.0, f64::max);
    assert!(worst < bound, "closes to {worst}");
}

/// While all blocks slide, the balance misses only the errors of the first and the present step, and nothing
/// accumulates in between. The bound is for the rounding of 400 steps of sums over 20 blocks, each with some
/// units in the last place.
#[test]
fn errors_of_sliding_cancel_between_the_first_step_and_the_present_one() {
    let slider = Slider {
        blocks: [5, 4],
        v_star: 3.0,
        epsilon: 0.0,
        dt_star: 0.1,
        ..Slider::default()
    };
    let model = slider.model();
    let mut state = thrown(20, 0.5, 1);
    state.velocity.x.iter_mut().for_each(|v| *v += 3.0);
    let found = energies(&model, slider.dt_star, 400, state.clone());
    let mut before = state.velocity.clone();
    let mut simulation = from_state(&model, slider.dt_star, state);
    let mut first = None;
    let mut largest = 0.0_f64;
    for energies in &found {
        let now = simulation.snapshot();
        assert_eq!(now.totals.n_slipping, 20);
        let mut sum = 0.0;
        for b in 0..20 {
            let block = now.block(b);
            for axis in 0..2 {
                let force = block.force_drive[axis] + block.force_lattice[axis];
                sum += force * (block.velocity[axis] - before.at(b)[axis]);
            }
        }
        let first = *first.get_or_insert(sum);
        let missing = 0.25 * slider.dt_star * (first - sum);
        let supplied = energies.work.abs() + energies.stored_at_start;
        let bound = 1e-12 * supplied;
        assert!(
            (energies.error() * supplied - missing).abs() < bound,
            "step {}",
            now.step
        );
        largest = largest.max(missing.abs() / bound);
        before = simulation.state().velocity;
        simulation.step();
    }
    assert!(largest > 1e6, "{largest}");
}

/// Before the first slip all work is in the drive springs: N (1/2) k_s (V t)^2 exactly. The trapezoidal rule
/// integrates the work exactly.
#[test]
fn before_the_first_slip_all_work_is_in_the_drive_springs() {
    let slider = Slider::default();
    let model = slider.model();
    let steps = (model.first_slip_estimate(&Alone).unwrap() / slider.dt_star) as u64;
    let found = energies(&model, slider.dt_star, steps, State::at_rest(625));
    for (n, e) in found.iter().enumerate() {
        let reach = slider.v_star * n as f64 * slider.dt_star;
        let exact = 625.0 * 0.5 * 0.375 * reach * reach;
        assert!(
            (e.stored.drive_springs - exact).abs() <= 1e-12 * exact
                && (e.work - exact).abs() <= 1e-12 * exact
        );
        assert_eq!(
            (
                e.stored.kinetic,
                e.stored.lattice,
                e.friction_loss,
                e.damping_loss
            ),
            (0.0, 0.0, 0.0, 0.0)
        );
    }
}

/// One slip of one block: friction dissipates R V T, damping the rest of the drive's work (`SlipCycle`).
#[test_matrix([0.0, 0.1, 0.3], [0.03, 0.1])]
fn losses_of_one_slip(omega_star: f64, v_star: f64) {
    let slider = Slider {
        blocks: [1, 1],
        omega_star,
        v_star,
        dt_star: 1e-3,
        ..Slider::default().uniform()
    };
    let exact = SlipCycle::new(omega_star, 0.5, v_star);
    let until = exact.onset_time_star() + 0.5 * exact.slip_duration() + 0.5 * exact.period();
    let model = slider.model();
    let steps = (until / slider.dt_star) as u64;
    let found = *energies(&model, slider.dt_star, steps, State::at_rest(1))
        .last()
        .unwrap();
    // The slip starts up to a step late, and its duration differs by a relative error of up to k_s V
    // dt/(1 - R).
    let tolerance = 2.0 * slider.dt_star;
    let ratio = found.friction_loss / exact.friction_loss();
    assert!((ratio - 1.0).abs() < tolerance, "{ratio}");
    if omega_star > 0.0 {
        let ratio = found.damping_loss / exact.damping_loss();
        assert!((ratio - 1.0).abs() < tolerance, "{ratio}");
    } else {
        assert_eq!(found.damping_loss, 0.0);
    }
}

/// A block with friction alone moves by v^2/(2 mu_k) and loses all of (1/2) v^2 to friction; a block with
/// damping alone moves by v/Omega and loses (1/2) v^2 to damping.
#[test_case(0.5, 0.0; "friction")]
#[test_case(0.0, 0.4; "damping")]
fn a_thrown_block_loses_all_its_energy_to_the_one_loss(kinetic: f64, omega: f64) {
    let lattice = Lattice::free(1, 1);
    let drive = Drive {
        k_drive: 0.0,
        ..Drive::along_x(0.0)
    };
    let model = Model::new(
        lattice,
        Surface::uniform(&lattice, 1.0, kinetic),
        drive,
        omega,
        1e-6,
        FrictionLaw::Projection,
    );
    let velocity = VectorField {
        x: vec![0.6],
        y: vec![-0.8],
    };
    let dt = 1e-3;
    let thrown = State {
        displacement: VectorField::zeros(1),
        velocity,
    };
    let mut simulation = from_state(&model, dt, thrown.clone());
    assert!(simulation.snapshot().block(0).slides);
    let found = energies(&model, dt, 100_000, thrown);
    simulation.run(Stop::at_step(100_000), &mut []).unwrap();
    let last = found.last().unwrap();
    let [x, y] = simulation.state().displacement.at(0);
    let (way, loss, other) = if omega > 0.0 {
        (1.0 / omega, last.damping_loss, last.friction_loss)
    } else {
        (1.0 / (2.0 * kinetic), last.friction_loss, last.damping_loss)
    };
    // The velocity is given half a step before t = 0: this adds v dt/2 to the displacement, and the loss over
    // it.
    assert!((x.hypot(y) - way).abs() < dt, "{} {way}", x.hypot(y));
    assert!((y / x + 4.0 / 3.0).abs() < 1e-12, "it keeps its direction");
    assert!((loss - 0.5).abs() < dt && other == 0.0, "{loss}");
    assert!(last.stored.kinetic < 1e-12 && (last.stored_at_start - 0.5).abs() < dt);
    assert!(last.error().abs() < 1e-6, "{}", last.error());
}

/// A dead load also does work: exactly its force times the displacement.
#[test]
fn a_dead_load_does_work() {
    let lattice = Lattice::free(1, 1);
    let drive = Drive {
        k_drive: 0.0,
        ..Drive::along_x(0.0)
    };
    let model = Model::new(
        lattice,
        Surface::uniform(&lattice, 0.2, 0.2),
        drive,
        0.0,
        0.0,
        FrictionLaw::Projection,
    )
    .with_dead_load(DeadLoad::uniform([0.3, 0.4]));
    let dt = 0.01;
    let last = *energies(&model, dt, 1000, State::at_rest(1)).last().unwrap();
    // Uniform acceleration of 0.5 - 0.2 from t = -dt/2 on: displacement a t^2/2, work 0.5 per displacement,
    // 0.2 of it to friction.
    let way = 0.5 * 0.3 * 10.0_f64.powi(2);
    assert!(
        (last.work / (0.5 * way) - 1.0).abs() < 2.0 * dt
            && (last.friction_loss / (0.2 * way) - 1.0).abs() < 2.0 * dt
    );
    assert!((last.stored.kinetic / (0.3 * way) - 1.0).abs() < 2.0 * dt);
    assert!(last.error().abs() < 1e-5, "{}", last.error());
}
