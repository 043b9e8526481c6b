//! Friction along x alone: a block on a foundation, and waves along an edge without friction.

use std::f64::consts::TAU;

use slipfront::communicator::Alone;
use slipfront::observe::{Curve, Scheduled};
use slipfront::surface::{Coefficients, Contact, Load};
use slipfront::{
    Coulomb, DeadLoad, Drive, Edges, Friction, FrictionLaw, Interface, Lattice, Model, ONSET_PATH, Slider,
    State, Stop, Surface,
};
use test_case::{test_case, test_matrix};

use crate::common::{at_rest, from_state};

/// Speeds of long waves in units of `sqrt(E/rho)`, squared.
const C_P_SQUARE: f64 = 9.0 / 8.0;
const C_S_SQUARE: f64 = 3.0 / 8.0;

fn law(foundation: f64) -> Friction {
    Friction::Coulomb(Coulomb {
        interface: Some(Interface { foundation }),
        ..FrictionLaw::Projection.into()
    })
}

/// One block without damping, with the coefficients 1 and 0.5.
fn block(drive: Drive, foundation: f64) -> Model {
    let lattice = Lattice::free(1, 1);
    let surface = Surface::uniform(&lattice, 1.0, 0.5);
    Model::new(lattice, surface, drive, 0.0, 0.0, law(foundation))
}

/// A drive that pulls a block at an angle, away from the substrate or towards it: the block slips when
///
/// ```text
/// k_s V t cos(theta) = F_n - K u_y     u_y = k_s V sin(theta)/w^2 (t - sin(w t)/w)     w^2 = k_s + K
/// ```
#[test_matrix([0.1, 1.0], [30.0, -30.0, 60.0])]
fn a_pull_away_from_the_substrate_lowers_friction(foundation: f64, degrees: f64) {
    let (v_star, dt) = (0.02, 0.02);
    let drive = Drive::at_angle(v_star, degrees);
    let (k, [x, y]) = (drive.k_drive, drive.direction);
    let w = (k + foundation).sqrt();
    let rise = |t: f64| k * v_star * y / (w * w) * (t - (w * t).sin() / w);
    let slips = |t: f64| k * v_star * x * t > 1.0 - foundation * rise(t);
    let expected = (0..).map(|n| n as f64 * 1e-3).find(|&t| slips(t)).unwrap();
    let mut simulation = at_rest(&block(drive, foundation), dt);
    while simulation.snapshot().totals.n_slipping == 0 {
        assert!(simulation.time_star() < 2.0 * expected, "no slip at {expected}");
        simulation.step();
    }
    // The slip is seen at a step; leapfrog changes the frequency of the oscillation only by a relative (w
    // dt)^2/24.
    let found = simulation.time_star();
    assert!(
        found - expected > -1e-2 && found - expected < dt + 1e-2,
        "{found} for {expected}"
    );
    // The fields show the normal force that the foundation has lost.
    let block = simulation.snapshot().block(0);
    let lost = block.force_drive[1] - k * (v_star * y * found - block.displacement[1]);
    assert!(
        (lost + foundation * block.displacement[1]).abs() < 1e-12 && block.slides,
        "{block:?}"
    );
}

/// A block that is lifted off slides without friction and moves under its load alone: it falls freely.
#[test]
fn a_block_that_is_lifted_falls_under_its_load() {
    let drive = Drive {
        k_drive: 1e-9,
        ..Drive::along_x(0.0)
    };
    let mut state = State::at_rest(1);
    (state.displacement.y[0], state.velocity.x[0]) = (10.0, 0.3);
    let mut simulation = from_state(&block(drive, 2.0), 0.01, state);
    for _ in 0..200 {
        simulation.step();
    }
    // F_n = m = 1: from a velocity of 0 half a step before the start it has fallen by t (t + dt)/2.
    let state = simulation.state();
    assert!(
        (state.displacement.y[0] - (10.0 - 0.5 * 2.0 * 2.01)).abs() < 1e-6,
        "{state:?}"
    );
    assert!((state.velocity.x[0] - 0.3).abs() < 1e-6, "{state:?}");
}

