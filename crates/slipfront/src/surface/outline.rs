//! Closed outlines that can be cut by a horizontal line, singly or on grids of centres.
//!
//! The cut of a line with an outline depends only on the height of its centre, except for a shift along x. So
//! the cut is computed once for all outlines of a row of a grid, and each of its ends is placed with the same
//! rounding as for a single outline at this position.

use super::drawing::{FillRule, Part};
use super::pattern::Crossings;

/// Outlines of one curve, around every crossing of the lines of some grids.
pub(super) struct Outlines {
    pub(super) curve: Curve,
    /// The grids of the outlines' centres.
    pub(super) centers: Vec<Crossings>,
}

/// An outline around (0, 0).
pub(super) enum Curve {
    /// An ellipse, given by its semi-axes and the direction of the first.
    Ellipse { semi_axes: [f64; 2], axis: [f64; 2] },
    /// Polygons, whose parts are united.
    Polygon(Vec<Ring>),
}

/// A closed polyline.
pub(super) struct Ring {
    pub(super) vertices: Vec<Vertex>,
    /// The rings with this number are filled together, by their common rule.
    part: usize,
    rule: FillRule,
}

impl Ring {
    /// A polygon, whose inside the even-odd rule defines.
    pub(super) fn alone(vertices: Vec<Vertex>) -> Self {
        Self {
            vertices,
            part: 0,
            rule: FillRule::EvenOdd,
        }
    }

    /// Whether the even-odd rule defines the inside of all rings together.
    pub(super) fn are_even_odd(rings: &[Self]) -> bool {
        rings
            .iter()
            .all(|ring| (ring.part, ring.rule) == (0, FillRule::EvenOdd))
    }
}

impl Curve {
    /// Distance from the curve within which [`Sweep::contains`] decides about a point, far above the rounding
    /// errors of 10^-9 of coordinates of up to 10^7 blocks. A polygon needs none: it is cut where its corners
    /// are.
    fn margin(&self) -> f64 {
        match self {
            Self::Ellipse {
                semi_axes: [a, b], ..
            } => 1e-8 * (1.0 + a.abs().max(b.abs())),
            Self::Polygon(_) => 0.0,
        }
    }
}

/// A coordinate relative to the centre, as two terms that are added to it one after the other.
type Terms = [f64; 2];

fn add([one, other]: Terms, center: f64) -> f64 {
    center + one + other
}

/// A corner of a polygon.
pub(super) struct Vertex {
    pub(super) x: Terms,
    pub(super) y: Terms,
}

impl Vertex {
    fn at(&[x, y]: &[f64; 2]) -> Self {
        Self {
            x: [x, 0.0],
            y: [y, 0.0],
        }
    }

    /// Position of the corner if the polygon has this centre.
    pub(super) fn around(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [add(self.x, x), add(self.y, y)]
    }
}

/// The smallest and the largest of some numbers.
pub(super) fn range(numbers: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let widen = |[low, high]: [f64; 2], number: f64| [low.min(number), high.max(number)];
    numbers.into_iter().fold(none, widen)
}

impl Outlines {
    /// A curve around the middle of `grids`, which contain the shifts of its copies from there.
    pub(super) fn at(curve: Curve, middle: [f64; 2], grids: &[Crossings]) -> Self {
        let centers = |grid: &Crossings| {
            let along = |axis: usize| grid[axis].iter().map(|shift| middle[axis] + shift).collect();
            [along(0), along(1)]
        };
        Self {
            curve,
            centers: grids.iter().map(centers).collect(),
        }
    }

    /// The copies of a polygon around the middle of `grids`.
    pub(super) fn polygon(points: &[[f64; 2]], grids: &[Crossings]) -> Self {
        let ring = Ring::alone(points.iter().map(Vertex::at).collect());
        Self::at(Curve::Polygon(vec![ring]), [0.0; 2], grids)
    }

