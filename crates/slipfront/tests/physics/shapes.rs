//! Every shape of lattice: single blocks, chains, the smallest squares, rectangles.

use slipfront::exact_solutions::lattice_waves;
use slipfront::{Drive, Edges, FrictionLaw, Lattice, Model, State, Surface, VectorField};
use test_case::test_matrix;

use crate::common::{Slider, at_rest, from_state};

/// Forces of the lattice alone at given displacements. If nothing else acts on blocks at rest, their
/// velocities after a step of 1 have the same bits as the forces.
fn lattice_forces(lattice: Lattice, u: VectorField, epsilon: f64) -> VectorField {
    let n = lattice.n_blocks();
    let model = Model::new(
        lattice,
        Surface::uniform(&lattice, 0.0, 0.0),
        Drive {
            k_drive: 0.0,
            ..Drive::along_x(0.0)
        },
        0.0,
        epsilon,
        FrictionLaw::Projection,
    );
    let bent = State {
        displacement: u,
        velocity: VectorField::zeros(n),
    };
    let simulation = from_state(&model, 1.0, bent);
    let force = simulation.state().velocity;
    for b in 0..n {
        let shown = simulation.snapshot().block(b).force_lattice;
        // Recomputed forces may differ from those of the sweep by rounding: by 1e-16 for each of eight
        // springs.
        let differs = (0..2).any(|axis| (shown[axis] - force.at(b)[axis]).abs() > 1e-14);
        assert!(!differs, "block {b} shows {shown:?}, moved by {:?}", force.at(b));
    }
    force
}

/// Eq. 3 as printed, block by block: eight neighbours, current lengths, no algebra. Exact to 1e-16/eps.
fn by_the_letter(lattice: &Lattice, u: &VectorField, epsilon: f64) -> VectorField {
    let mut force = VectorField::zeros(lattice.n_blocks());
    for b in 0..lattice.n_blocks() {
        let (i, j) = lattice.column_row(b);
        for dj in -1..=1_isize {
            for di in -1..=1_isize {
                let (i, j) = (i as isize + di, j as isize + dj);
                let (nx, ny) = (lattice.nx as isize, lattice.ny as isize);
                let wraps = lattice.edges.map(|e| e == Edges::Periodic);
                let inside = (wraps[0] || (0..nx).contains(&i)) && (wraps[1] || (0..ny).contains(&j));
                if (di, dj) == (0, 0) || !inside {
                    continue;
                }
                let n = (j.rem_euclid(ny) * nx + i.rem_euclid(nx)) as usize;
                let r = [
                    di as f64 + epsilon * (u.x[n] - u.x[b]),
                    dj as f64 + epsilon * (u.y[n] - u.y[b]),
                ];
                let (k, d) = if di == 0 || dj == 0 {
                    (0.75, 1.0)
                } else {
                    (0.375, 2_f64.sqrt())
                };
                let length = r[0].hypot(r[1]);
                force.x[b] += k * (length - d) / epsilon * r[0] / length;
                force.y[b] += k * (length - d) / epsilon * r[1] / length;
            }
        }
    }
    force
}

fn wavy(lattice: &Lattice) -> VectorField {
    let wave = |k: f64| {
        (0..lattice.n_blocks())
            .map(|b| (k * (b * b + 3 * b + 1) as f64).sin())
            .collect()
    };
    VectorField {
        x: wave(1.3),
        y: wave(0.7),
    }
}

#[test_matrix(
    [[1, 1], [2, 1], [1, 2], [2, 2], [1, 7], [7, 1], [2, 5], [5, 2], [3, 3], [6, 4]],
    [
        [Edges::Free, Edges::Free], [Edges::Periodic, Edges::Free], [Edges::Free, Edges::Periodic],
        [Edges::Periodic, Edges::Periodic]
    ],
    [0.2, 1e-3]
)]
fn lattice_forces_are_eq_3_to_the_letter(blocks: [usize; 2], edges: [Edges; 2], epsilon: f64) {
    if (0..2).any(|axis| edges[axis] == Edges::Periodic && blocks[axis] < Lattice::MIN_PERIODIC) {
        return;
    }
    let lattice = Lattice::with_edges(blocks[0], blocks[1], edges);
    let u = wavy(&lattice);
    let exact = by_the_letter(&lattice, &u, epsilon);
    let found = lattice_forces(lattice, u, epsilon);
    for b in 0..lattice.n_blocks() {
        let ([fx, fy], [ex, ey]) = (found.at(b), exact.at(b));
        // The printed form subtracts lengths of about 1 that differ by a strain of eps.
        let tolerance = 1e-15 + 2e-15 / epsilon;
        assert!(
            (fx - ex).abs() < tolerance && (fy - ey).abs() < tolerance,
            "block {b}: {fx} {fy}, exactly {ex} {ey}"
        );
    }
}

