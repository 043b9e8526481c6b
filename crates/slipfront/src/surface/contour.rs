//! Outlines of textures as closed curves within the slider, for files that other programs read. Free edges
//! cut them, and beyond periodic ones they go on at the opposite edge. Lengths are in blocks.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::outline::{Curve, Outlines};
use super::pattern::grids;
use super::texture::{Shape, Texture};
use crate::lattice::{Edges, Lattice};

/// A closed curve.
#[derive(Clone, Debug, PartialEq)]
pub enum Contour {
    /// A whole ellipse.
    Ellipse(Ellipse),
    /// The corners of a polygon, in order; its inside follows from the even-odd rule.
    Polygon(Vec<[f64; 2]>),
    /// The parts of an ellipse within the edges: each piece begins where the one before ends.
    Pieces(Vec<Piece>),
}

/// An ellipse, a circle if both semi-axes are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// Centre of the ellipse.
    pub center: [f64; 2],
    /// Semi-axes of the ellipse.
    pub semi_axes: [f64; 2],
    /// Direction of the first semi-axis, of length 1.
    pub axis: [f64; 2],
}

/// A piece of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece {
    /// A straight line between two points.
    Line([[f64; 2]; 2]),
    /// The ellipse from one parameter to a larger one, a quarter of a turn later at most: see
    /// [`Ellipse::at`].
    Arc(Ellipse, [f64; 2]),
}

impl Ellipse {
    /// The point of a parameter: `center + a cos(t) axis + b sin(t) axis'`, with the axis' a quarter turn to
    /// the left.
    ///
    /// ```
    /// # use slipfront::surface::Ellipse;
    /// let ellipse = Ellipse { center: [1.0, 0.0], semi_axes: [3.0, 2.0], axis: [0.0, 1.0] };
    /// assert_eq!(ellipse.at(0.0), [1.0, 3.0]);
    /// ```
    pub fn at(&self, parameter: f64) -> [f64; 2] {
        let along = self.semi_axes[0] * libm::cos(parameter);
        let aside = self.semi_axes[1] * libm::sin(parameter);
        let [c, s] = self.axis;
        [
            self.center[0] + along * c - aside * s,
            self.center[1] + along * s + aside * c,
        ]
    }

    /// The two parameters from 0 to a turn at which a coordinate has this value, if there are any.
    fn crossings(&self, axis: usize, value: f64) -> Option<[f64; 2]> {
        let [c, s] = self.axis;
        let [cosine, sine] = match axis {
            0 => [self.semi_axes[0] * c, -self.semi_axes[1] * s],
            _ => [self.semi_axes[0] * s, self.semi_axes[1] * c],
        };
        let reach = libm::hypot(cosine, sine);
        let share = (value - self.center[axis]) / reach;
        if share.abs() >= 1.0 {
            return None;
        }
        let (middle, half) = (libm::atan2(sine, cosine), libm::acos(share));
        Some([middle - half, middle + half].map(|parameter| parameter.rem_euclid(TAU)))
    }
}

impl Piece {
    /// First and last point of the piece.
    pub fn ends(&self) -> [[f64; 2]; 2] {
        match self {
            Self::Line(ends) => *ends,
            Self::Arc(ellipse, parameters) => parameters.map(|parameter| ellipse.at(parameter)),
        }
    }
}

/// The outlines of all copies of a texture's shape, whether it is inverted or not; none for a mask, whose
/// outlines are the edges of its blocks. A groove is a rectangle as long as the slider.
pub fn contours(lattice: &Lattice, texture: &Texture) -> Option<Vec<Contour>> {
    let grids = grids(&texture.arrays);
    let outlines = match &texture.shape {
        Shape::Cavity(cavity) => cavity.outlines(&grids),
        Shape::Polygon(points) => Outlines::polygon(points, &grids),
        Shape::Groove(groove) => {
            let strips = groove.shifts(&grids).into_iter();
            let rectangles = strips.flat_map(|shift| {
                let [low, high] = groove.rectangle(lattice, shift);
                let corners =
                    |low: [f64; 2], high: [f64; 2]| vec![low, [high[0], low[1]], high, [low[0], high[1]]];
                placed(lattice, [[low[0], high[0]], [low[1], high[1]]])
                    .into_iter()
                    .map(move |[x, y]| corners([low[0] + x, low[1] + y], [high[0] + x, high[1] + y]))
                    .collect::<Vec<_>>()
            });
            return Some(
                rectangles
                    .filter_map(|corners| within(lattice, Contour::Polygon(corners)))
                    .collect(),
            );
        }
        Shape::Tile(_) => return None,
    };
    let mut contours = Vec::new();
    for [columns, rows] in &outlines.centers {
        for &y in rows {
            for &x in columns {
                let bounds = [outlines.bounds(0, x), outlines.bounds(1, y)];
                for [shift_x, shift_y] in placed(lattice, bounds) {
                    let contour = match &outlines.curve {
                        Curve::Ellipse { semi_axes, axis } => Contour::Ellipse(Ellipse {
                            center: [x + shift_x, y + shift_y],
                            semi_axes: *semi_axes,
                            axis: *axis,
                        }),
                        Curve::Polygon(vertices) => Contour::Polygon(
                            vertices
                                .iter()
                                .map(|vertex| {
                                    let [x, y] = vertex.around([x, y]);
                                    [x + shift_x, y + shift_y]
                                })
                                .collect(),
                        ),
                    };
                    contours.extend(within(lattice, contour));
                }
            }
        }
    }
    Some(contours)
}