/// A block that oscillates on its foundation while it slides to and fro gives back the energy that the
/// foundation stores.
#[test]
fn the_foundation_is_part_of_the_balance_of_energy() {
    let mut curve = Curve::every(1);
    let model = block(Drive::at_angle(0.1, 40.0), 0.5);
    let mut simulation = at_rest(&model, 0.01);
    simulation
        .run(Stop::at_step(10_000), &mut [Scheduled::always(&mut curve)])
        .unwrap();
    let stored = curve
        .rows
        .iter()
        .map(|row| row.energies.foundation)
        .fold(0.0, f64::max);
    let error = curve.rows.last().unwrap().energies.error();
    // A slip ends with an error of at most (q dt)^2/2, 1e-5 of the energies here.
    assert!(
        stored > 0.5 && error.abs() < 1e-4,
        "stored {stored}, error {error}"
    );
}

/// Ratio of the speeds of Rayleigh and shear waves in a sheet of Poisson's ratio 1/3, from the root of
/// `(2 - x)^2 = 4 sqrt(1 - x) sqrt(1 - x/3)` with `x = (c_R/c_S)^2`: that of a Poisson solid.
const RAYLEIGH: f64 = 0.919_402;

/// The drive pulls all blocks of all rows, and friction holds the lowest row. As the pull rises slowly, the
/// drive springs of the rows above act in series with the shear stiffness between rows, and the lowest row
/// slips when they pull with the threshold. Each row lags by the drag and oscillates by at most V/w_0,
/// w_0^2 = k_s; the lowest row feels its own spring and that of the row above. The slip is seen at a step.
#[test_matrix([1, 2, 6, 30], [0.0, 60.0, 180.0], [0.0, 0.3])]
fn the_rows_above_pull_the_lowest(rows: usize, degrees: f64, dead_load: f64) {
    let (v_star, dt, damping) = (1e-3, 0.2, 0.1);
    let lattice = Lattice::with_edges(4, rows, [Edges::Periodic, Edges::Free]);
    let n = lattice.n_blocks();
    let slider = Slider::default();
    let contact = Contact {
        faces: Some((0..n).map(|b| b < 4).collect()),
        ..Contact::new(Load::Redistributed, 1.0)
    };
    let coefficients = Coefficients::given(vec![1.0; n], vec![0.5; n]);
    let surface = Surface::of_ranks(coefficients, vec![false; n], contact, &slider, &Alone).unwrap();
    let drive = Drive::at_angle(v_star, degrees);
    let k = drive.k_drive;
    let on_contact = (0..n).map(|b| f64::from(u8::from(b < 4))).collect();
    let model = Model::new(lattice, surface, drive, damping, 0.0, law(0.0))
        .with_dead_load(DeadLoad::of_blocks([dead_load, 0.0], on_contact, &slider, &Alone));
    let estimate = model.first_slip_estimate(&Alone).unwrap();
    let mut simulation = at_rest(&model, dt);
    while simulation.snapshot().totals.n_slipping == 0 {
        assert!(
            simulation.time_star() < 2.0 * estimate + 10.0,
            "no slip at {estimate}"
        );
        simulation.step();
    }
    let lag = 2.0 * (damping + k.sqrt()) / k;
    assert!(
        (simulation.time_star() - estimate).abs() < lag + dt,
        "{} for {estimate}",
        simulation.time_star()
    );
    assert!(!model.slips_at_once(0));
    // Of a pull at an angle, friction opposes the part along x.
    let along = model.drive.direction[0].abs();
    let kinetic = model.steady_level(&Alone) - model.steady_drag(&Alone);
    assert!((kinetic - 0.5 * along).abs() < 1e-12);
    // Eq. 12 rounds 8/3 to 2.5.
    let onset = model.onset_estimate(None)[1] * (8.0 / 3.0) / ONSET_PATH;
    assert!(dead_load != 0.0 || (onset / estimate - 1.0).abs() < 1e-12);
}

