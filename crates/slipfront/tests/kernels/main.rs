//! The same cases on every kernel and every way to execute it: the fused kernel against the reference to rounding, and
//! against itself, on any number of threads and leaving blocks at rest alone or not, bit for bit.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

#[path = "../common/mod.rs"]
mod common;

use slipfront::{Edges, Execution, Kernel, Lattice, Model, Simulation, Stop};

/// What steps the simulations of this binary that do not say.
const KERNEL: Kernel = Kernel::Fused;

/// The fused kernel at its plainest: one thread, every block at every step.
const FUSED: Execution = Execution {
    kernel: Kernel::Fused,
    threads: 1,
    skips: false,
};

const REFERENCE: Execution = Execution {
    kernel: Kernel::Reference,
    ..FUSED
};

/// A step further, at whose end the energies held are known if `energies` asks for them.
fn go(simulation: &mut Simulation, energies: bool) {
    if energies {
        let next = simulation.snapshot().step + 1;
        simulation.run(Stop::at_step(next), &mut []).unwrap();
    } else {
        simulation.step();
    }
}

/// To compare numbers to the last bit, those among them that are none.
fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|x| x.to_bits()).collect()
}

/// Whether a lattice of `blocks` can have such edges.
fn has_room(blocks: [usize; 2], edges: [Edges; 2]) -> bool {
    (0..2).all(|axis| edges[axis] == Edges::Free || blocks[axis] >= Lattice::MIN_PERIODIC)
}

/// The simulation that goes on from what is written down of this one.
fn stopped_and_resumed<'m>(
    simulation: &Simulation,
    model: &'m Model,
    dt_star: f64,
    execution: Execution,
) -> Simulation<'m> {
    let bytes = postcard::to_stdvec(&simulation.checkpoint()).unwrap();
    let checkpoint = postcard::from_bytes(&bytes).unwrap();
    Simulation::resume(model, dt_star, checkpoint, execution).unwrap()
}

mod against_reference;
mod checkpoints;
mod executions;
