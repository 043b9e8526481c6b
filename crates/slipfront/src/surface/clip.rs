//! Closed curves cut by the outline of a slider: both are divided where they meet, and the parts of each that
//! lie within the other are joined again. Lengths are in blocks.

use std::f64::consts::{PI, TAU};

use super::contour::{Contour, Ellipse, Piece};
use super::outline::range;
use super::texture::OUTLINE_VERTICES;
use crate::vector_field::{cross, subtract};

/// Lengths below this are rounding errors: coordinates of up to 10^7 blocks have rounding errors of 10^-9.
const NEAR: f64 = 1e-8;
/// Distance of points on either side of a line that show which side is inside, well beyond [`NEAR`].
const BESIDE: f64 = 1e-6;

type Point = [f64; 2];

/// The parts of a closed curve within a region with an edge of closed curves; the even-odd rule defines the
/// inside of both. A curve that is not cut is returned unchanged. Ellipses other than circles are cut as
/// polygons of 4096 corners, with edges that differ from the ellipse by less than `a (2 pi/4096)^2/8` for a
/// longer semi-axis `a`. The parts of a curve that crosses itself, or that surrounds a hole of the region,
/// belong together: the even-odd rule defines their inside, too.
///
/// ```
/// # use slipfront::surface::{Contour, clip};
/// let square = |from: f64, to: f64| Contour::rectangle([from, 0.0], [to, 1.0]);
/// assert_eq!(clip(&square(0.0, 2.0), &[square(0.0, 4.0)]), [square(0.0, 2.0)]);
/// assert!(clip(&square(4.0, 5.0), &[square(0.0, 4.0)]).is_empty());
/// let Contour::Polygon(corners) = &clip(&square(3.0, 5.0), &[square(0.0, 4.0)])[0] else { panic!() };
/// assert!(corners.len() == 4 && corners.contains(&[4.0, 1.0]));
/// ```
pub fn clip(contour: &Contour, region: &[Contour]) -> Vec<Contour> {
    let own = pieces(contour);
    let edges: Vec<Vec<Piece>> = region.iter().map(pieces).collect();
    let edge = edges.concat();
    let is_within = |chain: &Vec<Piece>| {
        let middle = &chain[chain.len() / 2];
        if !is_on(&edge, middle.at(0.5)) {
            return holds(&edge, middle.at(0.5));
        }
        // A line that belongs to both curves bounds a part if both have their inside on the same side of it.
        let mut sides = middle.sides().into_iter();
        sides.all(|side| holds(&own, side) == holds(&edge, side))
    };
    let is_across = |chain: &Vec<Piece>| {
        let middle = chain[chain.len() / 2].at(0.5);
        !is_on(&own, middle) && holds(&own, middle)
    };
    let bounds = [0, 1].map(|axis| range(own.iter().flat_map(|piece| piece.bounds()[axis])));
    let mut close = edge.clone();
    close.retain(|piece| is_close(bounds, piece.bounds()));
    let (mut kept, lost): (Vec<_>, Vec<_>) = chains(&own, &close).into_iter().partition(is_within);
    let mut across = Vec::new();
    // Most curves are far from all edges.
    if !close.is_empty() {
        across.extend(edges.iter().flat_map(|edge| chains(edge, &own)).filter(is_across));
    }
    let is_filled = |pieces: &Vec<Piece>| {
        let mut sides = pieces.iter().flat_map(Piece::sides);
        sides.any(|side| holds(pieces, side))
    };
    if lost.is_empty() && across.is_empty() {
        return Vec::from_iter(is_filled(&own).then(|| contour.clone()));
    }
    kept.extend(across);
    let parts = joined(kept).into_iter().filter(is_filled);
    parts.map(contour_of).collect()
}

/// The pieces of a curve: lines, and arcs of circles.
fn pieces(contour: &Contour) -> Vec<Piece> {
    let all = match contour {
        Contour::Ellipse(ellipse) if ellipse.semi_axes[0] != ellipse.semi_axes[1] => {
            let corner = |k: usize| ellipse.at(TAU * k as f64 / OUTLINE_VERTICES as f64);
            Contour::Polygon((0..OUTLINE_VERTICES).map(corner).collect()).pieces()
        }
        _ => contour.pieces(),
    };
    all.into_iter().filter(|piece| !piece.is_short()).collect()
}

fn contour_of(pieces: Vec<Piece>) -> Contour {
    if pieces.iter().any(|piece| matches!(piece, Piece::Arc(..))) {
        return Contour::Pieces(pieces);
    }
    Contour::Polygon(pieces.iter().map(|piece| piece.ends()[0]).collect())
}

