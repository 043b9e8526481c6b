//! A bulk body: one layer of blocks under the exact elastic response of what lies above it.
//!
//! The blocks are the face of a periodic cell of an isotropic body, deep or bonded to a rigid base at the
//! height H. A displacement of its face of wave number q takes the traction `K(q) u(q)`, along the wave and
//! across it (with `x = q H` and `kappa = 3 - 4 nu`):
//!
//! ```text
//! A = G q/(1 - nu) (2 kappa cosh 2x + 1 + kappa^2 + 4 x^2)/(2 kappa sinh 2x + 4 x)     pressure prescribed
//! A = G q (1 + kappa) (kappa sinh 2x - 2x)/(kappa^2 (cosh 2x - 1) - 2 x^2)              face held flat
//! B = G q coth x
//! K_xx = A c^2 + B s^2     K_yy = A s^2 + B c^2     K_xy = (A - B) c s     (c, s) = q/|q|
//! ```
//!
//! The wave number zero belongs to the drive springs, which all blocks share: they pull by the mean
//! displacement.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};
use slipfront_kernel::SurfaceResponse;

/// Support of the face of a body by its foundation, apart from friction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Face {
    /// The pressure is given at every place, as on a compliant foundation: the face bends freely.
    #[default]
    Pressure,
    /// The face stays flat, as on a rigid foundation that it touches everywhere.
    Flat,
}

impl Face {
    /// Whether pressure is prescribed.
    pub fn is_pressure(&self) -> bool {
        *self == Self::Pressure
    }
}

/// An isotropic body over the face, in units of the block size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Height H from the face to the rigid base; infinite for a deep body.
    pub height: f64,
    /// Poisson's ratio, from 0 to 1/2.
    pub poisson: f64,
    /// Support of the face.
    pub face: Face,
}

/// Largest `q H`: beyond it a layer answers as a deep body to all digits, and its hyperbolic functions stay
/// finite.
const DEEP: f64 = 200.0;

impl Body {
    /// Shear modulus over Young's modulus, `G/E = 1/(2 (1 + nu))`.
    pub fn shear_modulus(&self) -> f64 {
        0.5 / (1.0 + self.poisson)
    }

    /// Traction over displacement along a wave and across it, for a wave number q > 0 per block, in units of
    /// E over the block size.
    ///
    /// ```
    /// use slipfront::{Body, Face};
    /// // A deep body of Poisson's ratio 0: G q along and across.
    /// let body = Body { height: f64::INFINITY, poisson: 0.0, face: Face::Pressure };
    /// assert!(body.stiffness(2.0).iter().all(|stiffness| (stiffness - 1.0).abs() < 1e-15));
    /// // A face held flat is 4/3 as stiff along.
    /// let flat = Body { face: Face::Flat, ..body };
    /// assert!((flat.stiffness(2.0)[0] - 4.0 / 3.0).abs() < 1e-15);
    /// ```
    pub fn stiffness(&self, q: f64) -> [f64; 2] {
        let (x, kappa) = ((q * self.height).min(DEEP), 3.0 - 4.0 * self.poisson);
        let (cosh, sinh) = (libm::cosh(2.0 * x), libm::sinh(2.0 * x));
        let along = match self.face {
            Face::Pressure => {
                (2.0 * kappa * cosh + 1.0 + kappa * kappa + 4.0 * x * x)
                    / (2.0 * kappa * sinh + 4.0 * x)
                    / (1.0 - self.poisson)
            }
            Face::Flat => {
                (1.0 + kappa) * (kappa * sinh - 2.0 * x) / (kappa * kappa * (cosh - 1.0) - 2.0 * x * x)
            }
        };
        [along, 1.0 / libm::tanh(x)].map(|factor| self.shear_modulus() * q * factor)
    }

    /// Traction over displacement along a wave of wave number q per block, or of a displacement that is equal
    /// everywhere for q = 0.
    pub fn along(&self, q: f64) -> f64 {
        if q == 0.0 {
            return self.uniform_stiffness();
        }
        self.stiffness(q)[0]
    }

    /// Traction over a displacement that is equal everywhere, `G/H`; 0 for a deep body.
    pub fn uniform_stiffness(&self) -> f64 {
        self.shear_modulus() / self.height
    }

