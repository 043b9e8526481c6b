//! Stacks of sheets: columns of blocks as masses on springs, waves along and across, and the stability of the
//! step.

use std::f64::consts::TAU;

use slipfront::communicator::Alone;
use slipfront::lattice::SpringStiffness;
use slipfront::{Drive, Edges, FrictionLaw, Lattice, Model, Sheet, State, Surface, VectorField};
use test_case::test_matrix;

use crate::common::{at_rest, from_state};

/// Two sheets above the lattice.
const SHEETS: [Sheet; 2] = [
    Sheet {
        thickness: 3.0,
        coupling: 1.7,
    },
    Sheet {
        thickness: 8.0,
        coupling: 0.6,
    },
];

fn model(lattice: Lattice, v_star: f64, damping: f64, sheets: &[Sheet], along_to_across: f64) -> Model {
    let springs = SpringStiffness::with_ratio(along_to_across);
    let surface = Surface::uniform(&lattice, 1.0, 0.5);
    let drive = Drive::along_x(v_star);
    Model::new(lattice, surface, drive, damping, 0.0, FrictionLaw::Projection)
        .with_sheets(sheets.to_vec(), springs)
}

/// Before the lower sheet slips, the upper sheet is a mass h between the drive and the springs to the lower
/// one: `h u'' = k (V t - u) - g u`, so that `u = k V/(k + g) (t - sin(w t)/w)` with `w^2 = (k + g)/h`.
///
/// The error is proportional to the square of the step.
#[test]
fn a_sheet_that_is_held_below_swings() {
    let sheet = Sheet {
        thickness: 4.0,
        coupling: 0.5,
    };
    let model = model(Lattice::free(3, 2), 0.05, 0.0, &[sheet], 3.0);
    let k = model.drive.k_drive;
    let frequency = ((k + sheet.coupling) / sheet.thickness).sqrt();
    let error = |steps: u32| {
        let dt = 20.0 / f64::from(steps);
        let mut simulation = at_rest(&model, dt);
        let mut largest = 0.0_f64;
        for _ in 0..steps {
            simulation.step();
            let t = simulation.time_star();
            let u = k * 0.05 / (k + sheet.coupling) * (t - (frequency * t).sin() / frequency);
            let found = simulation.snapshot().point.mu_star;
            largest = largest.max((found - k * (0.05 * t - u)).abs());
            // The friction that holds the lower sheet balances the pull of the upper one.
            let pull = simulation.snapshot().block(0).force_friction[0];
            assert!((pull + sheet.coupling * simulation.sheets()[0].displacement.x[0]).abs() < 1e-14);
        }
        assert_eq!(simulation.snapshot().totals.n_sliding, 0);
        largest
    };
    let errors = [100, 200, 400].map(error);
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((ratio - 4.0).abs() < 0.2, "{errors:?}");
    }
}

/// Stuck blocks that are displaced in a wave bear the traction `Z u` once the sheets above have come to rest:
///
/// ```text
/// Z_k = h_k c(q) + 1/(1/g_k+1 + 1/Z_k+1),   c = 2 r k_2 (1 - cos q) along, 2 k_2 (1 - cos q) across
/// k_2 = sqrt(27/r)/8
/// ```
///
/// with the drive in place of a sheet above the last.
#[test_matrix([0, 1], [8, 40], [3.0, 1.5, 4.5])]
fn a_wave_takes_the_traction_of_the_sheets(axis: usize, blocks: usize, ratio: f64) {
    const AMPLITUDE: f64 = 0.1;
    let lattice = Lattice::with_edges(blocks, 3, [Edges::Periodic; 2]);
    let model = model(lattice, 0.0, 0.3, &SHEETS, ratio);
    let q = TAU / blocks as f64;
    let wave: Vec<f64> = (0..lattice.n_blocks())
        .map(|b| AMPLITUDE * (q * (b % blocks) as f64).sin())
        .collect();
    let mut displacement = VectorField::zeros(lattice.n_blocks());
    *[&mut displacement.x, &mut displacement.y][axis] = wave.clone();
    let state = State {
        displacement,
        velocity: VectorField::zeros(lattice.n_blocks()),
    };
    let mut simulation = from_state(&model, 0.3, state);
    // Damped at least by exp(-0.15 t).
    for _ in 0..2000 {
        simulation.step();
    }
    let along = [ratio, 1.0][axis] * (27.0 / ratio).sqrt() / 8.0;
    let c = 2.0 * along * (1.0 - q.cos());
    let above = |k: usize| {
        if k == 1 {
            model.drive.k_drive
        } else {
            SHEETS[k + 1].coupling
        }
    };
    let mut stiffness = f64::INFINITY;
    for k in (0..2).rev() {
        let next = if k == 1 {
            above(1)
        } else {
            1.0 / (1.0 / above(0) + 1.0 / stiffness)
        };
        stiffness = SHEETS[k].thickness * c + next;
    }
    let expected = c + 1.0 / (1.0 / SHEETS[0].coupling + 1.0 / stiffness);
    let now = simulation.snapshot();
    for (b, u) in wave.iter().enumerate() {
        let traction = now.block(b).force_friction[axis];
        // Sums of some ten forces of the size of the amplitude.
        assert!(
            (traction - expected * u).abs() < 1e-14,
            "{traction} {}",
            expected * u
        );
    }
    assert_eq!(now.totals.n_sliding, 0);
}

