//! Strength that falls with slip, compared with results found by hand.

use std::f64::consts::PI;
use std::sync::Arc;

use slipfront::communicator::Alone;
use slipfront::lattice::{K_DIAGONAL, K_STRAIGHT};
use slipfront::observe::{Curve, Scheduled};
use slipfront::surface::{Coefficients, Load};
use slipfront::{
    Coulomb, Drive, Friction, FrictionLaw, Lattice, Model, Program, SlipWeakening, Stop, Surface,
};
use test_case::{test_case, test_matrix};

use crate::common::{Slider, at_rest, cavity};

/// Static threshold of a block that can slip.
const WHOLE: f64 = 1.0;
/// Kinetic threshold of such a block.
const KINETIC: f64 = 0.5;
/// Both thresholds of a block that cannot slip.
const HELD: f64 = 1e3;

/// A lattice in which the blocks that `can_slip` weaken by `weakening` per slip.
fn weakening_model(
    [nx, ny]: [usize; 2],
    can_slip: &dyn Fn(usize, usize) -> bool,
    weakening: f64,
    damping: f64,
    segments: &[(f64, f64)],
) -> Model {
    let lattice = Lattice::free(nx, ny);
    let slips = |b: usize| {
        let (i, j) = lattice.column_row(b);
        can_slip(i, j)
    };
    let each = |own: f64| (0..nx * ny).map(|b| if slips(b) { own } else { HELD }).collect();
    let coefficients = Coefficients::given(each(WHOLE), each(KINETIC));
    let surface = Surface::new(coefficients, vec![false; nx * ny], Load::Redistributed, 1.0).unwrap();
    let drive = Drive {
        program: Some(Arc::new(Program::new(segments.iter().copied()))),
        ..Drive::along_x(segments[0].0)
    };
    let friction = Friction::Coulomb(Coulomb {
        slip_weakening: Some(SlipWeakening {
            length: (WHOLE - KINETIC) / weakening,
            healing_time: None,
        }),
        ..FrictionLaw::Projection.into()
    });
    Model::new(lattice, surface, drive, damping, 0.0, friction)
}

/// A block that weakens more slowly than its drive spring unloads follows the drive without a jump,
/// `s = (k_s X - S)/(k_s - W)`.
#[test]
fn a_block_on_a_stiff_spring_does_not_jump() {
    let (weakening, speed, damping) = (0.25, 1e-5, 0.5);
    let segments = [(1e-3, 2600.0), (speed, f64::INFINITY)];
    let model = weakening_model([1, 1], &|_, _| true, weakening, damping, &segments);
    let k = model.drive.k_drive;
    let mut simulation = at_rest(&model, 0.5);
    let path = |time_star: f64| model.drive.path(time_star);
    for slip in [0.5, 1.0, 1.9] {
        let until = (WHOLE + (k - weakening) * slip) / k;
        while path(simulation.snapshot().time_star) < until {
            simulation.step();
        }
        let now = simulation.snapshot();
        let exact = (k * path(now.time_star) - WHOLE) / (k - weakening);
        // Damping holds the block back by Omega v/(k_s - W), v = V k_s/(k_s - W); V dt is the path of a step.
        let lag = damping * speed * k / (k - weakening).powi(2);
        let found = now.block(0).displacement[0];
        assert!(
            (found - (exact - lag)).abs() < 1e-4 * exact,
            "{found}, exact {exact}"
        );
    }
}

/// The highest speed of any block until the drive has moved by `path` after blocks have begun to slip.
fn highest_speed(model: &Model, path: f64) -> f64 {
    let mut simulation = at_rest(model, 0.4);
    let mut highest = 0.0_f64;
    let until = WHOLE / model.drive.k_drive + path;
    while model.drive.path(simulation.snapshot().time_star) < until {
        simulation.step();
        for b in 0..model.lattice.n_blocks() {
            let [vx, vy] = simulation.snapshot().block(b).velocity;
            highest = highest.max(vx.hypot(vy));
        }
        if highest > JUMP {
            break;
        }
    }
    highest
}

/// Speed that is reached only in a jump, many times that of the drive.
const JUMP: f64 = 1e-3;
/// Speed of the drive while blocks slip.
const SLOW: f64 = 1e-7;