    /// The response of the body over `size` blocks along x and y, for at most `threads` threads. A cross term
    /// vanishes at the shortest wave along an axis, which has no direction.
    ///
    /// # Panics
    /// Unless [`next_side`](crate::next_side) returns both sides themselves.
    pub(crate) fn response(&self, size: [usize; 2], threads: usize) -> SurfaceResponse {
        SurfaceResponse::new(size, threads, |i, j| {
            let ([qx, odd_x], [qy, odd_y]) = (wave_number(i, size[0]), wave_number(j, size[1]));
            let q = (qx * qx + qy * qy).sqrt();
            if q == 0.0 {
                return [0.0; 3];
            }
            let ([along, across], [c, s]) = (self.stiffness(q), [qx / q, qy / q]);
            [
                0.5 * (along + across),
                0.5 * (along - across) * (c * c - s * s),
                (along - across) * (c * s) * odd_x * odd_y,
            ]
        })
    }

    /// Largest stiffness of a wave on the lattice of blocks, at its corner `q = sqrt(2) pi` or an edge: it
    /// bounds the time step, `dt < 2/sqrt(K)`.
    pub fn largest_stiffness(&self) -> f64 {
        // Both rise with q.
        let [along, across] = self.stiffness(std::f64::consts::SQRT_2 * std::f64::consts::PI);
        along.max(across).max(self.uniform_stiffness())
    }
}

