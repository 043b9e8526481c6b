//! The fused kernel gives the same bits on any number of threads, with and without skipping, and across
//! checkpoints.

use slipfront::surface::{Orientation, Texture};
use slipfront::{Drive, Edges, Execution, FrictionLaw, Lattice, Model, Simulation, State, Stop, Surface};
use test_case::test_matrix;

use crate::common::{cavity, groove};
use crate::{bits, fused, go, has_room, sliders, stopped_and_resumed};

/// Everything that can be read from a run at one instant except its state.
pub(crate) fn shown(simulation: &Simulation) -> Vec<u64> {
    let now = simulation.snapshot();
    let (totals, contact) = (now.totals, now.contact);
    let stored = totals.stored_energy.unwrap_or_default();
    let mut numbers = vec![
        now.point.mu_star,
        now.point.mu_lateral_star,
        totals.velocity_square,
        totals.friction_power,
        totals.n_sliding as f64,
        totals.n_slipping as f64,
        stored.kinetic,
        stored.lattice,
        stored.drive_springs,
        simulation.contact_stress_max(),
        contact.spring_energy,
        contact.broken_energy,
        contact.mean_state,
        now.weakening_energy(),
        now.foundation_energy(),
    ];
    for pair in [totals.displacement, totals.velocity, totals.velocity_after] {
        numbers.extend(pair);
    }
    bits(&numbers)
}

/// x and y of the displacements, then of the velocities.
pub(crate) fn state(simulation: &Simulation) -> Vec<Vec<u64>> {
    let of = |State {
                  displacement: u,
                  velocity: v,
              }| [u.x, u.y, v.x, v.y].map(|field| bits(&field));
    let states = std::iter::once(simulation.state());
    states.flat_map(of).collect()
}

/// Compares the fused kernel on one thread without skipping with all other ways to execute it, including runs
/// in parts; energies are measured at some of the steps. Sums are compared at every step, whole states at
/// every seventh and at the last step: a difference stays in the state.
pub(crate) fn assert_same_bits(model: &Model, dt_star: f64, from: Option<&State>, steps: u64) {
    // A thread of the pool steps them: another thread would sleep and be woken at every step.
    rayon::scope(|_| assert_same_bits_in_pool(model, dt_star, from, steps));
}

fn assert_same_bits_in_pool(model: &Model, dt_star: f64, from: Option<&State>, steps: u64) {
    let of = |threads| {
        [false, true].map(|skips| Execution {
            threads,
            skips,
            ..fused()
        })
    };
    let unstopped = [1, 2, 3, 7]
        .into_iter()
        .flat_map(of)
        .skip(1)
        .map(|execution| (execution, u64::MAX));
    // After every step, at and between measurements of the extent of displacements, and rarely.
    let stopped = of(1).into_iter().chain(of(3)).zip([1, 5, 16, 61]);
    let skipping = of(1).into_iter().skip(1).map(|execution| (execution, 16));
    let executions: Vec<_> = unstopped.chain(stopped).chain(skipping).collect();
    let run = |execution| Simulation::new(model.clone(), dt_star, from.cloned(), execution);
    let mut plain = run(fused());
    let mut others: Vec<_> = executions
        .iter()
        .map(|(execution, _)| run(execution.clone()))
        .collect();
    for step in 1..=steps {
        for (other, (execution, every)) in others.iter_mut().zip(&executions) {
            if (step - 1).is_multiple_of(*every) {
                *other = stopped_and_resumed(other, model, dt_star, execution.clone());
            }
        }
        let energies = step % 5 == 0 || step % 7 == 0;
        go(&mut plain, energies);
        let here = shown(&plain);
        let exact = (step % 7 == 0 || step == steps).then(|| state(&plain));
        for (other, execution) in others.iter_mut().zip(&executions) {
            go(other, energies);
            let (found, expected) = (other.snapshot().totals, plain.snapshot().totals);
            assert!(
                shown(other) == here,
                "step {step}, {execution:?}: {found:?}, plainly {expected:?}; largest contact stress {}, plainly {}",
                other.contact_stress_max(),
                plain.contact_stress_max()
            );
            if let Some(exact) = &exact {
                assert!(state(other) == *exact, "step {step}, {execution:?}");
            }
        }
    }
    let first = plain.snapshot().first_slip_time_star();
    assert!(first.iter().any(|t| !t.is_nan()), "nothing ever slips");
    for (other, execution) in others.iter().zip(&executions) {
        assert!(
            bits(&other.snapshot().first_slip_time_star()) == bits(&first),
            "{execution:?}"
        );
    }
}

