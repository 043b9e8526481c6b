//! The sheets above the lowest one: their motion, and the springs between them.

use std::ops::Range;

use super::drive::DrivenBlocks;
use super::rows::Rows;
use super::springs::{lattice_forces, row_energies};
use super::weighted::{WeightedScratch, dot_products};
use crate::forces::{part, part_mut};
use crate::model::Model;
use crate::sheets::Sheet;
use crate::state::State;
use crate::vector_field::VectorField;
use slipfront_kernel::Integrator;
use slipfront_kernel::fixed_point::RunningSum;

/// The blocks of a band in a sheet above the lowest one.
pub(super) struct UpperSheet {
    sheet: Sheet,
    pub(super) rows: Rows,
    /// Displacements at t_n, velocities half a step later.
    pub(super) state: State,
    /// Velocities after the update within a step; between steps the velocities before the update.
    pub(super) velocity: VectorField,
    /// Force of the springs between the blocks of the sheet, over its thickness.
    lattice: VectorField,
    springs: [VectorField; 4],
    /// Force of the springs to the sheet above, or to the drive.
    pull: VectorField,
}

impl UpperSheet {
    pub(super) fn new(model: &Model, sheet: Sheet) -> Self {
        let (n, rows) = (model.surface.n_blocks(), Rows::new(model));
        let zeros = || VectorField::zeros(n);
        Self {
            sheet,
            state: State::at_rest(n),
            velocity: zeros(),
            lattice: zeros(),
            springs: [(); 4].map(|()| VectorField::zeros(rows.lattice.n_blocks())),
            pull: zeros(),
            rows,
        }
    }

    /// Columns of a checkpoint, see [`Model::n_memory_columns`].
    pub(super) fn columns(&self) -> [&[f64]; 4] {
        let u = &self.state.displacement;
        // Velocity half a step before the present instant, which a resumed run evaluates again.
        let v = &self.velocity;
        [&u.x, &u.y, &v.x, &v.y]
    }

    /// The arrays into which the columns of a checkpoint are read when a run resumes.
    pub(super) fn columns_mut(&mut self) -> [&mut [f64]; 4] {
        let State {
            displacement: u,
            velocity: v,
        } = &mut self.state;
        [&mut u.x, &mut u.y, &mut v.x, &mut v.y]
    }

    /// Velocities of some blocks half a step before and after, within a step.
    #[inline(always)]
    pub(super) fn velocities(&self, blocks: &Range<usize>) -> [[&[f64]; 2]; 2] {
        [&self.state.velocity, &self.velocity].map(|v| part(v, blocks))
    }

    /// Adds `m v^2` of some blocks to a sum.
    #[inline(always)]
    pub(super) fn add_velocity_square(
        &self,
        blocks: &Range<usize>,
        velocity: [&[f64]; 2],
        sum: &mut RunningSum,
        scratch: &mut WeightedScratch,
    ) {
        let terms = &mut scratch.terms[..blocks.len()];
        dot_products(velocity, velocity, terms);
        terms.iter_mut().for_each(|term| *term *= self.sheet.thickness);
        sum.add(terms);
    }

    /// Energies of the springs between the blocks of the sheet: along each bond one value for every row.
    pub(super) fn row_energies(&self, model: &Model, scratch: &mut WeightedScratch) -> [Vec<f64>; 4] {
        let u = &self.rows.state(&self.state).displacement;
        let mut energies = row_energies(model, &self.rows, u, None, &mut scratch.terms);
        let all = energies.iter_mut().flatten();
        all.for_each(|energy| *energy *= self.sheet.thickness);
        energies
    }
}

