//! The fused kernel agrees with the general kernel to rounding.

use slipfront::Totals;
use slipfront::surface::{Orientation, Texture};
use slipfront::{
    DeadLoad, Drive, Edges, FrictionLaw, Lattice, Model, Simulation, State, Surface, VectorField,
};
use test_case::test_matrix;

use crate::common::{self, Slider, cavity, groove};
use crate::fields::assert_fields_match_blocks;
use crate::{bits, fused, general, go, has_room};

/// Rounding errors differ by 1e-16 per spring and step, and slip amplifies them somewhat: to about 1e-14 up
/// to the end of the first peak, in displacements and velocities of the order of 1.
const ROUNDING: f64 = 1e-13;

/// The fused kernel rounds every term of a sum to 2^-52 of a bound on it. Terms are squares of speeds and of
/// differences of displacement between neighbours. At speeds of 1 their bounds are at most 4000: the square
/// of what such speeds add to a difference until it is measured again, times the inverse of the time step.
const ROUNDING_OF_TERMS: f64 = 1e-12;

fn largest(a: &VectorField) -> f64 {
    a.x.iter().chain(&a.y).fold(1.0, |most, x| x.abs().max(most))
}

fn distance(a: &VectorField, b: &VectorField) -> f64 {
    let x = a.x.iter().zip(&b.x);
    x.chain(a.y.iter().zip(&b.y))
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

/// All sums, with those over all blocks divided by their number.
fn means(totals: &Totals, n_blocks: usize) -> Vec<f64> {
    let stored = totals.stored_energy.unwrap_or_default();
    let mut sums = vec![
        totals.velocity_square,
        totals.friction_power,
        stored.kinetic,
        stored.lattice,
        stored.drive_springs,
    ];
    for pair in [totals.displacement, totals.velocity, totals.velocity_after] {
        sums.extend(pair);
    }
    sums.iter().map(|sum| sum / n_blocks as f64).collect()
}

fn assert_alike(fused: &Simulation, general: &Simulation) {
    let (one, other) = (fused.snapshot(), general.snapshot());
    let (here, there) = (one.totals, other.totals);
    let step = one.step;
    assert_eq!(
        (here.n_sliding, here.n_slipping),
        (there.n_sliding, there.n_slipping),
        "step {step}"
    );
    assert_eq!(here.stored_energy.is_some(), there.stored_energy.is_some());
    let n = one.model.lattice.n_blocks();
    let speed = largest(&general.state().velocity);
    for (a, b) in means(&here, n).iter().zip(means(&there, n)) {
        // Energies of stretched springs may exceed 1.
        assert!(
            (a - b).abs() < ROUNDING * b.abs() + ROUNDING_OF_TERMS * speed * speed,
            "step {step}: {here:?} {there:?}"
        );
    }
    assert!((one.point.mu_star - other.point.mu_star).abs() < ROUNDING);
    let stresses = [fused.contact_stress_max(), general.contact_stress_max()];
    assert!(
        (stresses[0] - stresses[1]).abs() < ROUNDING,
        "step {step}: {stresses:?}"
    );
    let (here, there) = (fused.state(), general.state());
    {
        for (a, b) in [
            (&here.displacement, &there.displacement),
            (&here.velocity, &there.velocity),
        ] {
            let far = distance(a, b);
            // Only blocks without friction move by more than 1.
            assert!(far < ROUNDING * largest(b), "step {step}: {far:e} apart");
        }
    }
}

/// Compares both kernels for up to `steps` steps, or until the first peak has ended; energies are measured at
/// some of the steps.
pub(crate) fn assert_same(model: &Model, dt_star: f64, state: Option<&State>, steps: u64) {
    let run = |execution| Simulation::new(model.clone(), dt_star, state.cloned(), execution);
    let (mut fused, mut general) = (run(fused()), run(general()));
    assert_alike(&fused, &general);
    for step in 1..=steps {
        let energies = step % 3 == 0;
        go(&mut fused, energies);
        go(&mut general, energies);
        assert_alike(&fused, &general);
        if general.peak().ended {
            break;
        }
    }
    let first = general.snapshot().first_slip_time_star();
    assert!(first.iter().any(|t| !t.is_nan()), "nothing ever slips");
    assert_eq!(bits(&fused.snapshot().first_slip_time_star()), bits(&first));
    // The forces of the fused kernel are recomputed from its displacements and velocities.
    let bound = ROUNDING * largest(&general.state().displacement);
    assert_fields_match_blocks(&fused);
    for b in 0..model.lattice.n_blocks() {
        let (here, there) = (fused.snapshot().block(b), general.snapshot().block(b));
        let forces = [
            (here.force_drive, there.force_drive),
            (here.force_lattice, there.force_lattice),
            (here.force_friction, there.force_friction),
        ];
        for (a, b) in forces {
            assert!(
                (a[0] - b[0]).abs() < bound && (a[1] - b[1]).abs() < bound,
                "{here:?} {there:?}"
            );
        }
        assert_eq!(here.slides, there.slides);
    }
    for run in [fused, general] {
        assert_eq!(bits(&run.into_first_slip_time_star()), bits(&first));
    }
}

/// Sizes equal and close to those of a vector, of the shortest row, and of a tile; and rows of 24 blocks in
/// so many tiles that they begin at every position of the ring buffer of springs, which is 37 vectors long in
/// this case.
#[test_matrix(
    [
        [1, 1], [1, 20], [20, 1], [5, 7], [13, 11], [14, 9], [16, 16], [17, 3], [25, 25], [64, 40], [3, 400],
        [254, 5], [24, 400], [256, 4], [300, 5], [700, 3]
    ],
    [
        [Edges::Free, Edges::Free], [Edges::Periodic, Edges::Free], [Edges::Free, Edges::Periodic],
        [Edges::Periodic, Edges::Periodic]
    ],
    [0.0, 20.0, 90.0]
)]
fn lattices_of_every_shape(blocks: [usize; 2], edges: [Edges; 2], degrees: f64) {
    if !has_room(blocks, edges) {
        return;
    }
    let slider = Slider {
        blocks,
        edges,
        degrees,
        v_star: 0.1,
        seed: 7,
        ..Slider::default()
    };
    assert_same(&slider.model(), slider.dt_star, None, slider.steps(5.0));
}