#[test_matrix(
    [[1, 1], [25, 25], [64, 40], [3, 400], [300, 5], [700, 3]],
    [
        [Edges::Free, Edges::Free], [Edges::Periodic, Edges::Free], [Edges::Free, Edges::Periodic],
        [Edges::Periodic, Edges::Periodic]
    ]
)]
fn lattices_of_every_shape(blocks: [usize; 2], edges: [Edges; 2]) {
    if !has_room(blocks, edges) {
        return;
    }
    let slider = sliders::shaped(blocks, edges);
    assert_same_bits(&slider.model(), slider.dt_star, None, slider.steps(4.0));
}

/// The strains need either series and the square root, and change from one to another.
#[test_matrix(
    [None, Some(cavity([40, 40], 5.0, 1, 0.3, true)), Some(groove(Orientation::Across, 2.0))],
    [0.0, 2e-5, 1e-3, 5e-3]
)]
fn textures_and_strains(texture: Option<Texture>, epsilon: f64) {
    let slider = sliders::textured(texture, epsilon);
    assert_same_bits(&slider.model(), slider.dt_star, None, slider.steps(4.0));
}

/// For a drive that never stands still, the kernel predicts when skipped blocks slip.
#[test_matrix(
    [([40, 24], Edges::Free), ([300, 3], Edges::Free), ([3, 200], Edges::Periodic)],
    [0.0, 65.0],
    [false, true]
)]
fn held_drives((blocks, edges): ([usize; 2], Edges), degrees: f64, has_program: bool) {
    let slider = sliders::held(blocks, edges, degrees, has_program);
    assert_same_bits(&slider.model(), slider.dt_star, None, 2 * slider.steps(4.0));
}

/// All executions find rest by force at the same step, if exact rest has not come within 1000 times the time
/// of a front across the slider.
#[test]
fn creep_under_a_held_drive() {
    let slider = sliders::creeping();
    assert_same_bits(&slider.model(), slider.dt_star, None, 90);
    let mut simulation = Simulation::new(slider.model(), slider.dt_star, None, fused());
    simulation.run(Stop::at_step(90), &mut []).unwrap();
    let now = simulation.snapshot();
    let longest = 1000.0 * 12.0 / slider.dt_star;
    let stood = (now.step - now.drive_steps) as f64;
    assert!(
        (longest..1.5 * longest).contains(&stood),
        "{stood} steps for {longest}"
    );
}

/// The strains need every spring formula, and the formula changes while blocks are at rest.
#[test_matrix(
    [
        ([40, 24], Edges::Free), ([40, 24], Edges::Periodic), ([300, 3], Edges::Free),
        ([3, 200], Edges::Periodic)
    ],
    [(0.0, 1e-6), (65.0, 3e-4), (0.0, 1.7e-3), (65.0, 4e-3)]
)]
fn slow_drives((blocks, edges): ([usize; 2], Edges), (degrees, epsilon): (f64, f64)) {
    let slider = sliders::slow(blocks, edges, degrees, epsilon);
    assert_same_bits(&slider.model(), slider.dt_star, None, slider.steps(2.6));
}

#[test_matrix(
    [[Edges::Free, Edges::Free], [Edges::Periodic, Edges::Free], [Edges::Periodic, Edges::Periodic]],
    [1e-6, 1e-2]
)]
fn a_state_in_motion(edges: [Edges; 2], epsilon: f64) {
    let (slider, from) = sliders::in_motion(edges, epsilon);
    assert_same_bits(&slider.model(), slider.dt_star, Some(&from), 300);
}

/// A tile of 16 rows is at rest. In its first row a block with a larger threshold than all others is about to
/// slip. It does so one step after the block that pushes it, in the last row of the tile below: the largest
/// contact stress occurs in its last step at rest.
#[test]
fn the_largest_stress_may_be_that_of_the_last_step_at_rest() {
    let lattice = Lattice::free(16, 32);
    let (pushing, stored) = (lattice.block(8, 15), lattice.block(9, 16));
    let mut from = State::at_rest(512);
    from.displacement.x[pushing] = -1.0;
    from.displacement.x[stored] = -4.0;
    let model = |surface| {
        Model::new(
            lattice,
            surface,
            Drive::along_x(0.001),
            0.0,
            0.0,
            FrictionLaw::Projection,
        )
    };
    let dt_star = 0.5;
    let mut surface = Surface::uniform(&lattice, 20.0, 20.0);
    let firm = model(surface.clone());
    // Thresholds that the pushing block reaches after 50 steps, and the pushed one after 80 if nothing pushes
    // it.
    for (b, steps) in [(pushing, 50.0), (stored, 80.0)] {
        let block = Simulation::new(firm.clone(), dt_star, Some(from.clone()), fused())
            .snapshot()
            .block(b);
        let [x, y] = [0, 1].map(|axis| block.force_drive[axis] + block.force_lattice[axis]);
        surface.mu_static[b] = (x + steps * dt_star * 0.375 * 0.001).hypot(y);
        surface.mu_kinetic[b] = surface.mu_static[b] - 0.5;
    }
    let model = model(surface);
    assert_same_bits(&model, dt_star, Some(&from), 60);
}
