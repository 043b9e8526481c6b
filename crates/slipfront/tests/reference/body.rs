//! A bulk body: the force on each block from the displacement of every other one, by a sum over all waves.

use std::f64::consts::{PI, TAU};

use slipfront::{Body, Face, Model};

use super::vector::{Vector, sum, times};

/// Traction over displacement along a wave and across it, of a body of Young's modulus 1.
fn stiffness(body: &Body, q: f64) -> [f64; 2] {
    let (nu, x) = (body.poisson, q * body.height);
    let (shear, kappa) = (1.0 / (2.0 + 2.0 * nu), 3.0 - 4.0 * nu);
    let (c, s) = (x.cosh(), x.sinh());
    let along = match body.face {
        Face::Pressure => {
            (2.0 * kappa * (2.0 * x).cosh() + 1.0 + kappa.powi(2) + (2.0 * x).powi(2))
                / ((2.0 * kappa * (2.0 * x).sinh() + 4.0 * x) * (1.0 - nu))
        }
        Face::Flat => (1.0 + kappa) * (kappa * s * c - x) / ((kappa * s).powi(2) - x * x),
    };
    [shear * q * along, shear * q * c / s]
}

/// Matrices `M(r)` of the force `-sum_c M(b - c) u_c` on block b, one for each distance r between two blocks
/// of the lattice; none for a sheet.
pub(super) fn matrices(model: &Model) -> Option<Vec<[Vector; 2]>> {
    let body = model.body()?;
    let (nx, ny) = (model.lattice.nx, model.lattice.ny);
    let wave_number = |k: usize, n: usize| {
        let q = TAU * k as f64 / n as f64;
        if q > PI + 1e-9 { q - TAU } else { q }
    };
    let is_shortest = |k: usize, n: usize| 2 * k == n;
    let mut matrices = vec![[[0.0; 2]; 2]; nx * ny];
    for k in 1..nx * ny {
        let (kx, ky) = (k % nx, k / nx);
        let (qx, qy) = (wave_number(kx, nx), wave_number(ky, ny));
        let q = qx.hypot(qy);
        let ([along, across], [c, s]) = (stiffness(body, q), [qx / q, qy / q]);
        let cross = if is_shortest(kx, nx) || is_shortest(ky, ny) {
            0.0
        } else {
            (along - across) * c * s
        };
        let xx = along * c * c + across * s * s;
        let yy = along * s * s + across * c * c;
        for (r, matrix) in matrices.iter_mut().enumerate() {
            let phase = (qx * (r % nx) as f64 + qy * (r / nx) as f64).cos() / (nx * ny) as f64;
            for (row, entries) in matrix.iter_mut().zip([[xx, cross], [cross, yy]]) {
                *row = sum(*row, times(phase, entries));
            }
        }
    }
    Some(matrices)
}

/// Force on block `b` of a lattice of `nx` by `ny` blocks with these displacements.
pub(super) fn force(
    matrices: &[[Vector; 2]],
    [nx, ny]: [usize; 2],
    b: usize,
    displacement: &[Vector],
) -> Vector {
    let mut force = [0.0; 2];
    for (c, u) in displacement.iter().enumerate() {
        let column = (nx + b % nx - c % nx) % nx;
        let row = (ny + b / nx - c / nx) % ny;
        let [x, y] = matrices[row * nx + column];
        force = sum(
            force,
            [-(x[0] * u[0] + x[1] * u[1]), -(y[0] * u[0] + y[1] * u[1])],
        );
    }
    force
}
