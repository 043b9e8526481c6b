//! Comparison of all kernels and ways to execute them: the fused kernel agrees with the general kernel to
//! rounding, and has the same bits on any number of threads, with and without skipping.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.
#![allow(clippy::needless_pass_by_value)] // Values of a test are passed to it as they are written.

#[path = "../common/mod.rs"]
mod common;

use std::convert::Infallible;

use slipfront::{Edges, Execution, Kernel, Lattice, Model, Simulation, Stop};

use self::common::{fused, general};

/// The kernel of the simulations created by the common helpers.
const KERNEL: Kernel = Kernel::Fused;

/// Makes one step, or with `energies` steps until the drive has moved, including steps in which it stands
/// still; then the stored energies are known.
fn go(simulation: &mut Simulation, energies: bool) {
    if energies {
        let next = simulation.snapshot().drive_steps + 1;
        simulation.run(Stop::at_step(next), &mut []).unwrap();
    } else {
        simulation.step();
    }
}

/// The bits of numbers, to compare NaN as well.
fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|x| x.to_bits()).collect()
}

/// Whether a lattice of `blocks` can have such edges.
fn has_room(blocks: [usize; 2], edges: [Edges; 2]) -> bool {
    (0..2).all(|axis| edges[axis] == Edges::Free || blocks[axis] >= Lattice::MIN_PERIODIC)
}

/// The values of all blocks that a checkpoint keeps.
fn columns(simulation: &Simulation) -> Vec<Vec<f64>> {
    let mut columns = vec![Vec::new(); simulation.snapshot().model.n_columns()];
    let Ok(()) = simulation.write_columns(|column, first, values| {
        let saved = &mut columns[column];
        assert_eq!(saved.len(), first, "column {column}");
        saved.extend(values);
        Ok::<(), Infallible>(())
    });
    columns
}

/// A simulation that continues from a checkpoint of this one, if the checkpoint belongs to the same kernel.
fn resumed(simulation: &Simulation, model: &Model, dt_star: f64, execution: Execution) -> Option<Simulation> {
    let bytes = postcard::to_stdvec(&simulation.checkpoint()).unwrap();
    let checkpoint = postcard::from_bytes(&bytes).unwrap();
    let columns = columns(simulation);
    let read = |column: usize, first: usize, values: &mut [f64]| {
        values.copy_from_slice(&columns[column][first..][..values.len()]);
        Ok::<(), Infallible>(())
    };
    let Ok(resumed) = Simulation::resume(model.clone(), dt_star, &checkpoint, execution, read);
    resumed
}

/// A simulation that continues from a checkpoint of this one.
fn stopped_and_resumed(
    simulation: &Simulation,
    model: &Model,
    dt_star: f64,
    execution: Execution,
) -> Simulation {
    resumed(simulation, model, dt_star, execution).unwrap()
}

mod against_general;
mod checkpoints;
mod events;
mod executions;
mod fields;
mod general_divided;
mod handed_over;
mod ranks;
mod replay;
mod rest_and_widths;
mod sliders;
mod small_velocities;
mod variations;
