//! A plane vector at every block, stored as one array per component so that a row is contiguous.

/// A vector per block: `x[b]`, `y[b]` with block index `b = j nx + i`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VectorField {
    /// Components along x.
    pub x: Vec<f64>,
    /// Components along y.
    pub y: Vec<f64>,
}

impl VectorField {
    /// The zero field over `n_blocks` blocks.
    pub fn zeros(n_blocks: usize) -> Self {
        Self {
            x: vec![0.0; n_blocks],
            y: vec![0.0; n_blocks],
        }
    }

    /// The vector at block `b`.
    #[inline(always)]
    pub fn at(&self, b: usize) -> [f64; 2] {
        [self.x[b], self.y[b]]
    }
}

impl From<[Vec<f64>; 2]> for VectorField {
    fn from([x, y]: [Vec<f64>; 2]) -> Self {
        Self { x, y }
    }
}

/// Scalar product of two plane vectors.
#[inline(always)]
pub(crate) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Length of a plane vector. Not `hypot`: the square of a scaled force never over- or underflows, and the
/// plain formula has the same rounding on every machine and is symmetric in x and y.
#[inline(always)]
pub(crate) fn length(a: [f64; 2]) -> f64 {
    dot(a, a).sqrt()
}

/// Sum of two plane vectors.
#[inline(always)]
pub(crate) fn add(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

/// Difference of two plane vectors.
#[inline(always)]
pub(crate) fn subtract(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// Vector product of two plane vectors, positive where the second points to the left of the first.
#[inline(always)]
pub(crate) fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Cosine and sine of an angle in degrees; exact along the axes and symmetric about them, so that a drive
/// along y is the mirror image of a drive along x to the last bit.
pub(crate) fn unit_vector(degrees: f64) -> [f64; 2] {
    let turned = degrees.rem_euclid(360.0);
    let (quarter, rest) = ((turned / 90.0).floor(), turned.rem_euclid(90.0));
    let [c, s] = if rest == 45.0 {
        [std::f64::consts::FRAC_1_SQRT_2; 2]
    } else if rest < 45.0 {
        let angle = rest.to_radians();
        [libm::cos(angle), libm::sin(angle)]
    } else {
        let angle = (90.0 - rest).to_radians();
        [libm::sin(angle), libm::cos(angle)]
    };
    match quarter as u8 % 4 {
        0 => [c, s],
        1 => [-s, c],
        2 => [-c, -s],
        _ => [s, -c],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_exact_and_symmetric() {
        assert_eq!(unit_vector(90.0), [0.0, 1.0]);
        assert_eq!(unit_vector(-90.0), [0.0, -1.0]);
        assert_eq!(unit_vector(180.0), [-1.0, 0.0]);
        let [c, s] = unit_vector(45.0);
        assert!(c == s && (c * c + s * s - 1.0).abs() < 1e-15);
        let [a, b] = unit_vector(30.0);
        assert_eq!(unit_vector(60.0), [b, a]);
        assert_eq!(unit_vector(120.0), [-b, a]);
    }
}
