//! The distance between two closed outlines, and the width of an outline. Lengths are in blocks.

use std::f64::consts::TAU;

use super::contour::Ellipse;
use super::outline::range;
use crate::vector_field::{add, cross, dot, subtract};

/// Largest length that counts as zero, because of rounding of coordinates: outlines that are this near touch.
const TOUCHING: f64 = 1e-6;
/// Number of directions that are tried for the first guess of the direction of largest separation of two
/// ellipses.
const DIRECTIONS: usize = 256;
/// Number of times that the interval around this guess is reduced by a third: to 1e-9 of its length, below
/// which the distance no longer changes.
const CUTS: usize = 52;
/// Number of corners of the polygon that replaces an ellipse in comparison with a polygon: the error of the
/// radius is at most five millionths.
const CORNERS: usize = 1024;

/// A closed outline.
#[derive(Debug)]
pub(super) enum Form {
    Ellipse(Ellipse),
    /// A polygon; the even-odd rule defines its inside.
    Polygon(Vec<[f64; 2]>),
}

/// The place where two outlines are nearest to each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closest {
    pub(super) distance: f64,
    /// The two nearest points.
    pub(super) ends: [[f64; 2]; 2],
}

impl Closest {
    /// Points between the two outlines.
    pub(super) fn between(&self) -> [[f64; 2]; 5] {
        [0.1, 0.3, 0.5, 0.7, 0.9].map(|share| at_share(self.ends, share))
    }
}

/// Error: there is too much to examine.
#[derive(Debug)]
pub(super) struct TooMuch;

/// Number of points, edges and boxes that may still be examined.
pub(super) struct Effort(pub(super) usize);

impl Effort {
    pub(super) fn take(&mut self, steps: usize) -> Result<(), TooMuch> {
        self.0 = self.0.checked_sub(steps).ok_or(TooMuch)?;
        Ok(())
    }
}

impl Form {
    /// The smallest and the largest coordinate along an axis.
    pub(super) fn bounds(&self, axis: usize) -> [f64; 2] {
        match self {
            Self::Ellipse(ellipse) => {
                let mut direction = [0.0; 2];
                direction[axis] = 1.0;
                let half = reach(ellipse, direction);
                [ellipse.center[axis] - half, ellipse.center[axis] + half]
            }
            Self::Polygon(corners) => bounds(corners, axis),
        }
    }

    /// Whether a point lies inside.
    pub(super) fn contains(&self, point: [f64; 2], effort: &mut Effort) -> Result<bool, TooMuch> {
        match self {
            Self::Ellipse(ellipse) => {
                let [a, b] = ellipse.semi_axes;
                let [u, v] = along_axes(ellipse, subtract(point, ellipse.center));
                Ok((u / a).powi(2) + (v / b).powi(2) < 1.0)
            }
            Self::Polygon(corners) => is_inside(point, corners, effort),
        }
    }

    /// The place where another form, shifted by `shift`, is nearest; none if the forms touch or overlap.
    pub(super) fn closest(
        &self,
        other: &Self,
        shift: [f64; 2],
        effort: &mut Effort,
    ) -> Result<Option<Closest>, TooMuch> {
        let found = match (self, other) {
            (Self::Ellipse(one), Self::Ellipse(other)) => {
                effort.take(2 * DIRECTIONS)?;
                Some(between_ellipses(one, other, shift))
            }
            _ => {
                let other = other.corners().into_iter().map(|corner| add(corner, shift));
                between_polygons(&self.corners(), &other.collect::<Vec<_>>(), effort)?
            }
        };
        Ok(found.filter(|closest| closest.distance > TOUCHING))
    }

    fn corners(&self) -> Vec<[f64; 2]> {
        match self {
            Self::Ellipse(ellipse) => (0..CORNERS)
                .map(|k| ellipse.at(TAU * k as f64 / CORNERS as f64))
                .collect(),
            Self::Polygon(corners) => corners.clone(),
        }
    }
}

/// A vector along the axes of an ellipse.
fn along_axes(ellipse: &Ellipse, vector: [f64; 2]) -> [f64; 2] {
    [dot(ellipse.axis, vector), cross(ellipse.axis, vector)]
}

