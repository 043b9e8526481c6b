//! Vectors of the sliding plane.

/// A vector with its x and y components.
pub(crate) type Vector = [f64; 2];

/// Sum `a + b`.
pub(crate) fn sum(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1]]
}

/// Difference `a - b`.
pub(crate) fn difference(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1]]
}

/// Product `s a`.
pub(crate) fn times(s: f64, a: Vector) -> Vector {
    [s * a[0], s * a[1]]
}

/// Scalar product `a . b`.
pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Length `|a|`.
pub(crate) fn length(a: Vector) -> f64 {
    a[0].hypot(a[1])
}

/// Unit vector along `a`; zero where `a` is.
pub(crate) fn unit(a: Vector) -> Vector {
    let length = length(a);
    if length > 0.0 {
        [a[0] / length, a[1] / length]
    } else {
        [0.0, 0.0]
    }
}

/// Vector product `z x a`: the vector a quarter turn to the left.
pub(crate) fn left_of(a: Vector) -> Vector {
    [-a[1], a[0]]
}