/// The parts of a closed curve between the points where it meets others.
fn chains(curve: &[Piece], others: &[Piece]) -> Vec<Vec<Piece>> {
    let (mut chains, mut chain) = (Vec::new(), Vec::new());
    let long = |piece: Piece| (!piece.is_short()).then_some(piece);
    for piece in curve {
        let mut rest = *piece;
        for point in piece.meetings(others) {
            let [before, after] = rest.split(point);
            chain.extend(long(before));
            chains.push(std::mem::take(&mut chain));
            rest = after;
        }
        chain.extend(long(rest));
    }
    // The curve ends where it begins.
    if let Some(first) = chains.first_mut() {
        chain.append(first);
    }
    chains.push(chain);
    chains.retain(|chain| !chain.is_empty());
    chains
}

/// Whether two rectangles, given by their smallest and largest x and y, have points in common.
fn is_close(one: [[f64; 2]; 2], other: [[f64; 2]; 2]) -> bool {
    let pairs = one.into_iter().zip(other);
    pairs
        .into_iter()
        .all(|([low, high], [from, to])| low < to + NEAR && from < high + NEAR)
}

/// Closed curves, joined from chains that end where others begin or end.
fn joined(mut chains: Vec<Vec<Piece>>) -> Vec<Vec<Piece>> {
    let ends = |chain: &[Piece]| [chain[0].ends()[0], chain[chain.len() - 1].ends()[1]];
    let meet = |p: Point, q: Point| distance(p, q) < 4.0 * NEAR;
    let mut closed = Vec::new();
    while let Some(mut line) = chains.pop() {
        let [start, mut end] = ends(&line);
        while !meet(start, end) {
            let next = |chain: &Vec<Piece>| ends(chain).iter().any(|&other| meet(other, end));
            let Some(next) = chains.iter().position(next) else {
                line.push(Piece::Line([end, start]));
                break;
            };
            let chain = chains.swap_remove(next);
            if meet(ends(&chain)[0], end) {
                line.extend(chain);
            } else {
                line.extend(chain.iter().rev().map(Piece::reversed));
            }
            end = ends(&line)[1];
        }
        closed.push(line);
    }
    closed
}

fn is_on(curve: &[Piece], point: Point) -> bool {
    curve.iter().any(|piece| piece.is_near(point))
}

/// Whether a point is inside closed curves, by the even-odd rule: inside the polygons of the pieces' chords,
/// or between a chord and its arc. The arcs are counterclockwise, or the curves are cut.
fn holds(curves: &[Piece], point: Point) -> bool {
    let changes = |piece: &&Piece| {
        let [from, to] = piece.ends();
        // The ray to the right crosses a rising chord if the point is on the left of the chord, and a falling
        // one if the point is on its right.
        let is_right = cross(subtract(to, from), subtract(point, from)) <= 0.0;
        let crosses = match (from[1] <= point[1], to[1] <= point[1]) {
            (true, false) => !is_right,
            (false, true) => is_right,
            _ => false,
        };
        let Piece::Arc(circle, [first, last]) = piece else {
            return crosses;
        };
        let is_outer = is_right == (first < last);
        crosses != (is_outer && distance(point, circle.center) < circle.semi_axes[0])
    };
    curves.iter().filter(changes).count() % 2 == 1
}

fn along(p: Point, direction: Point, length: f64) -> Point {
    [p[0] + length * direction[0], p[1] + length * direction[1]]
}

fn distance(p: Point, q: Point) -> f64 {
    libm::hypot(p[0] - q[0], p[1] - q[1])
}

/// The direction from one point to another one.
fn direction(from: Point, to: Point) -> Point {
    let length = distance(from, to);
    subtract(to, from).map(|part| part / length)
}

/// The two points of a circle on a line with `foot` as its point nearest to the centre. For a tangent both
/// are the same, so that curves are divided there, too.
fn on_circle(circle: &Ellipse, foot: Point, direction: Point) -> Vec<Point> {
    let (radius, apart) = (circle.semi_axes[0], distance(circle.center, foot));
    if apart > radius + NEAR {
        return Vec::new();
    }
    let half = ((radius - apart) * (radius + apart)).max(0.0).sqrt();
    [-half, half]
        .map(|length| along(foot, direction, length))
        .to_vec()
}

/// Pieces of lines and circles.
impl Piece {
    /// The point at this share of the path from the first point to the last one.
    fn at(&self, share: f64) -> Point {
        match self {
            Self::Line([from, to]) => along(*from, subtract(*to, *from), share),
            Self::Arc(circle, [from, to]) => circle.at(from + share * (to - from)),
        }
    }

