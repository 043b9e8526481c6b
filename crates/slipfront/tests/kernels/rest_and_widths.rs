//! The fused kernel on its own: vector widths, the bound on strains, and which vectors are skipped.

use proptest::prelude::*;
use slipfront::lattice::Bond;
use slipfront::surface::{Coefficients, Distribution, Load};
use slipfront::testing::FusedKernel;
use slipfront::{DeadLoad, Drive, Edges, FrictionLaw, Lattice, Model, State, Surface, VectorField, scales};

/// Number of steps between two measurements of displacements and their differences; in between, bounds are
/// used.
const MEASUREMENT_INTERVAL: u64 = 16;

fn model(lattice: Lattice, v_star: f64, degrees: f64, epsilon: f64) -> Model {
    let n = lattice.n_blocks();
    let gauss = |mean: f64| Distribution {
        mean,
        deviation: 0.1 * mean,
    };
    let drawn = Coefficients::draw(n, gauss(1.0), gauss(0.5), 3);
    let surface = Surface::new(drawn, vec![false; n], Load::Redistributed, 1.0).expect("all in contact");
    let drive = Drive::at_angle(v_star, degrees);
    Model::new(
        lattice,
        surface,
        drive,
        scales::damping(0.1),
        epsilon,
        FrictionLaw::Projection,
    )
}

/// The bits of all displacements, velocities and sums at every tenth step.
fn history(model: &Model, width: usize, steps: u64) -> Vec<u64> {
    let mut kernel = FusedKernel::new(model.clone(), 0.2, None, true, Some(width));
    let mut bits = Vec::new();
    for number in 0..=steps {
        let energies = number % 10 == 0;
        let totals = kernel.step(energies);
        if !energies {
            continue;
        }
        let stored = totals.stored_energy.expect("energies were asked for");
        let mut numbers = vec![
            totals.velocity_square,
            totals.friction_power,
            stored.kinetic,
            stored.lattice,
            stored.drive_springs,
            kernel.stress_square_max(),
        ];
        numbers.extend(
            [totals.displacement, totals.velocity, totals.velocity_after]
                .iter()
                .flatten(),
        );
        for b in 0..model.lattice.n_blocks() {
            numbers.extend(kernel.motion(b).iter().flatten());
        }
        bits.extend(numbers.into_iter().map(f64::to_bits));
    }
    let first_slips = kernel.first_slip_times_star();
    assert!(first_slips.iter().any(|&time_star| time_star > 0.0));
    bits
}

#[test]
fn every_vector_width_gives_the_same_bits() {
    // Either series, and the square root.
    for epsilon in [1e-6, 2e-4, 1e-2] {
        for edges in [[Edges::Free; 2], [Edges::Periodic; 2]] {
            for model in [model(Lattice::with_edges(21, 30, edges), 0.1, 20.0, epsilon)] {
                let narrowest = history(&model, 0, 250);
                for width in 1..FusedKernel::n_widths() {
                    assert!(
                        history(&model, width, 250) == narrowest,
                        "width {width} at {epsilon}, {edges:?}"
                    );
                }
            }
        }
    }
}

