//! What a running simulation writes into a checkpoint.

use serde::{Serialize, Serializer};

use super::engine::Engine;
use super::totals::Totals;
use crate::checkpoint::Checkpoint;
use crate::measure::Peak;
use crate::model::Model;

/// One value of every block of a simulation, in the order of the lattice. The values are read as they are serialized, so
/// that a checkpoint needs no memory of its own.
#[derive(Clone, Copy)]
pub struct BlockColumn<'a> {
    engine: &'a Engine,
    n_blocks: usize,
    value: fn(&Engine, usize) -> f64,
}

impl Serialize for BlockColumn<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq((0..self.n_blocks).map(|b| (self.value)(self.engine, b)))
    }
}

/// All that is needed to continue later from `step`, the present one.
pub(crate) fn checkpoint<'a>(
    engine: &'a Engine,
    model: &Model,
    step: u64,
    totals: Totals,
    peak: Peak,
) -> Checkpoint<BlockColumn<'a>> {
    let column = |value| BlockColumn {
        engine,
        n_blocks: model.lattice.n_blocks(),
        value,
    };
    Checkpoint {
        step,
        totals,
        peak,
        stress_square_max: engine.stress_square_max(model, step),
        strain_bound: engine.strain_bound(),
        displacement: [
            column(|engine, b| engine.motion(b)[0][0]),
            column(|engine, b| engine.motion(b)[0][1]),
        ],
        velocity: [
            column(|engine, b| engine.checkpoint_velocity(b)[0]),
            column(|engine, b| engine.checkpoint_velocity(b)[1]),
        ],
        first_slip: column(Engine::first_slip),
    }
}