    /// Share of the path at which the piece, or its extension to a line or circle, is nearest to a point.
    fn share(&self, point: Point) -> f64 {
        match self {
            Self::Line([from, to]) => {
                let ([x, y], way) = (subtract(*to, *from), subtract(point, *from));
                (way[0] * x + way[1] * y) / (x * x + y * y)
            }
            Self::Arc(circle, [from, to]) => {
                let (way, [c, s]) = (subtract(point, circle.center), circle.axis);
                let parameter = libm::atan2(way[1] * c - way[0] * s, way[0] * c + way[1] * s);
                // Within half a turn of the middle of the arc.
                let after = (parameter - 0.5 * (from + to) + PI).rem_euclid(TAU) - PI;
                0.5 + after / (to - from)
            }
        }
    }

    fn is_near(&self, point: Point) -> bool {
        distance(self.at(self.share(point).clamp(0.0, 1.0)), point) < NEAR
    }

    fn is_short(&self) -> bool {
        let [from, to] = self.ends();
        distance(from, to) < NEAR
    }

    /// Points near the middle of the piece, one on each side.
    fn sides(&self) -> [Point; 2] {
        let [from, to] = self.ends();
        let [x, y] = direction(from, to);
        [-BESIDE, BESIDE].map(|length| along(self.at(0.5), [-y, x], length))
    }

    fn reversed(&self) -> Self {
        match *self {
            Self::Line([from, to]) => Self::Line([to, from]),
            Self::Arc(circle, [from, to]) => Self::Arc(circle, [to, from]),
        }
    }

    /// The pieces before and after a point.
    fn split(&self, point: Point) -> [Self; 2] {
        match *self {
            Self::Line([from, to]) => [Self::Line([from, point]), Self::Line([point, to])],
            Self::Arc(circle, [from, to]) => {
                let middle = from + self.share(point) * (to - from);
                [Self::Arc(circle, [from, middle]), Self::Arc(circle, [middle, to])]
            }
        }
    }

    /// Smallest and largest x and y of the piece, or of the whole circle for an arc.
    fn bounds(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|axis| match self {
            Self::Line(ends) => range(ends.map(|end| end[axis])),
            Self::Arc(circle, _) => {
                range([-1.0, 1.0].map(|sign| circle.center[axis] + sign * circle.semi_axes[0]))
            }
        })
    }

    /// Points where the piece meets others, in order along it.
    fn meetings(&self, others: &[Self]) -> Vec<Point> {
        let bounds = self.bounds();
        let close = others.iter().filter(|other| is_close(bounds, other.bounds()));
        let mut points: Vec<Point> = close.flat_map(|other| self.meets(other)).collect();
        points.sort_by(|p, q| self.share(*p).total_cmp(&self.share(*q)));
        points
    }

    /// Points that the piece and another one have in common: for overlapping lines the points where one
    /// begins or ends, for arcs of one circle none.
    fn meets(&self, other: &Self) -> Vec<Point> {
        let mut points = match (self, other) {
            (Self::Line(one), Self::Line(two)) => {
                let (way, other_way) = (subtract(one[1], one[0]), subtract(two[1], two[0]));
                let turn = cross(way, other_way);
                let longer = distance(one[0], one[1]).max(distance(two[0], two[1]));
                if turn.abs() < NEAR * longer {
                    [*one, *two].concat()
                } else {
                    let share = cross(subtract(two[0], one[0]), other_way) / turn;
                    vec![along(one[0], way, share)]
                }
            }
            (Self::Line([from, to]), Self::Arc(circle, _))
            | (Self::Arc(circle, _), Self::Line([from, to])) => {
                let line = Self::Line([*from, *to]);
                on_circle(circle, line.at(line.share(circle.center)), direction(*from, *to))
            }
            (Self::Arc(one, _), Self::Arc(two, _)) => {
                let apart = distance(one.center, two.center);
                let [x, y] = direction(one.center, two.center);
                // Intersection of the line through both common points with the line through both centres.
                let [a, b] = [one, two].map(|circle| circle.semi_axes[0]);
                let foot = 0.5 * (apart + (a - b) * (a + b) / apart);
                if apart < NEAR {
                    Vec::new()
                } else {
                    on_circle(one, along(one.center, [x, y], foot), [-y, x])
                }
            }
        };
        for line in [self, other] {
            points.iter_mut().for_each(|point| line.snap(point));
        }
        points.retain(|&point| self.is_near(point) && other.is_near(point));
        points
    }

    /// Removes rounding errors from a point on a line along an axis.
    fn snap(&self, point: &mut Point) {
        if let Self::Line([from, to]) = self {
            (0..2)
                .filter(|&axis| from[axis] == to[axis])
                .for_each(|axis| point[axis] = from[axis]);
        }
    }
}