/// Computes the pull of the drive and of other sheets on some blocks: on those of the lowest sheet into
/// `lowest`, and on those of the sheets above.
#[inline(always)]
pub(super) fn pull(
    sheets: &mut [UpperSheet],
    driven: &DrivenBlocks,
    model: &Model,
    blocks: &Range<usize>,
    displacement: &VectorField,
    drive_time_star: f64,
    lowest: &mut VectorField,
) {
    let Some(highest) = sheets.last_mut() else {
        driven.forces(model, blocks, displacement, drive_time_star, lowest);
        return;
    };
    let u = &highest.state.displacement;
    driven.forces(model, blocks, u, drive_time_star, &mut highest.pull);
    couple(sheets[0].sheet, &sheets[0].state, displacement, blocks, lowest);
    for above in 1..sheets.len() {
        let (below, above) = sheets.split_at_mut(above);
        if let (Some(below), Some(above)) = (below.last_mut(), above.first()) {
            let UpperSheet { state, pull, .. } = below;
            couple(above.sheet, &above.state, &state.displacement, blocks, pull);
        }
    }
}

/// Force of the springs to a sheet on some blocks of the sheet below it, `g (u_k - u_k-1)`.
#[inline(always)]
fn couple(sheet: Sheet, above: &State, below: &VectorField, blocks: &Range<usize>, pull: &mut VectorField) {
    let components = part_mut(pull, blocks).into_iter();
    let ends = part(&above.displacement, blocks)
        .into_iter()
        .zip(part(below, blocks));
    for (pull, (above, below)) in components.zip(ends) {
        let pairs = above.iter().zip(below);
        pull.iter_mut()
            .zip(pairs)
            .for_each(|(pull, (above, below))| *pull = sheet.coupling * (above - below));
    }
}

/// Computes the next velocities of some blocks of the sheets above, after [`pull`]; `lowest` is the pull on
/// the lowest sheet.
#[inline(always)]
pub(super) fn accelerate(
    sheets: &mut [UpperSheet],
    model: &Model,
    blocks: &Range<usize>,
    lowest: &VectorField,
    integrator: Integrator,
) {
    let n = blocks.len();
    let mut reaction = lowest;
    for one in sheets {
        let UpperSheet {
            sheet,
            rows,
            state,
            velocity,
            lattice,
            springs,
            pull,
        } = one;
        lattice_forces(model, rows, blocks, rows.state(state), None, lattice, springs);
        let integrator = integrator.of_mass(sheet.thickness);
        let [vx, vy] = part(&state.velocity, blocks).map(|v| &v[..n]);
        let [lx, ly] = part(lattice, blocks).map(|force| &force[..n]);
        let [px, py] = part(pull, blocks).map(|force| &force[..n]);
        let [rx, ry] = part(reaction, blocks).map(|force| &force[..n]);
        let [ax, ay] = part_mut(velocity, blocks).map(|v| &mut v[..n]);
        for k in 0..n {
            let force = [
                sheet.thickness * lx[k] + (px[k] - rx[k]),
                sheet.thickness * ly[k] + (py[k] - ry[k]),
            ];
            [ax[k], ay[k]] = integrator.accelerate([vx[k], vy[k]], force);
        }
        reaction = pull;
    }
}

/// Adds `g (u_k - u_k-1)^2` of the springs between the sheets at some blocks to a sum.
#[inline(always)]
pub(super) fn add_squares(
    sheets: &[UpperSheet],
    blocks: &Range<usize>,
    displacement: &VectorField,
    sum: &mut RunningSum,
    scratch: &mut WeightedScratch,
) {
    let n = blocks.len();
    let mut below = displacement;
    for one in sheets {
        let above = &one.state.displacement;
        let ([x, y], [ux, uy]) = (part(above, blocks), part(below, blocks));
        let (x, y, ux, uy, terms) = (&x[..n], &y[..n], &ux[..n], &uy[..n], &mut scratch.terms[..n]);
        for k in 0..n {
            let (x, y) = (x[k] - ux[k], y[k] - uy[k]);
            terms[k] = one.sheet.coupling * (x * x + y * y);
        }
        sum.add(terms);
        below = above;
    }
}