/// The bounds on displacements and their differences are never too small. They are too large by at most three
/// times the distance that the fastest block, at a speed below 1.5, moves between two measurements.
#[test]
fn displacements_are_bounded() {
    let model = model(Lattice::free(30, 30), 0.3, 20.0, 1e-3);
    // From rest, and with two blocks that fly apart.
    let mut apart = State::at_rest(900);
    (apart.velocity.x[0], apart.velocity.x[899]) = (-1.4, 1.4);
    for (from, skips) in [(None, false), (None, true), (Some(&apart), true)] {
        let mut kernel = FusedKernel::new(model.clone(), 0.2, from, skips, None);
        let mut n_sliding = 0;
        for _ in 0..400 {
            n_sliding = kernel.step(false).n_sliding;
            let (mut extent, mut difference) = ([f64::NEG_INFINITY; 4], [0.0_f64; 2]);
            for b in 0..model.lattice.n_blocks() {
                let [[x, y], _] = kernel.motion(b);
                let (i, j) = model.lattice.column_row(b);
                for other in Bond::ALL
                    .iter()
                    .filter_map(|bond| model.lattice.neighbour(i, j, bond.offset))
                {
                    let [u, _] = kernel.motion(other);
                    difference = [
                        difference[0].max((u[0] - x).abs()),
                        difference[1].max((u[1] - y).abs()),
                    ];
                }
                for (most, value) in extent.iter_mut().zip([x, -x, y, -y]) {
                    *most = most.max(value);
                }
            }
            for axis in 0..2 {
                let [low, high] = kernel.displacement_bounds(axis);
                for (exact, bound) in [
                    (extent[2 * axis], high),
                    (extent[2 * axis + 1], -low),
                    (difference[axis], kernel.difference_bound(axis)),
                ] {
                    // Displacements of up to 20 have rounding errors of 4e-15.
                    let over = bound - exact + 1e-13;
                    let largest = 3.0 * 1.5 * 0.2 * MEASUREMENT_INTERVAL as f64;
                    assert!((0.0..largest).contains(&over), "{exact}, bound {bound}");
                }
            }
        }
        assert!(n_sliding > 0);
    }
}

/// With a slow drive nearly all vectors are skipped until the first slip, and nearly half of them afterwards.
#[test]
fn slow_drives_are_mostly_rest() {
    let model = model(Lattice::free(64, 64), 0.002, 0.0, 1e-6);
    let mut kernel = FusedKernel::new(model, 0.5, None, true, None);
    // Number of swept vectors before and after the first slip, and number of steps after it.
    let (mut before, mut after, mut steps) = (0, 0, 0);
    for _ in 0..3000 {
        let n_sliding = kernel.step(false).n_sliding;
        let active = kernel.n_swept_vectors();
        if n_sliding > 0 || steps > 0 {
            steps += 1;
            after += active;
        } else {
            before += active;
        }
    }
    let vectors = kernel.n_vectors();
    assert!(steps > 1000 && steps < 2000, "{steps} steps after the first slip");
    // Once at the start, and just before the first slip.
    assert!(before <= 3 * vectors, "{before} of {vectors} vectors");
    assert!(
        after * 5 < 3 * steps * vectors,
        "{after} of {vectors} vectors in {steps} steps"
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    /// Displaced blocks at rest are skipped until the first slips, and are not swept much too early if the
    /// force on every block grows.
    #[test]
    fn rest_ends_in_time(
        u in prop::collection::vec([-0.1..0.1_f64, -0.1..0.1_f64], 9),
        holds in prop::collection::vec((0.5..2.0_f64, 0.2..1.5_f64), 9),
        v_star in 0.01..0.3_f64,
        degrees in prop_oneof![Just(0.0), Just(90.0), Just(180.0), 0.0..360.0_f64],
        constant in [-0.2..0.2_f64, -0.2..0.2_f64],
        dt_star in 0.05..0.5_f64,
    ) {
        let mut model = model(Lattice::free(3, 3), v_star, degrees, 1e-3);
        model = model.with_dead_load(DeadLoad::uniform(constant));
        for (b, (static_limit, kinetic_force)) in holds.into_iter().enumerate() {
            (model.surface.mu_static[b], model.surface.mu_kinetic[b]) = (static_limit, kinetic_force);
        }
        let state = State {
            displacement: VectorField { x: u.iter().map(|u| u[0]).collect(), y: u.iter().map(|u| u[1]).collect() },
            velocity: VectorField::zeros(9),
        };
        let along_an_axis = model.drive.direction.contains(&0.0);
        let mut resting = FusedKernel::new(model.clone(), dt_star, Some(&state), true, None);
        let mut plain = FusedKernel::new(model, dt_star, Some(&state), false, None);
        resting.step(false);
        let active_from = resting.active_from_step();
        let first = (0..100_000).find(|_| plain.step(false).n_sliding > 0).expect("a block slips");
        prop_assert!(active_from <= first, "active from step {active_from}, first slip at {first}");
        if along_an_axis && first > 0 {
            prop_assert!(first - active_from <= 5, "active from step {active_from}, first slip at {first}");
        }
    }
}