/// Distance by which an ellipse extends from its centre in a direction.
fn reach(ellipse: &Ellipse, direction: [f64; 2]) -> f64 {
    let [u, v] = along_axes(ellipse, direction);
    libm::hypot(ellipse.semi_axes[0] * u, ellipse.semi_axes[1] * v)
}

/// The point of an ellipse that is farthest in a direction.
fn farthest(ellipse: &Ellipse, direction: [f64; 2]) -> [f64; 2] {
    let [a, b] = ellipse.semi_axes;
    let [u, v] = along_axes(ellipse, direction);
    let reach = reach(ellipse, direction);
    let ([u, v], [c, s]) = ([a * a * u / reach, b * b * v / reach], ellipse.axis);
    add(ellipse.center, [u * c - v * s, u * s + v * c])
}

/// Distance of two ellipses: the largest distance between their projections onto any line, as for all convex
/// outlines. Negative if the ellipses overlap.
fn between_ellipses(one: &Ellipse, other: &Ellipse, shift: [f64; 2]) -> Closest {
    let from_one = subtract(add(other.center, shift), one.center);
    let direction = |angle: f64| [libm::cos(angle), libm::sin(angle)];
    let between = |direction| dot(direction, from_one) - reach(one, direction) - reach(other, direction);
    let is_circle = |ellipse: &Ellipse| ellipse.semi_axes[0] == ellipse.semi_axes[1];
    let best = if is_circle(one) && is_circle(other) {
        let length = libm::hypot(from_one[0], from_one[1]);
        if length > 0.0 {
            from_one.map(|part| part / length)
        } else {
            [1.0, 0.0]
        }
    } else {
        let step = TAU / DIRECTIONS as f64;
        let angles = (0..DIRECTIONS).map(|k| k as f64 * step);
        let value = |angle: &f64| between(direction(*angle));
        let guess = angles.max_by(|a, b| value(a).total_cmp(&value(b))).unwrap_or(0.0);
        let (mut low, mut high) = (guess - step, guess + step);
        for _ in 0..CUTS {
            let third = (high - low) / 3.0;
            if value(&(low + third)) < value(&(high - third)) {
                low += third;
            } else {
                high -= third;
            }
        }
        direction(0.5 * (low + high))
    };
    let back = best.map(|part| -part);
    Closest {
        distance: between(best),
        ends: [farthest(one, best), add(farthest(other, back), shift)],
    }
}

fn bounds(corners: &[[f64; 2]], axis: usize) -> [f64; 2] {
    range(corners.iter().map(|corner| corner[axis]))
}

/// Lower bound on the distance between two boxes.
pub(super) fn between_boxes(one: &[[f64; 2]; 2], other: &[[f64; 2]; 2]) -> f64 {
    let between = |axis: usize| {
        let ([low, high], [from, to]) = (one[axis], other[axis]);
        (from - high).max(low - to).max(0.0)
    };
    libm::hypot(between(0), between(1))
}

fn edges(corners: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(&from, &to)| [from, to])
}

fn is_inside(point: [f64; 2], corners: &[[f64; 2]], effort: &mut Effort) -> Result<bool, TooMuch> {
    effort.take(corners.len())?;
    let crossed = edges(corners).filter(|[p, q]| {
        (p[1] <= point[1]) != (q[1] <= point[1])
            && point[0] < p[0] + (point[1] - p[1]) / (q[1] - p[1]) * (q[0] - p[0])
    });
    Ok(crossed.count() % 2 == 1)
}

/// The point of the line of an edge that is nearest to a point, as a share of the edge; it may lie beyond the
/// ends of the edge.
fn share_of(point: [f64; 2], [from, to]: [[f64; 2]; 2]) -> f64 {
    let along = subtract(to, from);
    dot(subtract(point, from), along) / dot(along, along)
}

fn at_share([from, to]: [[f64; 2]; 2], share: f64) -> [f64; 2] {
    [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]))
}

fn square_between(one: [f64; 2], other: [f64; 2]) -> f64 {
    let between = subtract(other, one);
    dot(between, between)
}