/// Just below the bound a stack without friction oscillates forever; just above it diverges.
#[test_matrix([3.0, 1.5, 4.5])]
fn the_bound_on_the_step_is_that_of_the_stack(ratio: f64) {
    let lattice = Lattice::with_edges(6, 6, [Edges::Periodic; 2]);
    let surface = Surface::uniform(&lattice, 0.0, 0.0);
    let drive = Drive::along_x(0.0);
    // Stiff springs between the sheets, which lower the bound to about half of that of one sheet.
    let sheets = vec![Sheet {
        thickness: 0.5,
        coupling: 4.0,
    }];
    let model = Model::new(lattice, surface, drive, 0.0, 0.0, FrictionLaw::Projection)
        .with_sheets(sheets, SpringStiffness::with_ratio(ratio));
    let limit = model.stable_step_limit(&Alone);
    assert!(limit < 0.52, "{limit}");
    let energy = |share: f64| {
        let n = lattice.n_blocks();
        let kick = |b: usize| {
            1e-3 * (1.0 + (37 * b % 11) as f64) * if (b + b / 6).is_multiple_of(2) { 1.0 } else { -1.0 }
        };
        let state = State {
            displacement: VectorField::zeros(n),
            velocity: VectorField {
                x: (0..n).map(kick).collect(),
                y: (0..n).map(|b| kick(n - 1 - b)).collect(),
            },
        };
        let mut simulation = from_state(&model, share * limit, state);
        let start = simulation.snapshot().totals.velocity_square;
        for _ in 0..800 {
            simulation.step();
        }
        simulation.snapshot().totals.velocity_square / start
    };
    assert!(energy(0.999) < 30.0, "{}", energy(0.999));
    assert!(energy(1.01) > 1e6, "{}", energy(1.01));
}

/// In steady sliding all sheets move with the drive: mu* is friction plus the drag of all masses.
#[test]
fn steady_sliding_drags_all_sheets() {
    let lattice = Lattice::free(4, 4);
    let mut model = model(lattice, 0.05, 0.1, &SHEETS, 2.3);
    // Without a fall of friction there is no stick-slip.
    model.surface = Surface::uniform(&lattice, 0.5, 0.5);
    let mut simulation = at_rest(&model, 0.2);
    for _ in 0..20_000 {
        simulation.step();
    }
    let expected = 0.5 + 0.1 * 0.05 * (1.0 + 3.0 + 8.0);
    assert!((model.steady_level(&Alone) - expected).abs() < 1e-15);
    let found = simulation.snapshot().point.mu_star;
    assert!((found - expected).abs() < 1e-9, "{found} {expected}");
}

/// Work and losses balance, except for the steps in which blocks stop, see
/// [`Energies::error`](slipfront::observe::Energies::error).
#[test]
fn energy_is_balanced() {
    use slipfront::Stop;
    use slipfront::observe::{Curve, Scheduled};
    let lattice = Lattice::free(6, 5);
    let model = model(lattice, 0.05, 0.1, &SHEETS, 2.3);
    let error = |dt: f64| {
        let mut curve = Curve::every(1);
        let mut simulation = at_rest(&model, dt);
        let steps = (400.0 / dt) as u64;
        simulation
            .run(Stop::at_step(steps), &mut [Scheduled::always(&mut curve)])
            .unwrap();
        let last = curve.rows.last().unwrap().energies;
        assert!(last.stored.between_sheets > 0.0 && last.work > 1.0);
        last.error().abs()
    };
    let errors = [0.2, 0.1, 0.05].map(error);
    assert!(errors[0] < 1e-3 && errors[2] < 0.3 * errors[0], "{errors:?}");
}
