//! Elastic constants of the slider that follow from the springs k_1 and k_2, measured by stretching it.

use std::sync::Arc;

use slipfront::{Execution, Model, Simulation, State};

use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::runner::FigureRunner;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let case = runner.case("table1/case8", &[])?;
    let model = case.model;
    data.value("poisson_ratio", poisson_ratio(&model));
    data.value("young_modulus", young_modulus(&model));
    Ok(())
}

/// Forces of the springs on all blocks (Eq. 3) after a uniform stretch by these multiples of the strain
/// epsilon.
fn forces(model: &Arc<Model>, [stretch_x, stretch_y]: [f64; 2]) -> Vec<[f64; 2]> {
    let lattice = &model.lattice;
    let mut state = State::at_rest(lattice.n_blocks());
    for block in 0..lattice.n_blocks() {
        let (i, j) = lattice.column_row(block);
        state.displacement.x[block] = stretch_x * i as f64;
        state.displacement.y[block] = stretch_y * j as f64;
    }
    // At step 0, nothing has moved yet, so the time step has no effect.
    let simulation = Simulation::new(model.clone(), 0.1, Some(state), Execution::default());
    let snapshot = simulation.snapshot();
    (0..lattice.n_blocks())
        .map(|block| snapshot.block(block).force_lattice)
        .collect()
}

/// Lateral contraction per unit of stretch along x for which a free edge is without force.
fn poisson_ratio(model: &Arc<Model>) -> f64 {
    let lattice = &model.lattice;
    let edge = lattice.block(lattice.nx / 2, 0);
    let force = |stretch| forces(model, stretch)[edge][1];
    force([1.0, 0.0]) / force([0.0, 1.0])
}

/// Stress at the ends over strain, in units of E, of a slider that is stretched along x and has free sides.
fn young_modulus(model: &Arc<Model>) -> f64 {
    let lattice = &model.lattice;
    let forces = forces(model, [1.0, -poisson_ratio(model)]);
    let pull: f64 = (0..lattice.ny)
        .map(|j| -forces[lattice.block(lattice.nx - 1, j)][0])
        .sum();
    pull / lattice.ny as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use slipfront::{Drive, FrictionLaw, Lattice, Surface};

    fn model(lattice: Lattice) -> Arc<Model> {
        let surface = Surface::uniform(&lattice, 1.0, 0.5);
        Arc::new(Model::new(
            lattice,
            surface,
            Drive::along_x(0.03),
            0.0,
            1e-6,
            FrictionLaw::Projection,
        ))
    }

    /// Each of n rows contributes k_1 = 3/4 to the stiffness, and the diagonals of each of n - 1 pairs of
    /// rows contribute (2/3) k_2 = 1/4.
    #[test]
    fn a_strip_lacks_a_quarter_of_a_row() {
        for n in [5, 25, 100] {
            let model = model(Lattice::free(9, n));
            // Springs rotate by a millionth, the strain.
            assert!((poisson_ratio(&model) - 1.0 / 3.0).abs() < 1e-5);
            assert!((young_modulus(&model) - (1.0 - 0.25 / n as f64)).abs() < 1e-5);
        }
    }

    /// The stretch is an equilibrium: forces act only on blocks at the two pulled ends.
    #[test]
    fn a_uniform_stretch_is_an_equilibrium() {
        let model = model(Lattice::free(9, 7));
        let lattice = &model.lattice;
        for (block, [x, y]) in forces(&model, [1.0, -1.0 / 3.0]).into_iter().enumerate() {
            let (i, _) = lattice.column_row(block);
            assert!(
                i == 0 || i == lattice.nx - 1 || (x.abs() < 1e-5 && y.abs() < 1e-5),
                "{block}"
            );
        }
    }
}
