//! The drive springs (Eq. 2): forces, energy, and the sums over blocks that belong to them.

use crate::drive::Drive;
use crate::fixed_point;
use crate::model::Model;
use crate::vector_field::VectorField;

/// What drives each block.
#[derive(Debug)]
pub(super) enum DrivenBlocks {
    /// Equal springs on all blocks.
    Equally,
    /// Springs of these relative stiffnesses.
    BySprings(Vec<f64>),
    /// Springs of these relative stiffnesses whose ends rotate.
    Rotating {
        relative: Vec<f64>,
        /// `g`, see [`Drive::direction_at`].
        direction: VectorField,
    },
}

impl DrivenBlocks {
    pub(super) fn of(model: &Model) -> Self {
        let (slider, lattice) = (&model.slider, &model.lattice);
        let relative = || (0..lattice.n_blocks()).map(|b| slider.drive_spring(b)).collect();
        if model.drive.rotation.is_some() {
            let directions = (0..lattice.n_blocks()).map(|b| model.drive.direction_at(lattice, b).into());
            let (x, y): (Vec<f64>, Vec<f64>) = directions.unzip();
            return Self::Rotating {
                relative: relative(),
                direction: VectorField { x, y },
            };
        }
        match slider.drive_springs.is_some() || slider.outline.is_some() {
            true => Self::BySprings(relative()),
            false => Self::Equally,
        }
    }

    /// Eq. 2: `F_s = k_s (V t - u)`.
    #[inline(always)]
    pub(super) fn forces(&self, drive: &Drive, u: &VectorField, time_star: f64, force: &mut VectorField) {
        let (k_drive, constant) = (drive.k_drive, drive.constant_force);
        let position = drive.position(time_star);
        let equally = |force: &mut [f64], u: &[f64], axis: usize| {
            for (f, u) in force.iter_mut().zip(u) {
                *f = k_drive * (position[axis] - u) + constant[axis];
            }
        };
        match self {
            Self::Equally => {
                equally(&mut force.x, &u.x, 0);
                equally(&mut force.y, &u.y, 1);
            }
            Self::BySprings(relative) => {
                equally(&mut force.x, &u.x, 0);
                equally(&mut force.y, &u.y, 1);
                multiply(&mut force.x, relative);
                multiply(&mut force.y, relative);
            }
            Self::Rotating { relative, direction } => {
                let path = drive.path(time_star);
                let n = relative.len();
                let (gx, gy) = (&direction.x[..n], &direction.y[..n]);
                let (ux, uy) = (&u.x[..n], &u.y[..n]);
                let [along, across] = constant;
                for (b, f) in force.x[..n].iter_mut().enumerate() {
                    *f = k_drive * (path * gx[b] - ux[b]) + (along * gx[b] - across * gy[b]);
                }
                for (b, f) in force.y[..n].iter_mut().enumerate() {
                    *f = k_drive * (path * gy[b] - uy[b]) + (along * gy[b] + across * gx[b]);
                }
                multiply(&mut force.x, relative);
                multiply(&mut force.y, relative);
            }
        }
    }

    /// Energy of the springs, `(k_s/2) (V t - u)^2` of each, at displacements `u`.
    #[inline(always)]
    pub(super) fn energy(&self, drive: &Drive, [ux, uy]: [&[f64]; 2], time_star: f64) -> f64 {
        let n = ux.len();
        let [x, y] = drive.position(time_star);
        let stretch = |b: usize| (x - ux[b]) * (x - ux[b]) + (y - uy[b]) * (y - uy[b]);
        let sum = match self {
            Self::Equally => fixed_point::sum(n, stretch),
            Self::BySprings(relative) => fixed_point::sum(n, |b| relative[b] * stretch(b)),
            Self::Rotating { relative, direction } => {
                let path = drive.path(time_star);
                let (gx, gy) = (&direction.x[..n], &direction.y[..n]);
                fixed_point::sum(n, |b| {
                    let (x, y) = (path * gx[b] - ux[b], path * gy[b] - uy[b]);
                    relative[b] * (x * x + y * y)
                })
            }
        };
        0.5 * drive.k_drive * sum
    }

    /// Sums over `n` blocks of a vector of components `x` and `y`, weighted with the relative stiffness of the springs: both
    /// components, of a rotation those along the direction at each block and to its left.
    #[inline(always)]
    pub(super) fn sums(&self, n: usize, x: impl Fn(usize) -> f64, y: impl Fn(usize) -> f64) -> [f64; 2] {
        match self {
            Self::Equally => [fixed_point::sum(n, x), fixed_point::sum(n, y)],
            Self::BySprings(relative) => [
                fixed_point::sum(n, |b| relative[b] * x(b)),
                fixed_point::sum(n, |b| relative[b] * y(b)),
            ],
            Self::Rotating { relative, direction } => {
                let (gx, gy) = (&direction.x[..n], &direction.y[..n]);
                [
                    fixed_point::sum(n, |b| relative[b] * (gx[b] * x(b) + gy[b] * y(b))),
                    fixed_point::sum(n, |b| relative[b] * (gx[b] * y(b) - gy[b] * x(b))),
                ]
            }
        }
    }
}

#[inline(always)]
fn multiply(values: &mut [f64], factors: &[f64]) {
    for (value, factor) in values.iter_mut().zip(factors) {
        *value *= factor;
    }
}