/// Blocks at their threshold between blocks that cannot slip jump if and only if `W - k_s` exceeds the least
/// eigenvalue of the stiffness matrix of the springs along the drive, clamped at their rim.
fn assert_jumps_above(blocks: [usize; 2], can_slip: &dyn Fn(usize, usize) -> bool, eigenvalue: f64) {
    let k = K_DIAGONAL;
    for (share, jumps) in [(0.98, false), (1.02, true)] {
        let weakening = k + share * eigenvalue;
        // The first 0.999 of the load, in which nothing slips yet, is fast.
        let fast = (0.999 * WHOLE / k / 1e-3).floor();
        let model = weakening_model(
            blocks,
            can_slip,
            weakening,
            0.3,
            &[(1e-3, fast), (SLOW, f64::INFINITY)],
        );
        // While stable, a mode slips by at most k_s/(0.02 lambda) of the path, times its largest component.
        // This must not reach D_c.
        let length = (WHOLE - KINETIC) / weakening;
        let path = 0.3 * length * 0.02 * eigenvalue / k;
        let highest = highest_speed(&model, path);
        assert_eq!(highest > JUMP, jumps, "{share} of {eigenvalue}: {highest}");
    }
}

/// Critical size of a chain of n blocks: it jumps if `W - k_s` exceeds `4 k_1 sin^2(pi/(2(n + 1)))`.
#[test_case(1)]
#[test_case(3)]
#[test_case(8)]
fn chains_jump_from_a_critical_size_on(n: usize) {
    let sine = (PI / (2.0 * (n as f64 + 1.0))).sin();
    let eigenvalue = 4.0 * K_STRAIGHT * sine * sine;
    assert_jumps_above([n + 2, 1], &|i, _| (1..=n).contains(&i), eigenvalue);
}

/// The least eigenvalue of the matrix of the springs along x of `n` x `n` blocks between clamped ones, by
/// power iteration of a shifted matrix: straight springs along x pull with k_1, straight springs across x do
/// not pull, and diagonal springs pull with k_2/2 each.
fn least_eigenvalue_along(n: usize) -> f64 {
    let index = |i: isize, j: isize| {
        let within = |i: isize| (0..n as isize).contains(&i);
        (within(i) && within(j)).then(|| j as usize * n + i as usize)
    };
    let bonds = [
        (1, 0, K_STRAIGHT),
        (1, 1, 0.5 * K_DIAGONAL),
        (1, -1, 0.5 * K_DIAGONAL),
    ];
    let apply = |x: &[f64]| -> Vec<f64> {
        let row = |b: usize| {
            let (i, j) = ((b % n) as isize, (b / n) as isize);
            let ends = |(di, dj, k): (isize, isize, f64)| [(di, dj, k), (-di, -dj, k)];
            bonds.into_iter().flat_map(ends).fold(0.0, |sum, (di, dj, k)| {
                let there = index(i + di, j + dj).map_or(0.0, |there| x[there]);
                sum + k * (x[b] - there)
            })
        };
        (0..n * n).map(row).collect()
    };
    // Gershgorin: no eigenvalue exceeds twice the sum of a row's springs.
    let shift = 4.0 * (K_STRAIGHT + K_DIAGONAL);
    let mut x = vec![1.0; n * n];
    let mut eigenvalue = 0.0;
    for _ in 0..5000 {
        let y: Vec<f64> = apply(&x).iter().zip(&x).map(|(ax, x)| shift * x - ax).collect();
        let norm = y.iter().map(|y| y * y).sum::<f64>().sqrt();
        eigenvalue = shift - norm / x.iter().map(|x| x * x).sum::<f64>().sqrt();
        x = y.iter().map(|y| y / norm).collect();
    }
    eigenvalue
}

/// Friction suppresses slip across the drive at the onset, so that only the springs along the drive decide.
#[test]
fn a_patch_jumps_by_the_springs_along_the_drive() {
    let eigenvalue = least_eigenvalue_along(3);
    // Clamped all around; the value comes from a small program of linear algebra.
    assert!((eigenvalue - 0.814).abs() < 5e-4, "{eigenvalue}");
    let inside = |i: usize, j: usize| (1..=3).contains(&i) && (1..=3).contains(&j);
    assert_jumps_above([5, 5], &inside, eigenvalue);
}

