//! Outlines of textures as closed curves; parts beyond a periodic edge return at the opposite edge. Lengths
//! are in blocks.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::outline::{Curve, Outlines, Ring};
use super::pattern::grids;
use super::texture::{Shape, Texture};
use crate::lattice::{Edges, Lattice};

/// A closed curve.
#[derive(Clone, Debug, PartialEq)]
pub enum Contour {
    /// A whole ellipse.
    Ellipse(Ellipse),
    /// The corners of a polygon, in order; the even-odd rule defines its inside.
    Polygon(Vec<[f64; 2]>),
    /// Straight lines and arcs of circles: each piece begins where the one before ends.
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
    /// The ellipse from one parameter to another, at most a quarter of a turn away: see [`Ellipse::at`].
    Arc(Ellipse, [f64; 2]),
}

impl Contour {
    /// The rectangle with these smallest and largest (x, y).
    pub fn rectangle(low: [f64; 2], high: [f64; 2]) -> Self {
        Self::Polygon(rectangle(low, high))
    }

    /// The pieces of the curve, in order: the quarters of an ellipse, or the edges of a polygon.
    pub fn pieces(&self) -> Vec<Piece> {
        let quarter = |k: i32| [k, k + 1].map(|quarters| f64::from(quarters) * FRAC_PI_2);
        match self {
            Self::Ellipse(ellipse) => (0..4).map(|k| Piece::Arc(*ellipse, quarter(k))).collect(),
            Self::Polygon(corners) => {
                let edges = corners.iter().zip(corners.iter().cycle().skip(1));
                edges.map(|(&from, &to)| Piece::Line([from, to])).collect()
            }
            Self::Pieces(pieces) => pieces.clone(),
        }
    }
}

impl Ellipse {
    /// The point at a parameter: `center + a cos(t) axis + b sin(t) axis'`, with the axis' a quarter turn to
    /// the left.
    ///
    /// ```
    /// # use slipfront::surface::Ellipse;
    /// let ellipse = Ellipse { center: [1.0, 0.0], semi_axes: [3.0, 2.0], axis: [0.0, 1.0] };
    /// assert_eq!(ellipse.at(0.0), [1.0, 3.0]);
    /// ```
    pub fn at(&self, parameter: f64) -> [f64; 2] {
        // The point after a whole turn equals the first one to the last bit, so that no curve is open.
        let parameter = parameter.rem_euclid(TAU);
        let along = self.semi_axes[0] * libm::cos(parameter);
        let aside = self.semi_axes[1] * libm::sin(parameter);
        let [c, s] = self.axis;
        [
            self.center[0] + along * c - aside * s,
            self.center[1] + along * s + aside * c,
        ]
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

/// The outlines of all copies of a texture's shape, whether it is inverted or not. Masks have none, since
/// their outlines are the edges of blocks, nor have drawings with an inside that the even-odd rule of all
/// outlines of a copy does not define. They may reach beyond the slider, or lie outside it. A groove is a
/// rectangle as long as the slider.
pub fn contours(lattice: &Lattice, texture: &Texture) -> Option<Vec<Contour>> {
    let grids = grids(&texture.arrays);
    let outlines = match &texture.shape {
        Shape::Cavity(cavity) => cavity.outlines(&grids),
        Shape::Polygon(points) => Outlines::polygon(points, &grids),
        Shape::Drawing(parts) => Outlines::drawing(parts, &grids),
        Shape::Groove(groove) => {
            let strips = groove.shifts(&grids).into_iter();
            let rectangles = strips.flat_map(|shift| {
                let bounds = groove.rectangle(lattice, shift);
                let [low, high] = bounds;
                shifts_onto(lattice, [[low[0], high[0]], [low[1], high[1]]])
                    .into_iter()
                    .map(move |[x, y]| bounds.map(|corner| [corner[0] + x, corner[1] + y]))
            });
            return Some(
                rectangles
                    .map(|[low, high]| Contour::rectangle(low, high))
                    .collect(),
            );
        }
        Shape::Tile(_) => return None,
    };
    if matches!(&outlines.curve, Curve::Polygon(rings) if !Ring::are_even_odd(rings)) {
        return None;
    }
    let mut contours = Vec::new();
    for [columns, rows] in &outlines.centers {
        for &y in rows {
            for &x in columns {
                let bounds = [outlines.bounds(0, x), outlines.bounds(1, y)];
                for [shift_x, shift_y] in shifts_onto(lattice, bounds) {
                    match &outlines.curve {
                        Curve::Ellipse { semi_axes, axis } => contours.push(Contour::Ellipse(Ellipse {
                            center: [x + shift_x, y + shift_y],
                            semi_axes: *semi_axes,
                            axis: *axis,
                        })),
                        Curve::Polygon(rings) => contours.extend(rings.iter().map(|ring| {
                            let corners = ring.vertices.iter().map(|vertex| {
                                let [x, y] = vertex.around([x, y]);
                                [x + shift_x, y + shift_y]
                            });
                            Contour::Polygon(corners.collect())
                        })),
                    }
                }
            }
        }
    }
    Some(contours)
}

/// The corners of the rectangle with these smallest and largest (x, y).
pub(super) fn rectangle(low: [f64; 2], high: [f64; 2]) -> Vec<[f64; 2]> {
    vec![low, [high[0], low[1]], high, [low[0], high[1]]]
}

/// The shifts by whole sliders along periodic axes that bring a contour with these bounds onto the slider.
fn shifts_onto(lattice: &Lattice, bounds: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
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
