//! The force of a stretched spring (Eq. 3), for eight springs at a time: by the square root, or by a series
//! that is equally exact.

use fearless_simd::{Simd, SimdFloat, f64x8};

use super::vector::{Vec2x8, scale, splat, square};
use crate::lattice::Bond;

/// Formula for the force of a spring.
pub(crate) trait Geometry: Copy {
    /// Whether springs, masses or any other property differs from block to block.
    const BLOCKS_DIFFER: bool = false;

    /// Force of the spring along `bond` on a block, as [`Bond::force`]; `e` is the displacement of the
    /// neighbour less that of the block.
    fn force<S: Simd>(self, simd: S, bond: &Bond, e: Vec2x8<S>) -> Vec2x8<S>;
}

/// A formula for springs of a heterogeneous slider. It gives the forces of springs of factor 1.
#[derive(Clone, Copy)]
pub(crate) struct Differing<G>(pub(crate) G);

impl<G: Geometry> Geometry for Differing<G> {
    const BLOCKS_DIFFER: bool = true;

    #[inline(always)]
    fn force<S: Simd>(self, simd: S, bond: &Bond, e: Vec2x8<S>) -> Vec2x8<S> {
        self.0.force(simd, bond, e)
    }
}

/// The formula with the length of the spring, exact at any strain, with the same bits as [`Bond::force`].
#[derive(Clone, Copy)]
pub(crate) struct SquareRoot {
    /// Displacements over lengths, `epsilon = P mu_s/(E h)`.
    pub(crate) epsilon: f64,
}

impl Geometry for SquareRoot {
    #[inline(always)]
    fn force<S: Simd>(self, simd: S, bond: &Bond, e: Vec2x8<S>) -> Vec2x8<S> {
        let epsilon = splat(simd, self.epsilon);
        let r = [
            splat(simd, bond.rest[0]) + epsilon * e[0],
            splat(simd, bond.rest[1]) + epsilon * e[1],
        ];
        let length = square(r).sqrt();
        // The extension r - d is small compared with both lengths. Written as (r^2 - d^2)/(r + d), with the
        // squares multiplied out, it loses no digits.
        let along = splat(simd, bond.rest[0]) * e[0] + splat(simd, bond.rest[1]) * e[1];
        let stretch = splat(simd, 2.0) * along + epsilon * square(e);
        let tension =
            splat(simd, bond.stiffness) * stretch / (length * (length + splat(simd, bond.rest_length)));
        scale(tension, r)
    }
}

/// The formula with a series, without square root or division, exact to rounding at small strain.
///
/// With the stretch `s = (r^2 - d^2)/eps = 2 d.e + eps e^2` and `z = eps s/d^2`, so that `r = d sqrt(1 + z)`:
///
/// ```text
/// F = k (r - d)/(eps r) (d + eps e) = k (s/d^2) g(z) (d + eps e)
/// g(z) = (1 - (1 + z)^(-1/2))/z = 1/2 - 3/8 z + 5/16 z^2 - 35/128 z^3 + ...
/// ```
///
/// The coefficients of g decrease, so that the truncation error after the term in `z^DEGREE` is less than
/// `2 |z|^(DEGREE + 1)`, relative to g, for `|z| <= 1/4`: see [`Series::strain_limit`].
#[derive(Clone, Copy)]
pub(crate) struct Series<const DEGREE: usize> {
    /// Displacements over lengths, `epsilon = P mu_s/(E h)`.
    pub(crate) epsilon: f64,
}

/// Coefficients of the long series for straight and for diagonal springs, for a device that evaluates it
/// itself; the short series has the first four of them.
pub fn series_coefficients(epsilon: f64) -> [[f64; 8]; 2] {
    [Bond::EAST, Bond::NORTH_EAST].map(|bond| Series::<7> { epsilon }.coefficients(&bond))
}

/// Coefficients of g: `(-1)^m (2m + 2)!/((m + 1)!^2 4^(m + 1))`.
const G: [f64; 8] = [
    1.0 / 2.0,
    -3.0 / 8.0,
    5.0 / 16.0,
    -35.0 / 128.0,
    63.0 / 256.0,
    -231.0 / 1024.0,
    429.0 / 2048.0,
    -6435.0 / 32768.0,
];

impl<const DEGREE: usize> Series<DEGREE> {
    /// Largest `|z|` at which the series is exact to rounding: `2 |z|^(DEGREE + 1) <= 2^-54`, a quarter of a
    /// unit in the last place.
    pub(crate) fn strain_limit() -> f64 {
        libm::exp2(-55.0 / (DEGREE + 1) as f64)
    }

    /// Coefficients of `k/d^2 g` as a polynomial in the stretch s.
    #[inline(always)]
    fn coefficients(self, bond: &Bond) -> [f64; 8] {
        let per_square = 1.0 / (bond.rest[0] * bond.rest[0] + bond.rest[1] * bond.rest[1]);
        let mut coefficients = G;
        let mut factor = bond.stiffness * per_square;
        for c in &mut coefficients {
            *c *= factor;
            factor *= self.epsilon * per_square;
        }
        coefficients
    }
}