/// Strains for which spring forces are computed from either series or the square root, and all other
/// parameters of a step.
#[test_matrix(
    [0.0, 1e-6, 1e-4, 1e-3, 1e-2],
    [0.0, 0.1, 3.0],
    [0.25, 0.5, 1.0],
    [None, Some(cavity([25, 25], 10.0, 1, 0.3, true)), Some(groove(Orientation::Along, 3.0))],
    [[Edges::Free, Edges::Free], [Edges::Periodic, Edges::Periodic]]
)]
fn forces_of_every_kind(
    epsilon: f64,
    omega_star: f64,
    r_star: f64,
    texture: Option<Texture>,
    edges: [Edges; 2],
) {
    let slider = Slider {
        epsilon,
        omega_star,
        r_star,
        edges,
        textures: texture.into_iter().collect(),
        degrees: 30.0,
        v_star: 0.1,
        ..Slider::default()
    };
    assert_same(&slider.model(), slider.dt_star, None, slider.steps(4.0));
}

/// A front driven by a dead load, without drive springs: mu* stays constant and no peak ends.
#[test_matrix([[80, 1], [80, 3], [300, 5]], [[1.0, 0.0], [0.0, 1.0], [0.6, 0.8]])]
fn a_dead_load_alone(blocks: [usize; 2], direction: [f64; 2]) {
    let lattice = Lattice::free(blocks[0], blocks[1]);
    let mut surface = Surface::uniform(&lattice, 1.0, 0.25);
    for j in 0..blocks[1] {
        surface.mu_static[lattice.block(0, j)] = 0.0;
    }
    let drive = Drive {
        v_star: 0.0,
        direction,
        k_drive: 0.0,
        ..Drive::along_x(0.0)
    };
    let model = Model::new(lattice, surface, drive, 0.0, 1e-3, FrictionLaw::Projection)
        .with_dead_load(DeadLoad::uniform(direction.map(|d| 0.8 * d)));
    assert_same(&model, 0.1, None, 400);
}

/// Blocks displaced at the start, some of them with a velocity.
#[test_matrix(
    [[1, 1], [17, 5], [5, 60], [300, 4]],
    [
        [Edges::Free, Edges::Free], [Edges::Periodic, Edges::Free], [Edges::Free, Edges::Periodic],
        [Edges::Periodic, Edges::Periodic]
    ],
    [1e-6, 1e-2]
)]
fn a_state_in_motion(blocks: [usize; 2], edges: [Edges; 2], epsilon: f64) {
    if !has_room(blocks, edges) {
        return;
    }
    let slider = Slider {
        blocks,
        edges,
        epsilon,
        degrees: 200.0,
        ..Slider::default()
    };
    let state = common::thrown(slider.lattice().n_blocks(), 1.0, 3);
    // Until most blocks are at rest.
    assert_same(&slider.model(), slider.dt_star, Some(&state), 100);
}

/// The kernels agree far beyond the first peak: friction does not amplify differences, so that the kernels
/// would diverge only if the force on a block came so close to its threshold that rounding decides whether it
/// slips.
#[test_matrix([[25, 25], [64, 30]], [(0.03, 0.1, 0.5), (0.2, 0.0, 0.25), (0.3, 0.0, 0.0)], [1e-6, 1e-2])]
fn whole_runs(blocks: [usize; 2], (v_star, omega_star, r_star): (f64, f64, f64), epsilon: f64) {
    let slider = Slider {
        blocks,
        v_star,
        omega_star,
        r_star,
        epsilon,
        degrees: 10.0,
        textures: vec![cavity(blocks, 5.0, 1, 0.2, false)],
        ..Slider::default()
    };
    let model = slider.model();
    let run = |execution| Simulation::new(model.clone(), slider.dt_star, None, execution);
    let (mut fused, mut general) = (run(fused()), run(general()));
    for step in 1..=slider.steps(16.0) {
        go(&mut fused, false);
        go(&mut general, false);
        if step % 100 == 0 {
            assert_alike(&fused, &general);
        }
        let [here, there] = [&fused, &general].map(|run| run.snapshot().point);
        assert_eq!(here.n_sliding, there.n_sliding, "step {step}");
        assert!((here.mu_star - there.mu_star).abs() < ROUNDING, "step {step}");
    }
    assert!(general.peak().ended);
}
