//! The drive springs (Eq. 2) and the dead load: forces, energy, and their sums over blocks.

use std::ops::Range;

use super::weighted::{WeightedScratch, add_weighted, dot_products};
use crate::dead_load::DeadLoad;
use crate::forces::{part, part_mut, values_of};
use crate::model::Model;
use crate::vector_field::VectorField;
use slipfront_kernel::fixed_point::RunningSum;

/// Properties of the drive of each block in addition to the drive springs of its model.
#[derive(Debug)]
pub(super) struct DrivenBlocks {
    /// Direction `g` of a drive that rotates, see [`Drive::direction_at`](crate::Drive::direction_at).
    direction: Option<VectorField>,
}

impl DrivenBlocks {
    pub(super) fn new(model: &Model) -> Self {
        let lattice = &model.lattice;
        let direction = || {
            let blocks = lattice.blocks_of(&model.rows);
            let directions = blocks.map(|b| model.drive.direction_at(lattice, b).into());
            let (x, y): (Vec<f64>, Vec<f64>) = directions.unzip();
            VectorField { x, y }
        };
        Self {
            direction: model.drive.rotation.map(|_| direction()),
        }
    }

    /// Forces of the drive springs (Eq. 2) on some blocks at a time of the drive, `F_s = k_s,i (V t - u)`,
    /// with the dead load. Where there is a mean displacement, all springs have it for u.
    #[inline(always)]
    pub(super) fn forces(
        &self,
        model: &Model,
        blocks: &Range<usize>,
        (u, mean): (&VectorField, Option<[f64; 2]>),
        drive_time_star: f64,
        force: &mut VectorField,
    ) {
        let (k_drive, n) = (model.drive.k_drive, blocks.len());
        let ([fx, fy], [ux, uy]) = (part_mut(force, blocks), part(u, blocks));
        // The cases are distinguished outside of the loops, which then have no branches and are vectorised.
        match (&self.direction, mean) {
            (None, Some([ux, uy])) => {
                let [x, y] = model.drive.position(drive_time_star);
                fx.fill(k_drive * (x - ux));
                fy.fill(k_drive * (y - uy));
            }
            (None, None) => {
                let [x, y] = model.drive.position(drive_time_star);
                for k in 0..n {
                    fx[k] = k_drive * (x - ux[k]);
                    fy[k] = k_drive * (y - uy[k]);
                }
            }
            (Some(direction), _) => {
                let path = model.drive.path(drive_time_star);
                let [gx, gy] = part(direction, blocks);
                for k in 0..n {
                    fx[k] = k_drive * (path * gx[k] - ux[k]);
                    fy[k] = k_drive * (path * gy[k] - uy[k]);
                }
            }
        }
        if let Some(relative) = relative(model, blocks) {
            for k in 0..n {
                fx[k] *= relative[k];
                fy[k] *= relative[k];
            }
        }
        if model.dead_load.acts() {
            add_dead_load(model, blocks, [fx, fy]);
        }
    }

    /// Adds `(V t - u)^2` of the springs of some blocks, each weighted with its relative stiffness.
    #[inline(always)]
    pub(super) fn add_squares(
        &self,
        model: &Model,
        blocks: &Range<usize>,
        (u, mean): (&VectorField, Option<[f64; 2]>),
        drive_time_star: f64,
        sum: &mut RunningSum,
        scratch: &mut WeightedScratch,
    ) {
        let ([ux, uy], n) = (part(u, blocks), blocks.len());
        let squares = &mut scratch.terms[..n];
        match (&self.direction, mean) {
            (None, Some([ux, uy])) => {
                let [x, y] = model.drive.position(drive_time_star);
                let (x, y) = (x - ux, y - uy);
                squares.fill(x * x + y * y);
            }
            (None, None) => {
                let [x, y] = model.drive.position(drive_time_star);
                for k in 0..n {
                    let (x, y) = (x - ux[k], y - uy[k]);
                    squares[k] = x * x + y * y;
                }
            }
            (Some(direction), _) => {
                let path = model.drive.path(drive_time_star);
                let [gx, gy] = part(direction, blocks);
                for k in 0..n {
                    let (x, y) = (path * gx[k] - ux[k], path * gy[k] - uy[k]);
                    squares[k] = x * x + y * y;
                }
            }
        }
        add_weighted(sum, squares, relative(model, blocks), &mut scratch.products);
    }

    /// Adds the two components of a vector over some blocks, weighted with the relative stiffness of the
    /// springs; for a rotation the components along the direction at each block and to its left.
    #[inline(always)]
    pub(super) fn add(
        &self,
        model: &Model,
        blocks: &Range<usize>,
        [x, y]: [&[f64]; 2],
        [along, across]: [&mut RunningSum; 2],
        scratch: &mut WeightedScratch,
    ) {
        let (n, relative) = (blocks.len(), relative(model, blocks));
        match &self.direction {
            None => {
                add_weighted(along, x, relative, &mut scratch.products);
                add_weighted(across, y, relative, &mut scratch.products);
            }
            Some(direction) => {
                let ([gx, gy], terms) = (part(direction, blocks), &mut scratch.terms[..n]);
                dot_products([gx, gy], [x, y], terms);
                add_weighted(along, terms, relative, &mut scratch.products);
                let (x, y) = (&x[..n], &y[..n]);
                for k in 0..n {
                    terms[k] = gx[k] * y[k] - gy[k] * x[k];
                }
                add_weighted(across, terms, relative, &mut scratch.products);
            }
        }
    }
}

/// Adds the dead load of some blocks.
#[inline(always)]
fn add_dead_load(model: &Model, blocks: &Range<usize>, [fx, fy]: [&mut [f64]; 2]) {
    let DeadLoad { force: [x, y], field } = &model.dead_load;
    let n = blocks.len();
    let (fx, fy) = (&mut fx[..n], &mut fy[..n]);
    if let Some(field) = field {
        let relative = values_of(&field.relative, blocks);
        for k in 0..n {
            fx[k] += relative[k] * x;
            fy[k] += relative[k] * y;
        }
    } else {
        for (k, _) in blocks
            .clone()
            .enumerate()
            .filter(|&(_, b)| model.slider.exists(b))
        {
            fx[k] += x;
            fy[k] += y;
        }
    }
}

#[inline(always)]
fn relative<'a>(model: &'a Model, blocks: &Range<usize>) -> Option<&'a [f64]> {
    let springs = model.slider.drive_springs.as_ref()?;
    Some(values_of(&springs.relative, blocks))
}