/// Wave number of column or row `k` of a side of `n` blocks, per block, and 0 for the shortest wave, which is
/// its own opposite, else 1.
fn wave_number(k: usize, n: usize) -> [f64; 2] {
    let signed = if 2 * k > n { k as f64 - n as f64 } else { k as f64 };
    [TAU * signed / n as f64, f64::from(u8::from(2 * k != n))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::vectors::level;
    use crate::parallel;
    use crate::vector_field::{VectorField, dot};
    use slipfront_kernel::Threads;
    use std::f64::consts::PI;

    fn body(height: f64, poisson: f64, face: Face) -> Body {
        Body {
            height,
            poisson,
            face,
        }
    }

    /// A layer that is much higher than the wave is long answers as a half-space, and one that is much lower
    /// shears as a whole.
    #[test]
    fn layers_have_both_limits() {
        for face in [Face::Pressure, Face::Flat] {
            for poisson in [0.0, 0.2, 1.0 / 3.0, 0.45] {
                let [deep, high] =
                    [f64::INFINITY, 30.0].map(|height| body(height, poisson, face).stiffness(1.0));
                for (deep, high) in deep.into_iter().zip(high) {
                    // coth 30 differs from 1 by 2 exp(-60).
                    assert!((deep / high - 1.0).abs() < 1e-15, "{poisson} {deep} {high}");
                }
                let thin = body(1e-3, poisson, face);
                for stiffness in thin.stiffness(1.0) {
                    // The next term is of order (q H)^2, with a factor up to 1/(1 - 2 nu) = 10.
                    assert!(
                        (stiffness / thin.uniform_stiffness() - 1.0).abs() < 2e-5,
                        "{poisson} {stiffness}"
                    );
                }
            }
        }
    }

    /// 4 (1 - nu)^2/(3 - 4 nu) of a half-space: a third at nu = 0, 1/15 at 1/3, nothing at 1/2.
    #[test]
    fn a_flat_face_is_stiffer_along() {
        for (poisson, excess) in [(0.0, 1.0 / 3.0), (1.0 / 3.0, 1.0 / 15.0), (0.5, 0.0)] {
            let of = |face| body(f64::INFINITY, poisson, face).stiffness(0.7);
            let ([flat, flat_across], [free, free_across]) = (of(Face::Flat), of(Face::Pressure));
            assert!(
                (flat / free - 1.0 - excess).abs() < 1e-14,
                "{poisson} {flat} {free}"
            );
            assert_eq!(flat_across, free_across);
        }
    }

    /// Pressure does work only where the face bends, so that a flat face is never softer, for any layer.
    #[test]
    fn a_flat_face_is_never_softer() {
        for poisson in [0.0, 0.3, 0.5] {
            for height in [0.1, 0.5, 1.0, 2.0, 5.0] {
                let of = |face| body(height, poisson, face).stiffness(1.0)[0];
                assert!(
                    of(Face::Flat) >= of(Face::Pressure) * (1.0 - 1e-12),
                    "{poisson} {height}"
                );
            }
        }
    }

    fn on_threads() -> Threads {
        Threads {
            level: level(),
            join: |one, other| {
                parallel::join(one, other);
            },
        }
    }

    fn layer() -> Body {
        Body {
            height: 7.0,
            poisson: 0.3,
            face: Face::Pressure,
        }
    }

    /// The force on every block of a displacement that `at` gives by column and row, and its mean.
    fn forces(
        body: &Body,
        [nx, ny]: [usize; 2],
        threads: usize,
        at: impl Fn(f64, f64) -> [f64; 2],
    ) -> ([f64; 2], VectorField, VectorField) {
        let (x, y) = (0..nx * ny)
            .map(|b| at((b % nx) as f64, (b / nx) as f64).into())
            .unzip();
        let (displacement, mut force) = (VectorField { x, y }, VectorField::zeros(nx * ny));
        let on_threads = on_threads();
        let mut response = body.response([nx, ny], threads);
        let mean = response.forces(
            on_threads,
            [&displacement.x, &displacement.y],
            [&mut force.x, &mut force.y],
        );
        (mean, displacement, force)
    }

    /// A wave in any direction, on sides with every radix: the traction is that of its components along and
    /// across, to rounding.
    #[test]
    fn a_wave_in_any_direction_has_its_stiffness() {
        let body = layer();
        for size @ [nx, ny] in [[16, 16], [12, 20], [30, 9], [1, 8], [25, 2], [27, 40], [45, 6]] {
            for waves in [[1, 0], [0, 1], [1, 1], [2, 3], [-1, 2], [5, -1]] {
                let [qx, qy] = [waves[0] as f64 / nx as f64, waves[1] as f64 / ny as f64].map(|w| TAU * w);
                let is_shortest = [(waves[0], nx), (waves[1], ny)]
                    .iter()
                    .any(|&(wave, n): &(i32, usize)| 2 * wave.unsigned_abs() as usize >= n);
                let q = (qx * qx + qy * qy).sqrt();
                if is_shortest || q == 0.0 {
                    continue;
                }
                let (c, s) = (qx / q, qy / q);
                let [along, across] = body.stiffness(q);
                // A displacement at 0.4 rad to x.
                let (ux, uy) = (0.4_f64.cos(), 0.4_f64.sin());
                let (l, t) = (ux * c + uy * s, uy * c - ux * s);
                let expected = [along * l * c - across * t * s, along * l * s + across * t * c];
                let (mean, _, force) = forces(&body, size, 1, |x, y| {
                    let phase = (qx * x + qy * y + 0.3).cos();
                    [2.0 + ux * phase, uy * phase - 1.0]
                });
                assert!(
                    (mean[0] - 2.0).abs() < 1e-14 && (mean[1] + 1.0).abs() < 1e-14,
                    "{mean:?}"
                );
                for b in 0..nx * ny {
                    let phase = (qx * (b % nx) as f64 + qy * (b / nx) as f64 + 0.3).cos();
                    for (found, expected) in force.at(b).into_iter().zip(expected) {
                        // Ten stages of rounding of numbers of order 1, times a stiffness of order 1.
                        assert!(
                            (found + expected * phase).abs() < 1e-13,
                            "{size:?} {waves:?} {found}"
                        );
                    }
                }
            }
        }
    }

    /// A field without symmetry against the sum over all wave numbers, which uses no fast transform.
    #[test]
    fn any_field_agrees_with_the_sum_over_all_waves() {
        let (body, size @ [nx, ny]) = (layer(), [10, 12]);
        let (_, displacement, force) = forces(&body, size, 1, |x, y| {
            [(1.7 * x + y * y).sin(), (0.9 * y + x * x).cos()]
        });
        let place = |b: usize| [(b % nx) as f64, (b / nx) as f64];
        let mut expected = vec![[0.0; 2]; nx * ny];
        for k in 1..nx * ny {
            let ([qx, odd_x], [qy, odd_y]) = (wave_number(k % nx, nx), wave_number(k / nx, ny));
            let q = (qx * qx + qy * qy).sqrt();
            let ([along, across], [c, s]) = (body.stiffness(q), [qx / q, qy / q]);
            let cross = (along - across) * c * s * odd_x * odd_y;
            let stiffness = [
                [along * c * c + across * s * s, cross],
                [cross, along * s * s + across * c * c],
            ];
            let phase = |b: usize| qx * place(b)[0] + qy * place(b)[1];
            let mut sums = [[0.0; 2]; 2];
            for b in 0..nx * ny {
                for (sum, u) in sums.iter_mut().zip(displacement.at(b)) {
                    sum[0] += u * phase(b).cos();
                    sum[1] -= u * phase(b).sin();
                }
            }
            for (b, expected) in expected.iter_mut().enumerate() {
                for (expected, row) in expected.iter_mut().zip(stiffness) {
                    for ([re, im], stiffness) in sums.iter().zip(row) {
                        *expected -=
                            stiffness * (re * phase(b).cos() - im * phase(b).sin()) / (nx * ny) as f64;
                    }
                }
            }
        }
        for (b, expected) in expected.into_iter().enumerate() {
            for (found, expected) in force.at(b).into_iter().zip(expected) {
                // 120 terms with rounding of order 1e-16 each, in phases up to 60.
                assert!((found - expected).abs() < 1e-12, "{found} {expected}");
            }
        }
    }

    /// Parseval: the work of the forces is the same in both spaces, and never negative; forces have no mean.
    #[test]
    fn stored_energy_is_that_of_the_waves() {
        let (_, u, force) = forces(&layer(), [48, 50], 1, |x, y| [(x * y).sin(), (x - y * y).cos()]);
        let energy: f64 = (0..u.x.len()).map(|b| -0.5 * dot(u.at(b), force.at(b))).sum();
        let square: f64 = (0..u.x.len()).map(|b| dot(u.at(b), u.at(b))).sum();
        assert!(energy > 0.0 && energy < 0.5 * layer().largest_stiffness() * square);
        let sum: f64 = force.x.iter().sum();
        // 2400 terms of order 1, each with rounding of order 1e-15.
        assert!(sum.abs() < 1e-11, "{sum}");
    }

    #[test]
    fn bits_do_not_depend_on_threads() {
        let field = |threads| {
            forces(&layer(), [40, 27], threads, |x, y| {
                [(x * y).sin(), (x + 3.0 * y).cos()]
            })
            .2
        };
        let one = field(1);
        for threads in [2, 3, 5] {
            assert_eq!(field(threads), one, "{threads}");
        }
    }

    /// Slip in a long strip of `n` blocks across the drive runs away at the least eigenvalue of the stiffness
    /// of its blocks, the others held. Times `n (1 - nu)/G` it is 2.082, 2.199, 2.258, 2.287 for 4 to 32
    /// blocks, and 2.316 in the limit.
    #[test]
    fn strips_have_known_eigenvalues() {
        /// Blocks between strips, so many that each is alone.
        const APART: usize = 4096;
        let deep = body(f64::INFINITY, 0.3, Face::Pressure);
        let mut response = deep.response([APART, 1], 1);
        for (n, known) in [(4, 2.082), (8, 2.199), (16, 2.258), (32, 2.287)] {
            // The force that one block at the middle exerts gives the matrix of all.
            let unit = |b: usize| if b == 0 { 1.0 } else { 0.0 };
            let (ux, uy): (Vec<f64>, Vec<f64>) = (0..APART).map(|b| (unit(b), 0.0)).unzip();
            let (mut fx, mut fy) = (vec![0.0; APART], vec![0.0; APART]);
            response.forces(on_threads(), [&ux, &uy], [&mut fx, &mut fy]);
            let stiffness = |i: usize, j: usize| -fx[i.abs_diff(j)];
            // The inverse iteration needs a solution; the largest eigenvalue of (shift - K) needs none.
            let shift = deep.largest_stiffness();
            let mut mode: Vec<f64> = (0..n).map(|k| (PI * (k as f64 + 0.5) / n as f64).sin()).collect();
            let mut least = 0.0;
            for _ in 0..4000 {
                let next: Vec<f64> = (0..n)
                    .map(|i| shift * mode[i] - (0..n).map(|j| stiffness(i, j) * mode[j]).sum::<f64>())
                    .collect();
                let size = next.iter().map(|x| x * x).sum::<f64>().sqrt();
                least = shift - size;
                mode = next.iter().map(|x| x / size).collect();
            }
            let found = least * n as f64 * (1.0 - deep.poisson) / deep.shear_modulus();
            // Rounding of the known figures, and of the distance to the next strip: n/4096.
            assert!((found / known - 1.0).abs() < 2e-3, "{n}: {found}");
        }
    }
}