/// At linear springs the forces of a plane wave are -(D - k_s) u: an independent check of stiffnesses and
/// signs.
#[test]
fn forces_of_a_plane_wave_are_those_of_the_dynamical_matrix() {
    let lattice = Lattice::with_edges(9, 7, [Edges::Periodic; 2]);
    let (a, b) = (2.0 * std::f64::consts::TAU / 9.0, std::f64::consts::TAU / 7.0);
    for wave in lattice_waves(a, b, 0.0) {
        let mut u = VectorField::zeros(63);
        for block in 0..63 {
            let (i, j) = lattice.column_row(block);
            let phase = (a * i as f64 + b * j as f64).sin();
            u.x[block] = wave.polarization[0] * phase;
            u.y[block] = wave.polarization[1] * phase;
        }
        let force = lattice_forces(lattice, u.clone(), 0.0);
        for block in 0..63 {
            assert!((force.x[block] + wave.omega_squared * u.x[block]).abs() < 1e-14);
            assert!((force.y[block] + wave.omega_squared * u.y[block]).abs() < 1e-14);
        }
    }
}

/// A chain lies along x or along y: the same motion, to the last bit.
#[test]
fn chains_along_x_and_along_y_are_the_same() {
    let along_x = Slider {
        blocks: [40, 1],
        ..Slider::default()
    };
    let along_y = Slider {
        blocks: [1, 40],
        degrees: 90.0,
        ..Slider::default()
    };
    let (one, other) = (along_x.model(), along_y.model());
    let mut one = at_rest(&one, 0.1);
    let mut other = at_rest(&other, 0.1);
    for _ in 0..2000 {
        one.step();
        other.step();
        let (one, other) = (one.state(), other.state());
        assert_eq!(one.displacement.x, other.displacement.y);
        assert_eq!(one.velocity.x, other.velocity.y);
    }
    assert!(one.peak().ended && one.peak().mu_star < 1.0);
    assert!(
        one.state().displacement.y.iter().all(|&u| u == 0.0),
        "a chain pulled along itself stays straight"
    );
}

/// Straight springs resist motion across a chain only to second order, so that each block slips as if it were
/// alone.
#[test]
fn a_chain_pulled_across_is_a_row_of_single_blocks() {
    let slider = Slider {
        blocks: [10, 1],
        degrees: 90.0,
        epsilon: 0.0,
        ..Slider::default()
    };
    let model = slider.model();
    let mut simulation = at_rest(&model, 0.1);
    for _ in 0..3000 {
        simulation.step();
    }
    let drawn = slider.coefficients();
    for b in 0..10 {
        let lattice = Lattice::free(1, 1);
        let surface = Surface::uniform(&lattice, drawn.mu_static[b], drawn.mu_kinetic[b]);
        assert_eq!(surface.static_limit(0), model.surface.static_limit(b));
        assert_eq!(surface.kinetic_force(0), model.surface.kinetic_force(b));
        let alone = Model::new(
            lattice,
            surface,
            model.drive.clone(),
            model.damping,
            0.0,
            model.friction,
        );
        let mut alone = at_rest(&alone, 0.1);
        for _ in 0..3000 {
            alone.step();
        }
        assert_eq!(
            alone.state().displacement.y[0],
            simulation.state().displacement.y[b]
        );
    }
}

/// Two blocks and one spring; its force acts on both with opposite signs.
#[test]
fn two_blocks_pull_on_each_other() {
    for (lattice, axis) in [(Lattice::free(2, 1), 0), (Lattice::free(1, 2), 1)] {
        let mut u = VectorField::zeros(2);
        let moved = if axis == 0 { &mut u.x } else { &mut u.y };
        moved[1] = 2.0;
        let force = lattice_forces(lattice, u, 0.0);
        let (along, across) = if axis == 0 {
            (force.x, force.y)
        } else {
            (force.y, force.x)
        };
        assert_eq!((along, across), (vec![1.5, -1.5], vec![0.0, 0.0]));
    }
}

#[test_matrix([[1, 1], [2, 2], [1, 2], [3, 1], [2, 9], [9, 2]], [0.0, 45.0])]
fn small_and_odd_lattices_go_through_their_transition(blocks: [usize; 2], degrees: f64) {
    let slider = Slider {
        blocks,
        degrees,
        ..Slider::default()
    };
    let peak = slider.onset();
    let (weakest, drawn) = (slider.model().surface.min_slip_threshold(), slider.coefficients());
    let strongest = drawn.mu_static.iter().fold(0.0_f64, |m, mu| m.max(*mu));
    // Between the weakest and the strongest block, except for the k_s V^2 of the slip itself.
    assert!(
        peak.ended && peak.mu_star > weakest - 1e-3 && peak.mu_star < strongest + 2e-3,
        "{peak:?}"
    );
}
