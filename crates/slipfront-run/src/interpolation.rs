//! Values between the points of a curve.

/// Value at `x` of the curve through the points `(xs, ys)`, by linear interpolation; before the first point
/// and after the last one it has their values.
///
/// `xs` is non-decreasing and has at least one value, and as many as `ys`. The value at a point is exact,
/// without rounding.
#[must_use]
pub fn interpolate(xs: &[f64], ys: &[f64], x: f64) -> f64 {
    let after = xs.partition_point(|&other| other < x).min(xs.len() - 1);
    let before = after.saturating_sub(1);
    if xs[after] <= x || before == after {
        return ys[after];
    }
    let share = (x - xs[before]) / (xs[after] - xs[before]);
    ys[before] + share * (ys[after] - ys[before])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_goes_through_its_points_and_is_straight_between_them() {
        let (xs, ys) = ([0.0, 1.0, 1.0, 3.0], [0.1, 0.3, 0.7, 0.2]);
        let at = |x| interpolate(&xs, &ys, x);
        // At a jump, the curve has its first value.
        assert_eq!([at(0.0), at(1.0), at(3.0)], [0.1, 0.3, 0.2]);
        assert_eq!([at(-1.0), at(4.0)], [0.1, 0.2]);
        assert_eq!(at(0.5), 0.1 + 0.5 * (0.3 - 0.1));
        assert_eq!(at(1.5), 0.7 + 0.25 * (0.2 - 0.7));
        assert_eq!(interpolate(&[2.0], &[5.0], 1.0), 5.0);
    }
}