/// Whether two edges cross.
fn do_cross([p, q]: [[f64; 2]; 2], [r, s]: [[f64; 2]; 2]) -> bool {
    let sides = |from, to, points: [[f64; 2]; 2]| {
        points.map(|point| cross(subtract(to, from), subtract(point, from)) > 0.0)
    };
    let ([a, b], [c, d]) = (sides(p, q, [r, s]), sides(r, s, [p, q]));
    a != b && c != d
}

/// The place where two polygons are nearest to each other; none if they overlap.
fn between_polygons(
    one: &[[f64; 2]],
    other: &[[f64; 2]],
    effort: &mut Effort,
) -> Result<Option<Closest>, TooMuch> {
    let boxes = [one, other].map(|corners| [0, 1].map(|axis| bounds(corners, axis)));
    if between_boxes(&boxes[0], &boxes[1]) == 0.0 {
        if is_inside(one[0], other, effort)? || is_inside(other[0], one, effort)? {
            return Ok(None);
        }
        for edge in edges(one) {
            let around = [0, 1].map(|axis| bounds(&edge, axis));
            if between_boxes(&around, &boxes[1]) > 0.0 {
                continue;
            }
            effort.take(other.len())?;
            if edges(other).any(|crossed| do_cross(edge, crossed)) {
                return Ok(None);
            }
        }
    }
    // A first bound, from some corners of each polygon, excludes most others.
    let stride = |corners: &[[f64; 2]]| corners.len().div_ceil(32);
    let mut least = f64::INFINITY;
    for &corner in one.iter().step_by(stride(one)) {
        for &facing in other.iter().step_by(stride(other)) {
            least = least.min(square_between(corner, facing));
        }
    }
    let mut ends = None;
    for (points, line, around) in [(one, other, boxes[1]), (other, one, boxes[0])] {
        for &point in points {
            let far = between_boxes(&point.map(|at| [at, at]), &around);
            if far * far > least {
                continue;
            }
            effort.take(line.len())?;
            for edge in edges(line) {
                let nearest = at_share(edge, share_of(point, edge).clamp(0.0, 1.0));
                let square = square_between(point, nearest);
                if square < least || square == least && ends.is_none() {
                    least = square;
                    ends = Some([point, nearest]);
                }
            }
        }
    }
    Ok(ends.map(|ends| Closest {
        distance: least.sqrt(),
        ends,
    }))
}

/// The corners of a polygon at which its direction changes.
fn without_straight(corners: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut corners = corners.to_vec();
    corners.dedup();
    if corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    let count = corners.len();
    let turns = |at: &usize| {
        let [before, after] = [(at + count - 1) % count, (at + 1) % count].map(|other| corners[other]);
        let (along, on) = (subtract(corners[*at], before), subtract(after, corners[*at]));
        cross(along, on).abs() > 1e-9 * dot(along, on).abs() || dot(along, on) < 0.0
    };
    (0..count).filter(turns).map(|at| corners[at]).collect()
}