impl<const DEGREE: usize> Geometry for Series<DEGREE> {
    #[inline(always)]
    fn force<S: Simd>(self, simd: S, bond: &Bond, e: Vec2x8<S>) -> Vec2x8<S> {
        // d.e of a rest vector of ones and zeros.
        let along = match bond.offset {
            [1, 0] => e[0],
            [0, 1] => e[1],
            [1, 1] => e[0] + e[1],
            _ => e[1] - e[0],
        };
        let epsilon = splat(simd, self.epsilon);
        let s = (along + along) + epsilon * square(e);
        let coefficients = self.coefficients(bond);
        // Horner's rule: one multiplication and one addition for each degree, without root or division.
        let mut tension = splat(simd, coefficients[DEGREE]);
        for m in (0..DEGREE).rev() {
            tension = tension * s + splat(simd, coefficients[m]);
        }
        let tension = tension * s;
        let per_displacement = epsilon * tension;
        [
            along_axis(bond.offset[0], tension, per_displacement * e[0]),
            along_axis(bond.offset[1], tension, per_displacement * e[1]),
        ]
    }
}

/// The sum `tension d + correction` for a component d of the rest vector, which is 0, 1 or -1.
#[inline(always)]
fn along_axis<S: Simd>(rest: isize, tension: f64x8<S>, correction: f64x8<S>) -> f64x8<S> {
    match rest {
        0 => correction,
        1 => tension + correction,
        _ => correction - tension,
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch};

    use super::super::vector::LANES;
    use super::*;

    fn force(geometry: impl Geometry, bond: &Bond, e: [f64; 2]) -> [f64; 2] {
        dispatch!(Level::new(), simd => {
            let [x, y] = geometry.force(simd, bond, [splat(simd, e[0]), splat(simd, e[1])]);
            let (x, y): ([f64; LANES], [f64; LANES]) = (x.into(), y.into());
            assert!(x == [x[0]; LANES] && y == [y[0]; LANES]);
            [x[0], y[0]]
        })
    }

    /// Asserts that both formulas agree with [`Bond::force`]: each has a rounding error of some units of the
    /// last place.
    fn assert_same<const DEGREE: usize>(bond: &Bond, e: [f64; 2], epsilon: f64) {
        let exact = bond.force(e, epsilon);
        let by_root = force(SquareRoot { epsilon }, bond, e);
        let by_series = force(Series::<DEGREE> { epsilon }, bond, e);
        for axis in 0..2 {
            let unit = f64::EPSILON * exact[axis].abs();
            assert!((by_root[axis] - exact[axis]).abs() <= 4.0 * unit);
            assert!(
                (by_series[axis] - exact[axis]).abs() <= 4.0 * unit,
                "{} units: {:?} {e:?} at {epsilon}",
                (by_series[axis] - exact[axis]).abs() / unit,
                bond.offset
            );
        }
    }

    /// Asserts that the series is exact up to its largest strain, in all directions.
    fn series_is_exact<const DEGREE: usize>() {
        let limit = Series::<DEGREE>::strain_limit();
        assert!((2.0 * limit.powi(DEGREE as i32 + 1) * 2_f64.powi(54) - 1.0).abs() < 1e-12);
        for epsilon in [1e-12, 1e-6, 1e-3, 0.2] {
            for bond in &Bond::ALL {
                for sign in [-1.0, 1.0] {
                    // Along the spring, (1 + eps t)^2 = 1 + z.
                    let t = ((1.0 + sign * limit).sqrt() - 1.0) / epsilon;
                    assert_same::<DEGREE>(bond, bond.rest.map(|d| t * d), epsilon);
                }
                for k in 1..2000 {
                    // |z| <= 2 eps |e| + (eps e)^2.
                    let size = 0.499 * limit / epsilon * f64::from(k) / 2000.0;
                    let (y, x) = f64::from(k).sin_cos();
                    assert_same::<DEGREE>(bond, [size * x, size * y], epsilon);
                }
            }
        }
    }

    #[test]
    fn the_series_are_as_exact_as_the_square_root() {
        series_is_exact::<3>();
        series_is_exact::<7>();
    }

    /// The error bound of [`Series`] holds, and is at most ten times too large.
    #[test]
    fn the_truncation_error_is_bounded() {
        for degree in [3, 7] {
            for size in [0.25, 0.2, 0.1, 0.05] {
                for z in [-size, size] {
                    let sum = (0..=degree).rev().fold(0.0, |sum, m| sum * z + G[m]);
                    let root = f64::sqrt(1.0 + z);
                    let exact = 1.0 / (root * (root + 1.0));
                    let (error, bound) = ((sum / exact - 1.0).abs(), 2.0 * size.powi(degree as i32 + 1));
                    assert!(
                        (0.1 * bound..bound).contains(&error),
                        "{degree} {z}: {error:e} {bound:e}"
                    );
                }
            }
        }
    }
}