/// The shifts by whole sliders along periodic axes that bring a contour within these bounds onto the slider.
fn placed(lattice: &Lattice, bounds: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
    let along = |axis: usize| -> Vec<f64> {
        let size = [lattice.nx, lattice.ny][axis] as f64;
        let [low, high] = bounds[axis];
        if lattice.edges[axis] == Edges::Free {
            return vec![0.0];
        }
        let (first, last) = ((-high / size).ceil() as i64, ((size - low) / size).floor() as i64);
        (first..=last).map(|turn| turn as f64 * size).collect()
    };
    let (x, y) = (along(0), along(1));
    y.iter().flat_map(|&y| x.iter().map(move |&x| [x, y])).collect()
}

/// The part of a curve that lies on the slider, if any.
fn within(lattice: &Lattice, contour: Contour) -> Option<Contour> {
    let mut pieces = match contour {
        Contour::Ellipse(ellipse) => {
            let quarter =
                |k: i32| Piece::Arc(ellipse, [f64::from(k) * FRAC_PI_2, f64::from(k + 1) * FRAC_PI_2]);
            (0..4).map(quarter).collect()
        }
        Contour::Polygon(ref corners) => {
            let next = corners.iter().cycle().skip(1);
            corners
                .iter()
                .zip(next)
                .map(|(&from, &to)| Piece::Line([from, to]))
                .collect()
        }
        Contour::Pieces(ref pieces) => pieces.clone(),
    };
    let mut is_whole = true;
    for axis in [0, 1] {
        let size = [lattice.nx, lattice.ny][axis] as f64;
        for (limit, side) in [(0.0, 1.0), (size, -1.0)] {
            let half = HalfPlane { axis, limit, side };
            // An ellipse may lie beyond between the ends of its quarters.
            let is_inside = match &contour {
                Contour::Ellipse(ellipse) => {
                    ellipse.crossings(axis, limit).is_none() && half.holds(ellipse.center)
                }
                _ => pieces
                    .iter()
                    .all(|piece| piece.ends().iter().all(|end| half.holds(*end))),
            };
            if !is_inside {
                pieces = half.cut(&pieces);
                is_whole = false;
            }
        }
    }
    if is_whole {
        return Some(contour);
    }
    if pieces.is_empty() {
        return None;
    }
    let corners = |piece: &Piece| match piece {
        Piece::Line([from, _]) => Some(*from),
        Piece::Arc(..) => None,
    };
    let polygon: Option<Vec<[f64; 2]>> = pieces.iter().map(corners).collect();
    Some(polygon.map_or(Contour::Pieces(pieces), Contour::Polygon))
}

/// The points whose coordinate is not beyond a limit.
struct HalfPlane {
    axis: usize,
    limit: f64,
    /// Sign of the half-plane: 1 if its points lie above the limit, else -1.
    side: f64,
}

impl HalfPlane {
    fn holds(&self, point: [f64; 2]) -> bool {
        self.side * (point[self.axis] - self.limit) >= 0.0
    }

    /// The part of a closed curve in the half-plane, closed again by lines along the limit (Sutherland and
    /// Hodgman).
    fn cut(&self, pieces: &[Piece]) -> Vec<Piece> {
        let mut kept: Vec<Piece> = Vec::new();
        for piece in pieces {
            for part in self.parts(piece) {
                if let Some(last) = kept.last().map(|last| last.ends()[1]) {
                    let start = part.ends()[0];
                    if last != start {
                        kept.push(Piece::Line([last, start]));
                    }
                }
                kept.push(part);
            }
        }
        if let (Some(first), Some(last)) = (kept.first(), kept.last()) {
            let (start, end) = (first.ends()[0], last.ends()[1]);
            if start != end {
                kept.push(Piece::Line([end, start]));
            }
        }
        kept
    }

    /// The parts of a piece that lie in the half-plane, in order.
    fn parts(&self, piece: &Piece) -> Vec<Piece> {
        match *piece {
            Piece::Line([from, to]) => {
                let crossing = || {
                    let share = (self.limit - from[self.axis]) / (to[self.axis] - from[self.axis]);
                    let mut point = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
                    point[self.axis] = self.limit;
                    point
                };
                match (self.holds(from), self.holds(to)) {
                    (true, true) => vec![*piece],
                    (true, false) => vec![Piece::Line([from, crossing()])],
                    (false, true) => vec![Piece::Line([crossing(), to])],
                    (false, false) => Vec::new(),
                }
            }
            Piece::Arc(ellipse, [from, to]) => {
                let mut ends = vec![from, to];
                let crossings = ellipse.crossings(self.axis, self.limit);
                ends.extend(
                    crossings
                        .into_iter()
                        .flatten()
                        .filter(|at| (from..to).contains(at)),
                );
                ends.sort_by(f64::total_cmp);
                let parts = ends.windows(2).filter(|pair| pair[0] < pair[1]);
                let is_here = |pair: &&[f64]| self.holds(ellipse.at(0.5 * (pair[0] + pair[1])));
                parts
                    .filter(is_here)
                    .map(|pair| Piece::Arc(ellipse, [pair[0], pair[1]]))
                    .collect()
            }
        }
    }
}
