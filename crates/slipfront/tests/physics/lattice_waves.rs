//! Waves of the lattice without friction: frequencies, speeds and the limit of stability.

use std::f64::consts::{PI, TAU};

use slipfront::exact_solutions::{LatticeWave, lattice_waves, leapfrog_frequency};
use slipfront::lattice::{K_DRIVE, POISSON_RATIO, dt_star_limit};
use slipfront::{Drive, Edges, FrictionLaw, Lattice, Model, State, Surface, VectorField, scales};
use test_case::test_matrix;

use crate::common::from_state;

/// A lattice without friction: linear springs, and drive springs that pull each block to its rest site.
fn floating(nx: usize, ny: usize, omega_star: f64, k_drive: f64) -> Model {
    let lattice = Lattice::with_edges(nx, ny, [Edges::Periodic; 2]);
    let drive = Drive {
        k_drive,
        ..Drive::along_x(0.0)
    };
    Model::new(
        lattice,
        Surface::uniform(&lattice, 0.0, 0.0),
        drive,
        scales::damping(omega_star),
        0.0,
        FrictionLaw::Projection,
    )
}

/// Shape of the wave over the blocks.
fn plane_wave(lattice: &Lattice, wave: &LatticeWave, a: f64, b: f64) -> VectorField {
    let mut field = VectorField::zeros(lattice.n_blocks());
    for block in 0..lattice.n_blocks() {
        let (i, j) = lattice.column_row(block);
        let phase = (a * i as f64 + b * j as f64 + 0.3).cos();
        field.x[block] = wave.polarization[0] * phase;
        field.y[block] = wave.polarization[1] * phase;
    }
    field
}

fn scaled(field: &VectorField, factor: f64) -> VectorField {
    let scale = |v: &[f64]| v.iter().map(|v| factor * v).collect();
    VectorField {
        x: scale(&field.x),
        y: scale(&field.y),
    }
}

fn inner(a: &VectorField, b: &VectorField) -> f64 {
    a.x.iter()
        .zip(&b.x)
        .chain(a.y.iter().zip(&b.y))
        .map(|(a, b)| a * b)
        .sum()
}

/// Amplitude of a standing wave after each step, and the largest part of the motion that does not belong to
/// this wave.
fn amplitudes(model: &Model, shape: &VectorField, dt: f64, steps: usize, frequency: f64) -> (Vec<f64>, f64) {
    // The leapfrog solution is u(n dt) = cos(w n dt); this is its velocity half a step before 0.
    let before = (1.0 - (frequency * dt).cos()) / dt;
    let state = State {
        displacement: shape.clone(),
        velocity: scaled(shape, before),
    };
    let mut simulation = from_state(model, dt, state);
    let norm = inner(shape, shape);
    let (mut found, mut stray) = (Vec::with_capacity(steps), 0.0_f64);
    for _ in 0..steps {
        simulation.step();
        let u = simulation.state().displacement;
        let amplitude = inner(&u, shape) / norm;
        let rest = inner(&u, &u) / norm - amplitude * amplitude;
        stray = stray.max(rest.abs());
        found.push(amplitude);
    }
    (found, stray)
}

/// Rounding errors grow as the number of steps times 1e-16 times the phase per step: 1e-10 is ample for 2000.
#[test_matrix(
    [(1, 0), (0, 1), (2, 1), (3, 5), (6, 0), (6, 4), (5, 4)],
    [0, 1],
    [0.02, 0.4, 0.88],
    [0.0, K_DRIVE]
)]
fn a_wave_swings_at_leapfrogs_own_frequency(mode: (u32, u32), branch: usize, dt: f64, k_drive: f64) {
    let model = floating(12, 8, 0.0, k_drive);
    let (a, b) = (TAU * f64::from(mode.0) / 12.0, TAU * f64::from(mode.1) / 8.0);
    let wave = lattice_waves(a, b, k_drive)[branch];
    let frequency = leapfrog_frequency(wave.omega_squared.sqrt(), dt);
    let shape = plane_wave(&model.lattice, &wave, a, b);
    let (found, stray) = amplitudes(&model, &shape, dt, 2000, frequency);
    for (n, amplitude) in found.iter().enumerate() {
        let exact = (frequency * (n + 1) as f64 * dt).cos();
        assert!(
            (amplitude - exact).abs() < 1e-10,
            "step {}: {amplitude}, exactly {exact}",
            n + 1
        );
    }
    assert!(stray < 1e-13, "energy leaks into other waves: {stray}");
}

