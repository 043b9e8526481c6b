//! The rate at which a disturbance of steady sliding grows.

use slipfront::communicator::Alone;
use slipfront::exact_solutions::oscillation_growth;
use slipfront::{Model, State, VectorField};

use crate::common::from_state;

/// Growth rate of a small disturbance of steady sliding of blocks that move as a rigid body, from four
/// displacements at intervals of `apart` from the time `from` on. The disturbance is so small that laws are
/// linear to a millionth, and so large that rounding errors are smaller.
pub(crate) fn growth_of_disturbance(model: &Model, dt: f64, [from, apart]: [f64; 2]) -> f64 {
    let (v, n) = (model.drive.v_star, model.lattice.n_blocks());
    let behind = model.steady_level(&Alone) / model.drive.k_drive;
    let along_x = |x: f64| VectorField {
        x: vec![x; n],
        y: vec![0.0; n],
    };
    let state = State {
        displacement: along_x(1e-6 - behind),
        velocity: along_x(v),
    };
    let mut simulation = from_state(model, dt, state);
    let [first, pitch] = [from, apart].map(|time| (time / dt).round() as u64);
    let values = [0, 1, 2, 3].map(|k| {
        while simulation.snapshot().step < first + k * pitch {
            simulation.step();
        }
        let now = simulation.snapshot();
        now.block(0).displacement[0] + behind - v * now.time_star
    });
    oscillation_growth(values, pitch as f64 * dt)
}