    /// The copies of a drawing around the middle of `grids`.
    pub(super) fn drawing(parts: &[Part], grids: &[Crossings]) -> Self {
        let rings = parts.iter().enumerate().flat_map(|(part, drawn)| {
            drawn.rings.iter().map(move |corners| Ring {
                vertices: corners.iter().map(Vertex::at).collect(),
                part,
                rule: drawn.rule,
            })
        });
        Self::at(Curve::Polygon(rings.collect()), [0.0; 2], grids)
    }

    /// The first and the last lines of the grids along an axis.
    pub(super) fn outermost(&self, axis: usize) -> impl Iterator<Item = f64> + '_ {
        let lines = self.centers.iter().map(move |grid| &grid[axis]);
        lines.flat_map(|lines| [lines[0], lines[lines.len() - 1]])
    }

    /// Smallest and largest coordinate of the outline with this centre.
    pub(super) fn bounds(&self, axis: usize, center: f64) -> [f64; 2] {
        match &self.curve {
            Curve::Ellipse {
                semi_axes: [a, b],
                axis: [c, s],
            } => {
                let [along_a, along_b] = if axis == 0 { [c, s] } else { [s, c] };
                let half = ((a * along_a).powi(2) + (b * along_b).powi(2)).sqrt();
                [center - half, center + half]
            }
            Curve::Polygon(rings) => {
                let vertices = rings.iter().flat_map(|ring| &ring.vertices);
                let terms = vertices.map(|vertex| [vertex.x, vertex.y][axis]);
                range(terms.map(|terms| add(terms, center)))
            }
        }
    }

    /// Heights between which horizontal lines may cut the outline with its centre at this height: its bounds
    /// with [`margin`](Curve::margin), since [`Sweep`] alone decides which points are inside.
    pub(super) fn heights(&self, center: f64) -> [f64; 2] {
        let ([low, high], margin) = (self.bounds(1, center), self.curve.margin());
        [low - margin, high + margin]
    }

    /// The outlines with centres at this height, to be cut by lines from the lowest to the highest.
    pub(super) fn at_height(&self, center: f64) -> Sweep<'_> {
        let (edges, united) = match &self.curve {
            Curve::Ellipse { .. } => (Vec::new(), None),
            Curve::Polygon(rings) => {
                let parts = rings.last().map_or(0, |ring| ring.part + 1);
                let united = (!Ring::are_even_odd(rings)).then(|| vec![0; parts]);
                (edges(rings, center), united)
            }
        };
        Sweep {
            windings: united,
            curve: &self.curve,
            center,
            edges,
            next: 0,
            cut: Vec::new(),
        }
    }
}

/// An edge of a polygon between two heights.
#[derive(Clone, Copy)]
struct Edge {
    from: Terms,
    to: Terms,
    from_y: f64,
    to_y: f64,
    part: usize,
    rule: FillRule,
}

impl Edge {
    fn low(&self) -> f64 {
        self.from_y.min(self.to_y)
    }

    fn high(&self) -> f64 {
        self.from_y.max(self.to_y)
    }
}

/// The edges of polygons that a horizontal line can cut, the lowest first.
fn edges(rings: &[Ring], center: f64) -> Vec<Edge> {
    let edges = rings.iter().flat_map(|ring| {
        let vertices = &ring.vertices;
        let previous = vertices.iter().cycle().skip(vertices.len().saturating_sub(1));
        previous.zip(vertices).map(move |(p, q)| Edge {
            from: p.x,
            to: q.x,
            from_y: add(p.y, center),
            to_y: add(q.y, center),
            part: ring.part,
            rule: ring.rule,
        })
    });
    let mut edges: Vec<Edge> = edges.filter(|edge| edge.low() < edge.high()).collect();
    edges.sort_by(|a, b| a.low().total_cmp(&b.low()));
    edges
}

/// Outlines to be cut by one horizontal line after the other.
pub(super) struct Sweep<'a> {
    curve: &'a Curve,
    /// Coordinate y of the centres.
    center: f64,
    /// The edges of a polygon, the lowest first.
    edges: Vec<Edge>,
    /// The first edge that lies above the line.
    next: usize,
    /// The edges that the line cuts.
    cut: Vec<Edge>,
    /// Windings of the parts of a drawing around a point, all 0 outside; none for a single polygon.
    windings: Option<Vec<i32>>,
}