/// The smallest distance of a corner of a polygon from an edge that it faces: across the inside, and across
/// the outside.
///
/// A corner faces an edge if its distance from the line of the edge is smaller, or larger, than the distances
/// of both adjacent corners. Otherwise it lies on a side that runs to a vertex, where the distance from the
/// other side falls to zero and is not a width.
pub(super) fn widths(corners: &[[f64; 2]], effort: &mut Effort) -> Result<[Option<f64>; 2], TooMuch> {
    let corners = without_straight(corners);
    let count = corners.len();
    effort.take(count * count)?;
    // Whether the inside is to the left of an edge.
    let is_left = |edge: [[f64; 2]; 2]| {
        let [x, y] = subtract(edge[1], edge[0]);
        let beside = add(at_share(edge, 0.5), [-1e-6 * y, 1e-6 * x]);
        is_inside(beside, &corners, effort)
    };
    let left: Vec<bool> = edges(&corners).map(is_left).collect::<Result<_, _>>()?;
    let beside = |at: usize| [(at + count - 1) % count, (at + 1) % count];
    let turns_left = |at: usize| {
        let [before, after] = beside(at).map(|other| corners[other]);
        cross(subtract(corners[at], before), subtract(after, corners[at])) > 0.0
    };
    let mut least = [f64::INFINITY; 2];
    for (at, &corner) in corners.iter().enumerate() {
        for (start, edge) in edges(&corners).enumerate() {
            let end = (start + 1) % count;
            let share = share_of(corner, edge);
            if start == at || end == at || !(0.0..=1.0).contains(&share) {
                continue;
            }
            let foot = at_share(edge, share);
            let square = square_between(corner, foot);
            let is_to_the_left = cross(subtract(edge[1], edge[0]), subtract(corner, edge[0])) > 0.0;
            let least = &mut least[usize::from(is_to_the_left != left[start])];
            if square >= *least || square <= TOUCHING * TOUCHING {
                continue;
            }
            // Distances by which the adjacent corners are farther from the edge, relative to the corner's
            // own.
            let across = subtract(corner, foot);
            let farther = beside(at).map(|other| dot(subtract(corners[other], corner), across) / square);
            let is_flat = farther.iter().any(|farther| farther.abs() < TOUCHING);
            if !is_flat && (farther[0] > 0.0) != (farther[1] > 0.0) {
                continue;
            }
            // A side of the polygon that joins the corner to the edge is a width if the polygon turns the
            // same way at both ends, and a step otherwise.
            let foot_at = match share {
                _ if share < TOUCHING => Some(start),
                _ if share > 1.0 - TOUCHING => Some(end),
                _ => None,
            };
            let is_step = |other| beside(at).contains(&other) && turns_left(other) != turns_left(at);
            if foot_at.is_some_and(is_step) {
                continue;
            }
            *least = square;
        }
    }
    Ok(least.map(|square| square.is_finite().then(|| square.sqrt())))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ellipse(center: [f64; 2], semi_axes: [f64; 2], degrees: f64) -> Form {
        let turn = degrees.to_radians();
        Form::Ellipse(Ellipse {
            center,
            semi_axes,
            axis: [turn.cos(), turn.sin()],
        })
    }

    fn rectangle([x, y]: [f64; 2], [width, height]: [f64; 2]) -> Form {
        Form::Polygon(vec![
            [x, y],
            [x + width, y],
            [x + width, y + height],
            [x, y + height],
        ])
    }

    fn distance(one: &Form, other: &Form, shift: [f64; 2]) -> Option<f64> {
        let found = one.closest(other, shift, &mut Effort(usize::MAX)).unwrap();
        found.map(|closest| closest.distance)
    }

    /// Distances of ellipses from support functions, compared with those of polygons of their corners, which
    /// are within 5e-6 of their size.
    #[test]
    fn ellipses_are_as_far_apart_as_their_corners() {
        for (degrees, shift) in [(0.0, [9.0, 3.0]), (35.0, [2.0, -8.0]), (80.0, [-7.0, 6.0])] {
            let (one, other) = (
                ellipse([1.0, 2.0], [4.0, 1.5], degrees),
                ellipse([0.5, 2.5], [2.0, 1.0], 20.0),
            );
            let exact = distance(&one, &other, shift).unwrap();
            let polygons = [&one, &other].map(|form| Form::Polygon(form.corners()));
            let measured = distance(&polygons[0], &polygons[1], shift).unwrap();
            assert!((exact - measured).abs() < 2e-5, "{exact} {measured}");
        }
        // Results for circles are exact.
        let circle = ellipse([0.0; 2], [1.5; 2], 0.0);
        assert_eq!(distance(&circle, &circle, [3.0, 4.0]), Some(2.0));
        assert_eq!(distance(&circle, &circle, [3.0, 0.0]), None);
        assert_eq!(distance(&circle, &circle, [1.0, 0.0]), None);
        assert_eq!(distance(&circle, &circle, [0.0; 2]), None);
    }

    #[test]
    fn polygons_that_cross_or_hold_each_other_have_no_distance() {
        let (across, along) = (
            rectangle([10.0, 0.0], [2.0, 50.0]),
            rectangle([0.0, 20.0], [50.0, 3.0]),
        );
        assert_eq!(distance(&across, &along, [0.0; 2]), None);
        assert_eq!(
            distance(&along, &rectangle([4.0, 21.0], [1.0; 2]), [0.0; 2]),
            None
        );
        let apart = across.closest(
            &rectangle([15.0, 60.0], [5.0; 2]),
            [1.0, -30.0],
            &mut Effort(1000),
        );
        let apart = apart.unwrap().unwrap();
        assert_eq!(apart.distance, 4.0);
        assert!(
            apart
                .between()
                .iter()
                .all(|[x, y]| (12.0..16.0).contains(x) && (30.0..=35.0).contains(y)),
            "{apart:?}"
        );
        // Tiles that share an edge.
        assert_eq!(distance(&across, &across, [2.0, 0.0]), None);
    }

    /// The corners and tips of an outline are not narrow features, at any resolution of the outline.
    #[test]
    fn polygons_are_as_wide_as_what_faces_each_other() {
        let widths = |corners: &[[f64; 2]]| {
            let found = widths(corners, &mut Effort(usize::MAX)).unwrap();
            found.map(|width| width.unwrap_or(f64::NAN))
        };
        let closed = |corners: &[[f64; 2]]| [corners, &corners[..1]].concat();
        let drawn_finely = |corners: &[[f64; 2]]| -> Vec<[f64; 2]> {
            let pieces = |edge| (0..20).map(move |k| at_share(edge, f64::from(k) / 20.0));
            edges(corners).flat_map(pieces).collect()
        };
        let rectangle = [[10.0, 10.0], [30.0, 10.0], [30.0, 16.0], [10.0, 16.0]];
        let triangle = [[0.0, 0.0], [12.0, 0.0], [0.0, 9.0]];
        let stairs = [
            [0.0, 0.0],
            [20.0, 0.0],
            [20.0, 3.0],
            [19.0, 3.0],
            [19.0, 4.0],
            [18.0, 4.0],
            [18.0, 5.0],
            [0.0, 5.0],
        ];
        let notched = [
            [0.0, 0.0],
            [20.0, 0.0],
            [20.0, 9.0],
            [12.0, 9.0],
            [12.0, 5.0],
            [9.0, 5.0],
            [9.0, 9.0],
            [0.0, 9.0],
        ];
        for (corners, width, gap) in [
            (&rectangle[..], 6.0, None),
            // From the right angle to the longest side: 12 times 9 over 15.
            (&triangle, 7.2, None),
            (&stairs, 3.0, None),
            (&notched, 5.0, Some(3.0)),
        ] {
            for corners in [corners.to_vec(), closed(corners), drawn_finely(corners)] {
                let [found, outside] = widths(&corners);
                // Corners between the ends of an edge have rounding errors.
                assert!((found - width).abs() < 1e-9, "{corners:?}: {found}");
                let gap = gap.unwrap_or(f64::NAN);
                assert!(
                    (outside - gap).abs() < 1e-9 || outside.is_nan() && gap.is_nan(),
                    "{corners:?}: {outside}"
                );
            }
        }
        // A lens between two arcs of radius 25 that meet in tips. Its width is 8 where it is thickest and,
        // within 1 in 500, nearby. And an ellipse, with ends much narrower than its middle.
        let arc = |k: u32, side: f64| {
            let half = (21.0_f64 / 25.0).acos();
            let angle = half * (f64::from(k) / 50.0 - 1.0);
            [25.0 * angle.sin() * side, (25.0 * angle.cos() - 21.0) * side]
        };
        let lens: Vec<[f64; 2]> = (0..100)
            .map(|k| arc(k, 1.0))
            .chain((0..100).map(|k| arc(k, -1.0)))
            .collect();
        let [found, outside] = widths(&lens);
        assert!(
            (found - 8.0).abs() < 0.016 && outside.is_nan(),
            "{found} {outside}"
        );
        let long = ellipse([0.0; 2], [30.0, 2.0], 20.0).corners();
        let [found, outside] = widths(&long);
        assert!(
            (found - 4.0).abs() < 0.008 && outside.is_nan(),
            "{found} {outside}"
        );
    }

    #[test]
    fn what_would_take_too_long_is_given_up() {
        let star: Vec<[f64; 2]> = (0..1000)
            .map(|k| {
                let (angle, radius) = (TAU * f64::from(k) / 1000.0, 5.0 + f64::from(k % 2));
                [radius * angle.cos(), radius * angle.sin()]
            })
            .collect();
        assert!(widths(&star, &mut Effort(900_000)).is_err());
        assert!(widths(&star, &mut Effort(10_000_000)).is_ok());
    }
}