/// Speed of a standing surface wave of `length` blocks at the lower edge, which is in contact without
/// friction, over `c_S`.
fn surface_wave(length: usize, halves_edge_springs: bool) -> f64 {
    let depth = 2 * length;
    let lattice = Lattice::with_edges(length, depth, [Edges::Periodic, Edges::Free]);
    let textured = (0..lattice.n_blocks()).map(|b| b >= length).collect();
    let zeros = vec![0.0; lattice.n_blocks()];
    let coefficients = Coefficients::given(zeros.clone(), zeros);
    let surface = Surface::new(coefficients, textured, Load::Kept, 1.0).unwrap();
    let drive = Drive {
        k_drive: 1e-9,
        ..Drive::along_x(0.0)
    };
    let slider = Slider {
        halves_edge_springs,
        ..Slider::default()
    };
    let model = Model::new(lattice, surface, drive, 0.0, 0.0, law(0.0)).with_slider(slider);

    // Potentials phi = exp(-p y) cos(k x) and psi = B exp(-s y) sin(k x), without shear stress at y = 0.
    let k = TAU / length as f64;
    let speed_square = RAYLEIGH * RAYLEIGH * C_S_SQUARE;
    let decay = |square: f64| k * (1.0 - speed_square / square).sqrt();
    let (p, s) = (decay(C_P_SQUARE), decay(C_S_SQUARE));
    let b = -2.0 * k * p / (k * k + s * s);
    let mut state = State::at_rest(lattice.n_blocks());
    for block in 0..lattice.n_blocks() {
        let (i, j) = lattice.column_row(block);
        let (x, y) = (k * i as f64, j as f64);
        let (along, down) = ((-p * y).exp(), (-s * y).exp());
        state.displacement.x[block] = -(k * along + b * s * down) * x.sin();
        state.displacement.y[block] = -(p * along + b * k * down) * x.cos();
    }
    let shape = state.displacement.clone();
    let dt = 0.4;
    let mut simulation = from_state(&model, dt, state);
    let amplitude = |u: &slipfront::VectorField| -> f64 { (0..length).map(|b| u.y[b] * shape.y[b]).sum() };
    // Less time than a wave needs to the far edge and back.
    let steps = (1.5 * depth as f64 / C_P_SQUARE.sqrt() / dt) as usize;
    let found: Vec<f64> = (0..steps)
        .map(|_| {
            simulation.step();
            amplitude(&simulation.state().displacement)
        })
        .collect();
    // a(n+1) + a(n-1) = 2 cos(w dt) a(n), by least squares.
    let both: f64 = found.windows(3).map(|a| a[1] * (a[0] + a[2])).sum();
    let one: f64 = found.windows(3).map(|a| a[1] * a[1]).sum();
    let angle = (0.5 * both / one).acos();
    // Leapfrog: 2 sin(w dt/2)/dt is the frequency of the lattice.
    2.0 * (0.5 * angle).sin() / dt / k / C_S_SQUARE.sqrt()
}

/// The edge of an upright sheet without friction carries the surface waves of the continuum. The row of whole
/// blocks at the edge has too much mass, an error of first order in the wave number, which extrapolation from
/// two wavelengths removes.
#[test_case(false, 0.002)]
#[test_case(true, 0.002)]
fn surface_waves_have_the_speed_of_rayleigh(halves_edge_springs: bool, tolerance: f64) {
    let [coarse, fine] = [48, 96].map(|length| surface_wave(length, halves_edge_springs));
    let extrapolated = 2.0 * fine - coarse;
    assert!(
        (extrapolated - RAYLEIGH).abs() < tolerance,
        "{coarse}, {fine}: {extrapolated}"
    );
}