/// Intersection of a horizontal line with an outline.
#[derive(Clone, Copy)]
pub(super) struct Crossing {
    from: Terms,
    to: Terms,
    /// Share of the path from one corner of the edge to the other.
    share: f64,
}

impl Crossing {
    /// Coordinate x of the crossing with the outline around this x.
    pub(super) fn x(&self, center: f64) -> f64 {
        let (from, to) = (add(self.from, center), add(self.to, center));
        from + self.share * (to - from)
    }

    fn at(x: Terms) -> Self {
        Self {
            from: x,
            to: x,
            share: 0.0,
        }
    }
}

impl Sweep<'_> {
    /// Crossings with the line at `y`, which must be above earlier lines; an even number of them, in any
    /// order.
    pub(super) fn intersect(&mut self, y: f64, crossings: &mut Vec<Crossing>) {
        crossings.clear();
        match self.curve {
            Curve::Ellipse {
                semi_axes: [a, b],
                axis: [c, s],
            } => {
                // |(x, y) turned back, over the semi-axes| < 1 is a quadratic inequality in x. The ellipse is
                // slightly larger here: `contains` decides about a centre on the outline.
                let [a, b] = [a, b].map(|semi_axis| semi_axis + self.curve.margin());
                let dy = y - self.center;
                let (p, q, r) = (c / a, s / b, dy * s / a);
                let t = dy * c / b;
                let square = p * p + q * q;
                let half = p * r - q * t;
                let root = half * half - square * (r * r + t * t - 1.0);
                if root > 0.0 {
                    let root = root.sqrt();
                    let ends = [(-half - root) / square, (-half + root) / square];
                    crossings.extend(ends.map(|x| Crossing::at([x, 0.0])));
                }
            }
            Curve::Polygon(_) => {
                let above = |edge: &&Edge| edge.low() <= y;
                let reached = self.edges[self.next..].iter().take_while(above);
                let before = self.cut.len();
                self.cut.extend(reached);
                self.next += self.cut.len() - before;
                self.cut.retain(|edge| y < edge.high());
                let crossing = |edge: &Edge| Crossing {
                    from: edge.from,
                    to: edge.to,
                    share: (y - edge.from_y) / (edge.to_y - edge.from_y),
                };
                let Some(windings) = &mut self.windings else {
                    return crossings.extend(self.cut.iter().map(crossing));
                };
                let of_cut = self.cut.iter().map(|edge| (crossing(edge), edge));
                let mut of_cut: Vec<(Crossing, &Edge)> = of_cut.collect();
                of_cut.sort_by(|(a, _), (b, _)| a.x(0.0).total_cmp(&b.x(0.0)));
                // Only the lines between the union of all parts and its outside are kept.
                let mut parts_around = 0;
                for (crossing, edge) in of_cut {
                    let winding = &mut windings[edge.part];
                    let (before, was_inside) = (parts_around, *winding != 0);
                    *winding = match edge.rule {
                        FillRule::EvenOdd => 1 - *winding,
                        FillRule::NonZero if edge.from_y < edge.to_y => *winding + 1,
                        FillRule::NonZero => *winding - 1,
                    };
                    parts_around = parts_around + usize::from(*winding != 0) - usize::from(was_inside);
                    if (before == 0) != (parts_around == 0) {
                        crossings.push(crossing);
                    }
                }
            }
        }
    }

    /// Whether a point between two crossings is inside the outline around this x. An ellipse excludes its
    /// outline and is tested with a formula that rounds symmetrically, so that its mesh is as symmetric as
    /// the ellipse; polygons are half-open.
    pub(super) fn contains(&self, center: f64, [x, y]: [f64; 2]) -> bool {
        match self.curve {
            Curve::Ellipse {
                semi_axes: [a, b],
                axis: [c, s],
            } => {
                let (dx, dy) = (x - center, y - self.center);
                ((dx * c + dy * s) / a).powi(2) + ((dy * c - dx * s) / b).powi(2) < 1.0
            }
            Curve::Polygon(_) => true,
        }
    }
}
