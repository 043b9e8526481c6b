//! B-splines.

use super::pen::{Pen, Point, difference, length};

/// Draws a B-spline of this degree.
pub(super) fn draw(pen: &mut Pen, degree: usize, knots: &[f64], points: &[Point]) -> Result<(), String> {
    if !(1..=8).contains(&degree)
        || points.len() <= degree
        || knots.len() != points.len() + degree + 1
        || !knots.is_sorted()
    {
        return Err(format!(
            "has a spline of degree {degree} with {} control points and {} knots, which is no B-spline of degree 1 to 8: convert \
             it to a polyline",
            points.len(),
            knots.len()
        ));
    }
    // Control points of the second derivative, but those between equal knots, on which nothing depends.
    let derivative = |points: &[Point], order: usize| -> Vec<Point> {
        let rate = |(i, pair): (usize, &[Point])| {
            let width = knots[i + degree + 1] - knots[i + order];
            let rate = if width > 0.0 {
                (degree + 1 - order) as f64 / width
            } else {
                0.0
            };
            difference(pair[1], pair[0]).map(|length| rate * length)
        };
        points.windows(2).enumerate().map(rate).collect()
    };
    let bends = if degree == 1 {
        Vec::new()
    } else {
        derivative(&derivative(points, 1), 2)
    };
    let bend = bends.into_iter().map(length).fold(0.0, f64::max);
    pen.to(at(degree, knots, points, degree, knots[degree]))?;
    for span in degree..points.len() {
        let (from, width) = (knots[span], knots[span + 1] - knots[span]);
        if width > 0.0 {
            let point = |share: f64| at(degree, knots, points, span, from + share * width);
            pen.curve(bend * width * width, point(1.0), point)?;
        }
    }
    Ok(())
}

/// The point of a parameter between the knots `span` and `span + 1`, by de Boor's algorithm.
fn at(degree: usize, knots: &[f64], points: &[Point], span: usize, parameter: f64) -> Point {
    let mut rest = points[span - degree..=span].to_vec();
    for order in 1..=degree {
        for j in (order..=degree).rev() {
            let i = span - degree + j;
            let width = knots[i + degree + 1 - order] - knots[i];
            let share = if width > 0.0 {
                (parameter - knots[i]) / width
            } else {
                0.0
            };
            rest[j] = [0, 1].map(|axis| rest[j - 1][axis] + share * (rest[j][axis] - rest[j - 1][axis]));
        }
    }
    rest[degree]
}
