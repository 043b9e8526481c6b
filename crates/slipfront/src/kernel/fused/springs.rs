//! The force of a stretched spring (Eq. 3), eight at a time: by the square root, or by a series that is as exact.

use fearless_simd::{Simd, SimdFloat};

use super::vector::{Eight, Plane, scale, splat, square};
use crate::lattice::Bond;

/// How the force of a spring is found.
pub(super) trait Geometry: Copy {
    /// Force of the spring along `bond` on a block, as [`Bond::force`]; `e`: displacement of the neighbour less that of
    /// the block.
    fn force<S: Simd>(self, simd: S, bond: &Bond, e: Plane<S>) -> Plane<S>;
}

/// By the length itself, exact at any strain.
#[derive(Clone, Copy)]
pub(super) struct SquareRoot {
    pub(super) epsilon: f64,
}

impl Geometry for SquareRoot {
    #[inline(always)]
    fn force<S: Simd>(self, simd: S, bond: &Bond, e: Plane<S>) -> Plane<S> {
        let epsilon = splat(simd, self.epsilon);
        let r = [
            splat(simd, bond.rest[0]) + epsilon * e[0],
            splat(simd, bond.rest[1]) + epsilon * e[1],
        ];
        let length = square(r).sqrt();
        let along = splat(simd, bond.rest[0]) * e[0] + splat(simd, bond.rest[1]) * e[1];
        let stretch = splat(simd, 2.0) * along + epsilon * square(e);
        let tension =
            splat(simd, bond.stiffness) * stretch / (length * (length + splat(simd, bond.rest_length)));
        scale(tension, r)
    }
}

/// By a series, exact to rounding at small strain, without a square root or a division.
///
/// With the stretch `s = (r^2 - d^2)/eps = 2 d.e + eps e^2` and `z = eps s/d^2`, so that `r = d sqrt(1 + z)`:
///
/// ```text
/// F = k (r - d)/(eps r) (d + eps e) = k (s/d^2) g(z) (d + eps e)
/// g(z) = (1 - (1 + z)^(-1/2))/z = 1/2 - 3/8 z + 5/16 z^2 - 35/128 z^3 + ...
/// ```
///
/// The coefficients of g fall in size, so that what is left out after the term in `z^DEGREE` is less than
/// `2 |z|^(DEGREE + 1)` of the whole for `|z| <= 1/4`: see [`Series::reach`].
#[derive(Clone, Copy)]
pub(super) struct Series<const DEGREE: usize> {
    pub(super) epsilon: f64,
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
    /// Largest `|z|` at which the series is exact to rounding: `2 |z|^(DEGREE + 1) <= 2^-54`, a quarter of a unit in the
    /// last place.
    pub(super) fn reach() -> f64 {
        libm::exp2(-55.0 / (DEGREE + 1) as f64)
    }

    /// `k/d^2 g` as a polynomial in the stretch s.
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
    fn force<S: Simd>(self, simd: S, bond: &Bond, e: Plane<S>) -> Plane<S> {
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
        let mut tension = splat(simd, coefficients[DEGREE]);
        for m in (0..DEGREE).rev() {
            tension = tension * s + splat(simd, coefficients[m]);
        }
        let tension = tension * s;
        let bend = epsilon * tension;
        [
            along_axis(bond.offset[0], tension, bend * e[0]),
            along_axis(bond.offset[1], tension, bend * e[1]),
        ]
    }
}

/// `tension d + bend` without a multiplication by the one or zero of d.
#[inline(always)]
fn along_axis<S: Simd>(rest: isize, tension: Eight<S>, bend: Eight<S>) -> Eight<S> {
    match rest {
        0 => bend,
        1 => tension + bend,
        _ => bend - tension,
    }
}