/// With damping the scheme's amplitude obeys (1 + g) u+ - (2 - w^2 dt^2) u + (1 - g) u- = 0, g = Omega dt/2.
#[test_matrix([0.1, 1.0, 10.0])]
fn a_damped_wave_obeys_the_scheme(omega_star: f64) {
    let (dt, k) = (0.3, K_DRIVE);
    let model = floating(12, 8, omega_star, k);
    let (a, b) = (TAU * 2.0 / 12.0, TAU / 8.0);
    let wave = lattice_waves(a, b, k)[1];
    let shape = plane_wave(&model.lattice, &wave, a, b);
    let g = 0.5 * scales::damping(omega_star) * dt;
    let (mut before, mut now) = (1.0, 1.0);
    let (found, _) = amplitudes(&model, &shape, dt, 500, 0.0);
    for amplitude in found {
        let next = ((2.0 - wave.omega_squared * dt * dt) * now - (1.0 - g) * before) / (1.0 + g);
        (before, now) = (now, next);
        assert!((amplitude - now).abs() < 1e-12);
    }
}

/// Long waves: c_P^2 = 9/8 and c_S^2 = 3/8 in every direction, the speeds of plane stress at nu = 1/3.
/// Checked with the frequency of the simulation; its deviation is O(a^2 + b^2), below 1e-4 here.
#[test_matrix([(1, 0), (1, 1), (2, 1), (0, 1), (1, 3)], [(0, 3.0 / 8.0), (1, 9.0 / 8.0)])]
fn long_waves_are_those_of_an_isotropic_sheet(mode: (u32, u32), (branch, c_squared): (usize, f64)) {
    let n = 512.0;
    let (a, b) = (TAU * f64::from(mode.0) / n, TAU * f64::from(mode.1) / n);
    let wave = lattice_waves(a, b, 0.0)[branch];
    let found = wave.omega_squared / (a * a + b * b);
    assert!((found / c_squared - 1.0).abs() < a * a + b * b, "{found}");
    // P-waves oscillate along their direction, S-waves across it.
    let [px, py] = wave.polarization;
    let along = (px * a + py * b) / a.hypot(b);
    let exact = if branch == 1 { 1.0 } else { 0.0 };
    assert!((along.abs() - exact).abs() < 1e-3, "{along}");
    let ratio: f64 = (9.0 / 8.0) / (3.0 / 8.0);
    assert!((ratio - 2.0 / (1.0 - POISSON_RATIO)).abs() < 1e-14);
}

/// Long P and S waves simulated with small steps return after their period.
#[test_matrix([(0, 3.0 / 8.0), (1, 9.0 / 8.0)])]
fn long_waves_run_through_the_lattice((branch, c_squared): (usize, f64)) {
    let n = 96;
    let model = floating(n, 3, 0.0, 0.0);
    let a = TAU / n as f64;
    let wave = lattice_waves(a, 0.0, 0.0)[branch];
    let shape = plane_wave(&model.lattice, &wave, a, 0.0);
    let period = n as f64 / f64::sqrt(c_squared);
    let steps = 400;
    let dt = period / f64::from(steps);
    let (found, _) = amplitudes(
        &model,
        &shape,
        dt,
        steps as usize,
        leapfrog_frequency(TAU / period, dt),
    );
    // Dispersion of the lattice shifts the phase by about 2 pi a^2/24 = 1e-3, and its cosine by less than
    // 1e-5.
    assert!((found[steps as usize - 1] - 1.0).abs() < 1e-5);
    assert!((found[steps as usize / 4 - 1]).abs() < 1e-3 && found[steps as usize / 2 - 1] < -1.0 + 1e-5);
}

/// Growth of the lattice's stiffest wave over `steps`, started at 1e-3.
fn growth(dt: f64, omega_star: f64, steps: usize) -> f64 {
    let model = floating(6, 4, omega_star, K_DRIVE);
    let wave = lattice_waves(PI, 0.0, K_DRIVE)[1];
    let shape = scaled(&plane_wave(&model.lattice, &wave, PI, 0.0), 1e-3);
    let (found, _) = amplitudes(&model, &shape, dt, steps, 0.0);
    let size = |a: &f64| if a.is_finite() { a.abs() } else { f64::INFINITY };
    found[steps - 20..].iter().map(size).fold(0.0, f64::max)
}

/// dt* < 2/sqrt(6.5 k_1) = 0.9058 is stable and a larger dt* is not, at any damping. At large damping the
/// unstable wave gains only (w^2 dt^2 - 4)/(2 Omega dt) per step, hence the 1 % and the many steps.
#[test_matrix([0.0, 0.1, 1.0, 3.0, 30.0])]
fn stability_does_not_depend_on_damping(omega_star: f64) {
    assert!((dt_star_limit() - 0.9058).abs() < 5e-5);
    // Undamped, the oscillation just below the limit beats with an amplitude of 1/sqrt(1 - (dt/limit)^2) =
    // 22.
    assert!(growth(0.999 * dt_star_limit(), omega_star, 6000) < 30.0);
    assert!(growth(1.01 * dt_star_limit(), omega_star, 6000) > 1e6);
}
