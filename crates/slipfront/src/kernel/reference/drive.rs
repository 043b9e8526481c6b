//! The drive springs (Eq. 2): forces, energy, and the sums over blocks that belong to them.

use super::weighted::weighted_sum;
use crate::communicator::Communicator;
use crate::model::Model;
use crate::vector_field::VectorField;

/// What drives each block beyond the drive springs of its model.
#[derive(Debug)]
pub(super) struct DrivenBlocks {
    /// Of a drive that rotates `g`, see [`Drive::direction_at`](crate::Drive::direction_at).
    direction: Option<VectorField>,
}

impl DrivenBlocks {
    pub(super) fn of(model: &Model) -> Self {
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

    /// Eq. 2: `F_s = k_s,i (V t - u)`.
    #[inline(always)]
    pub(super) fn forces(&self, model: &Model, u: &VectorField, time_star: f64, force: &mut VectorField) {
        let (k_drive, [along, across]) = (model.drive.k_drive, model.drive.constant_force);
        match &self.direction {
            None => {
                let position = model.drive.position(time_star);
                let component = |force: &mut [f64], u: &[f64], position: f64, constant: f64| {
                    for (f, u) in force.iter_mut().zip(u) {
                        *f = k_drive * (position - u) + constant;
                    }
                };
                component(&mut force.x, &u.x, position[0], along);
                component(&mut force.y, &u.y, position[1], across);
            }
            Some(direction) => {
                let path = model.drive.path(time_star);
                let n = u.x.len();
                let (gx, gy) = (&direction.x[..n], &direction.y[..n]);
                let (ux, uy) = (&u.x[..n], &u.y[..n]);
                for (b, f) in force.x[..n].iter_mut().enumerate() {
                    *f = k_drive * (path * gx[b] - ux[b]) + (along * gx[b] - across * gy[b]);
                }
                for (b, f) in force.y[..n].iter_mut().enumerate() {
                    *f = k_drive * (path * gy[b] - uy[b]) + (along * gy[b] + across * gx[b]);
                }
            }
        }
        if let Some(relative) = relative(model) {
            for force in [&mut force.x, &mut force.y] {
                force
                    .iter_mut()
                    .zip(relative)
                    .for_each(|(f, relative)| *f *= relative);
            }
        }
    }

    /// Energy of the springs, `(k_s,i/2) (V t - u)^2` of each, at displacements `u`.
    #[inline(always)]
    pub(super) fn energy(
        &self,
        ranks: &dyn Communicator,
        model: &Model,
        [ux, uy]: [&[f64]; 2],
        time_star: f64,
    ) -> f64 {
        let n = ux.len();
        let square = |x: f64, y: f64| x * x + y * y;
        let sum = match &self.direction {
            None => {
                let [x, y] = model.drive.position(time_star);
                weighted_sum(ranks, n, relative(model), |b| square(x - ux[b], y - uy[b]))
            }
            Some(direction) => {
                let path = model.drive.path(time_star);
                let (gx, gy) = (&direction.x[..n], &direction.y[..n]);
                weighted_sum(ranks, n, relative(model), |b| {
                    square(path * gx[b] - ux[b], path * gy[b] - uy[b])
                })
            }
        };
        0.5 * model.drive.k_drive * sum
    }

    /// Sums over the blocks of all ranks, `n` of this one, of a vector of components `x` and `y`, weighted with the relative stiffness of the springs: both
    /// components, of a rotation those along the direction at each block and to its left.
    #[inline(always)]
    pub(super) fn sums(
        &self,
        ranks: &dyn Communicator,
        model: &Model,
        n: usize,
        x: impl Fn(usize) -> f64,
        y: impl Fn(usize) -> f64,
    ) -> [f64; 2] {
        let relative = relative(model);
        match &self.direction {
            None => [
                weighted_sum(ranks, n, relative, x),
                weighted_sum(ranks, n, relative, y),
            ],
            Some(direction) => {
                let (gx, gy) = (&direction.x[..n], &direction.y[..n]);
                [
                    weighted_sum(ranks, n, relative, |b| gx[b] * x(b) + gy[b] * y(b)),
                    weighted_sum(ranks, n, relative, |b| gx[b] * y(b) - gy[b] * x(b)),
                ]
            }
        }
    }
}

fn relative(model: &Model) -> Option<&[f64]> {
    model
        .slider
        .drive_springs
        .as_ref()
        .map(|springs| &*springs.relative)
}