/// The balance of energy closes, and the weakening energy is a part of the friction loss: at the end, when
/// all blocks have slipped far, it is `(S - K) D_c/2` for each, at any step.
#[test_matrix([0.2, 0.05], [None, Some(20.0)])]
fn the_balance_of_energy_closes(dt_star: f64, healing_time: Option<f64>) {
    let blocks = [20, 16];
    let slider = Slider {
        blocks,
        textures: vec![cavity(blocks, 10.0, 1, 0.0, false)],
        slip_weakening: Some(SlipWeakening {
            length: 0.4,
            healing_time,
        }),
        dt_star,
        ..Slider::default()
    };
    let model = slider.model();
    let mut simulation = at_rest(&model, dt_star);
    let mut curve = Curve::every(10);
    let mut observers = [Scheduled::always(&mut curve)];
    simulation
        .run(Stop::at_step(slider.steps(12.0)), &mut observers)
        .unwrap();
    let (surface, last) = (&model.surface, curve.rows[curve.rows.len() - 1].energies);
    // The error of the balance is proportional to the square of the step: at most (mu_k F_n dt)^2/2 = dt^2/8
    // per stop, for some stops of each block, relative to a work of some units for each block.
    let bound = 0.01 * dt_star * dt_star;
    assert!(last.error().abs() < bound, "{}", last.error());
    let most: f64 = (0..model.lattice.n_blocks())
        .map(|b| 0.5 * 0.4 * (surface.static_limit(b) - surface.kinetic_force(b)).max(0.0))
        .sum();
    assert!(
        curve
            .rows
            .is_sorted_by(|one, next| one.energies.weakening_loss <= next.energies.weakening_loss)
    );
    assert!(last.weakening_loss < last.friction_loss);
    match healing_time {
        None => assert!(
            (last.weakening_loss / most - 1.0).abs() < 1e-12,
            "{}",
            last.weakening_loss
        ),
        Some(_) => assert!(last.weakening_loss > most),
    }
}

/// mu_s* of one physical slider on `n` x `n` blocks: the mount per area, damping and speed in SI units, the
/// length of weakening and a square hole of 9 %, if it has one, are those of 60 x 60 blocks, with five blocks
/// in a critical size.
fn static_friction(n: usize, has_hole: bool) -> f64 {
    let finer = n as f64 / 60.0;
    let slider = Slider {
        blocks: [n, n],
        sigma_static_star: 0.0,
        sigma_kinetic_star: 0.0,
        omega_star: 0.1 / finer,
        v_star: 0.01 * finer,
        dt_star: 0.2,
        slip_weakening: Some(SlipWeakening {
            length: 0.66 * finer * finer,
            healing_time: None,
        }),
        ..Slider::default()
    };
    let mut model = slider.model();
    model.drive.k_drive = K_DIAGONAL / (finer * finer);
    if has_hole {
        let side = 3 * n / 10;
        let within = |i: usize| (n - side) / 2 <= i && i < (n + side) / 2;
        let textured = (0..n * n).map(|b| within(b % n) && within(b / n)).collect();
        model.surface = Surface::new(slider.coefficients(), textured, Load::Redistributed, 1.0).unwrap();
        if n == 60 {
            let [size, _] = model.critical_size(&Alone).unwrap();
            assert!((4.8..5.2).contains(&size), "{size}");
        }
    }
    let mut simulation = at_rest(&model, slider.dt_star);
    while !simulation.snapshot().peak.ended {
        simulation.step();
    }
    simulation.snapshot().peak.mu_star
}

/// If the critical size has five blocks, static friction and its change by the hole agree with finer meshes
/// within 2 %. With strength that falls at once they change by a tenth from level to level.
#[test]
fn static_friction_converges() {
    let levels = [60, 80, 100].map(|n| {
        let [plain, with_hole] = [false, true].map(|has_hole| static_friction(n, has_hole));
        [plain, with_hole, 1.0 - with_hole / plain]
    });
    for level in levels {
        for (found, finest) in level.into_iter().zip(levels[2]) {
            assert!((found / finest - 1.0).abs() < 0.02, "{levels:?}");
        }
    }
    assert!(levels[2][2] > 0.1, "the hole matters: {levels:?}");
}
