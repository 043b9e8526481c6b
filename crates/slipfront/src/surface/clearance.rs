//! The smallest textured feature and the smallest gap between two: what a tool must be able to make, and blocks to show.

use std::collections::HashMap;
use std::f64::consts::TAU;

use super::outline::{Curve, Outlines};
use super::pattern::Array;
use super::texture::{Cavity, Shape, Texture, Tile};
use crate::lattice::{Edges, Lattice};

/// Smallest lengths of textures, in blocks; none where there is no such thing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Clearance {
    /// Smallest width of what is textured.
    pub feature: Option<f64>,
    /// Smallest width of what touches between textured parts.
    pub gap: Option<f64>,
}

/// Corners by which curves are measured: a circle's radius is met within half a millionth of it.
const CORNERS: usize = 1024;
/// Most copies that are all held against each other; of more, those next to each other in every pattern, and at its ends, are.
const MANY: usize = 1024;

/// The smallest width of each shape and distance between two copies, before edges cut them. Shapes that overlap are one. Of a mask
/// these are its shortest runs of blocks along x and y.
///
/// ```
/// # use slipfront::Lattice;
/// # use slipfront::surface::{Array, Cavity, Shape, Texture, clearance};
/// let lattice = Lattice::free(40, 20);
/// let circle = Cavity { center: [20.0, 10.0], lambda: 4.0, s: 1, w: 0.0, across: false, rotate: 0.0 };
/// let arrays = vec![Array::spread(&lattice, [4, 2])];
/// let found = clearance(&lattice, &[Texture { arrays, ..Shape::Cavity(circle).into() }]);
/// assert!((found.feature.unwrap() - 8.0).abs() < 1e-4 && (found.gap.unwrap() - 2.0).abs() < 1e-4);
/// ```
pub fn clearance(lattice: &Lattice, textures: &[Texture]) -> Clearance {
    let all: usize = textures
        .iter()
        .map(|texture| texture.shape.n_copies(&texture.arrays))
        .sum();
    let mut clearance = Clearance::default();
    let mut shapes = Vec::new();
    for texture in textures {
        if let Shape::Tile(tile) = &texture.shape {
            let [mut inside, mut outside] = runs(tile);
            if texture.inverted {
                [inside, outside] = [outside, inside];
            }
            least(&mut clearance.feature, inside);
            least(&mut clearance.gap, outside);
        }
        let Some(corners) = corners(lattice, texture) else {
            continue;
        };
        let [mut inside, mut outside] = match &texture.shape {
            // A rectangle that ends where the slider does, whose length is none of its widths.
            Shape::Groove(groove) => [Some(groove.width), None],
            Shape::Cavity(Cavity { lambda, s: 1, w, .. }) => [Some(2.0 * lambda * (1.0 - w.abs())), None],
            _ => widths(&corners),
        };
        let places = places(&texture.arrays, all <= MANY);
        if texture.inverted {
            [inside, outside] = [outside, inside];
        }
        least(&mut clearance.feature, inside);
        least(&mut clearance.gap, outside);
        shapes.push((corners, places, texture.inverted));
    }
    // Pillars are apart by what is textured between them.
    for inverted in [false, true] {
        let shapes: Vec<_> = shapes.iter().filter(|shape| shape.2 == inverted).collect();
        let found = if inverted {
            &mut clearance.feature
        } else {
            &mut clearance.gap
        };
        let mut known: HashMap<(usize, usize, [i64; 2]), f64> = HashMap::new();
        for (i, (one, one_places, _)) in shapes.iter().enumerate() {
            for (j, (other, other_places, _)) in shapes.iter().enumerate().skip(i) {
                if inverted && i != j {
                    continue;
                }
                for (m, from) in one_places.iter().enumerate() {
                    for (n, to) in other_places.iter().enumerate() {
                        for turn in turns(lattice) {
                            if i == j && (m > n || m == n && turn == [0.0; 2]) {
                                continue;
                            }
                            let shift = [0, 1].map(|axis| to[axis] - from[axis] + turn[axis]);
                            if apart(one, other, shift) >= found.unwrap_or(f64::INFINITY) {
                                continue;
                            }
                            let key = (i, j, shift.map(|length| (length * 1e6).round() as i64));
                            let distance = *known.entry(key).or_insert_with(|| distance(one, other, shift));
                            least(found, (distance > 0.0).then_some(distance));
                        }
                    }
                }
            }
        }
    }
    clearance
}

fn least(found: &mut Option<f64>, value: Option<f64>) {
    if let Some(value) = value {
        *found = Some(found.map_or(value, |found| found.min(value)));
    }
}

/// The shortest runs of blocks along x and y that are inside a mask, and of those that are outside between two of these.
fn runs(tile: &Tile) -> [Option<f64>; 2] {
    let [nx, ny] = tile.size;
    let mut found = [None, None];
    let mut add = |line: Vec<bool>| {
        let runs: Vec<&[bool]> = line.chunk_by(|one, other| one == other).collect();
        for (at, run) in runs.iter().enumerate() {
            if run[0] || at > 0 && at + 1 < runs.len() {
                least(&mut found[usize::from(!run[0])], Some(run.len() as f64));
            }
        }
    };
    tile.blocks.chunks(nx).for_each(|row| add(row.to_vec()));
    (0..nx).for_each(|column| add((0..ny).map(|row| tile.blocks[row * nx + column]).collect()));
    found
}

/// The shape of a texture in the middle of its places.
fn corners(lattice: &Lattice, texture: &Texture) -> Option<Vec<[f64; 2]>> {
    let alone = vec![[vec![0.0], vec![0.0]]];
    let outlines = match &texture.shape {
        Shape::Cavity(cavity) => cavity.outlines(&alone),
        Shape::Polygon(points) => Outlines::polygon(points, &alone),
        Shape::Groove(groove) => {
            let [mut low, mut high] = groove.bounds(lattice, 0.0);
            let along = 1 - groove.axis();
            (low[along], high[along]) = (0.0, [lattice.nx, lattice.ny][along] as f64);
            return Some(vec![low, [high[0], low[1]], high, [low[0], high[1]]]);
        }
        Shape::Tile(_) => return None,
    };
    let center = [0, 1].map(|axis| outlines.outermost(axis).next().unwrap_or_default());
    Some(match &outlines.curve {
        Curve::Ellipse { semi_axes, axis } => {
            let ellipse = super::contour::Ellipse {
                center,
                semi_axes: *semi_axes,
                axis: *axis,
            };
            (0..CORNERS)
                .map(|k| ellipse.at(TAU * k as f64 / CORNERS as f64))
                .collect()
        }
        Curve::Polygon(vertices) => {
            let step = vertices.len().div_ceil(CORNERS);
            vertices
                .iter()
                .step_by(step)
                .map(|vertex| vertex.around(center))
                .collect()
        }
    })
}

/// The places of arrays of arrays: all, or of each the first three and the last line along both axes, with all distances between
/// neighbours.
fn places(arrays: &[Array], all: bool) -> Vec<[f64; 2]> {
    let lines = |count: usize| (0..count).filter(move |&line| all || line < 3 || line + 1 == count);
    arrays.iter().fold(vec![[0.0; 2]], |outer, array| {
        let mut places = Vec::new();
        for [x, y] in outer {
            for row in lines(array.count[1]) {
                for column in lines(array.count[0]) {
                    let [dx, dy] = array.place(column, row);
                    places.push([x + dx, y + dy]);
                }
            }
        }
        places
    })
}

/// Shifts to the neighbouring images beyond periodic edges, and none.
fn turns(lattice: &Lattice) -> impl Iterator<Item = [f64; 2]> {
    let along = |axis: usize| {
        let size = [lattice.nx, lattice.ny][axis] as f64;
        match lattice.edges[axis] {
            Edges::Free => vec![0.0],
            Edges::Periodic => vec![-size, 0.0, size],
        }
    };
    let (x, y) = (along(0), along(1));
    y.into_iter()
        .flat_map(move |y| x.clone().into_iter().map(move |x| [x, y]))
}

fn bounds(corners: &[[f64; 2]], axis: usize) -> [f64; 2] {
    let start = [f64::INFINITY, f64::NEG_INFINITY];
    corners.iter().fold(start, |[low, high], corner| {
        [low.min(corner[axis]), high.max(corner[axis])]
    })
}

/// At least this far are two shapes from each other, the second of which is shifted.
fn apart(one: &[[f64; 2]], other: &[[f64; 2]], shift: [f64; 2]) -> f64 {
    let between = |axis: usize| {
        let ([low, high], [from, to]) = (bounds(one, axis), bounds(other, axis));
        (from + shift[axis] - high).max(low - to - shift[axis]).max(0.0)
    };
    libm::hypot(between(0), between(1))
}

fn edges(corners: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(&from, &to)| [from, to])
}

/// Distance of a point from an edge, and its foot on the edge if it has one.
fn to_edge(point: [f64; 2], [from, to]: [[f64; 2]; 2]) -> (f64, Option<[f64; 2]>) {
    let along = [to[0] - from[0], to[1] - from[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let share = ((point[0] - from[0]) * along[0] + (point[1] - from[1]) * along[1]) / square;
    let nearest = share.clamp(0.0, 1.0);
    let nearest = [from[0] + nearest * along[0], from[1] + nearest * along[1]];
    let distance = libm::hypot(point[0] - nearest[0], point[1] - nearest[1]);
    (distance, (0.0..=1.0).contains(&share).then_some(nearest))
}

fn is_inside(point: [f64; 2], corners: &[[f64; 2]]) -> bool {
    let crossed = edges(corners).filter(|[p, q]| {
        (p[1] <= point[1]) != (q[1] <= point[1])
            && point[0] < p[0] + (point[1] - p[1]) / (q[1] - p[1]) * (q[0] - p[0])
    });
    crossed.count() % 2 == 1
}

/// The smallest distance of a corner from an edge that it faces: across the inside, and across the outside of a shape.
fn widths(corners: &[[f64; 2]]) -> [Option<f64>; 2] {
    let mut found = [None, None];
    for (at, &corner) in corners.iter().enumerate() {
        for (start, edge) in edges(corners).enumerate() {
            if start == at || (start + 1) % corners.len() == at {
                continue;
            }
            let (distance, Some(foot)) = to_edge(corner, edge) else {
                continue;
            };
            if found
                .iter()
                .all(|least: &Option<f64>| least.is_some_and(|least| least <= distance))
            {
                continue;
            }
            // Beside the middle of the edge, towards the corner.
            let aside = [corner[0] - foot[0], corner[1] - foot[1]].map(|part| 1e-6 * part);
            let beside = [0, 1].map(|axis| 0.5 * (edge[0][axis] + edge[1][axis]) + aside[axis]);
            least(
                &mut found[usize::from(!is_inside(beside, corners))],
                Some(distance),
            );
        }
    }
    found
}

/// The distance between two shapes, the second of which is shifted; 0 if they overlap.
fn distance(one: &[[f64; 2]], other: &[[f64; 2]], [x, y]: [f64; 2]) -> f64 {
    let other: Vec<[f64; 2]> = other
        .iter()
        .map(|corner| [corner[0] + x, corner[1] + y])
        .collect();
    if is_inside(one[0], &other) || is_inside(other[0], one) {
        return 0.0;
    }
    let mut least = f64::INFINITY;
    for (points, line) in [(one, &other[..]), (&other[..], one)] {
        for &point in points {
            if is_inside(point, line) {
                return 0.0;
            }
            for edge in edges(line) {
                least = least.min(to_edge(point, edge).0);
            }
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::super::texture::{Groove, Orientation};
    use super::*;

    fn of(lattice: &Lattice, shape: Shape, arrays: Vec<Array>, inverted: bool) -> [f64; 2] {
        let texture = Texture {
            shape,
            arrays,
            inverted,
        };
        let Clearance { feature, gap } = clearance(lattice, &[texture]);
        [feature, gap].map(|length| length.unwrap_or(f64::NAN))
    }

    fn is_near(found: [f64; 2], expected: [f64; 2]) -> bool {
        // Circles as polygons of 1024 corners differ from their radius by 5e-6 of it.
        let near = |found: f64, expected: f64| {
            (found - expected).abs() < 1e-3 || found.is_nan() && expected.is_nan()
        };
        near(found[0], expected[0]) && near(found[1], expected[1])
    }

    #[test]
    fn widths_and_gaps_are_those_of_the_drawing() {
        let free = Lattice::free(60, 60);
        let periodic = Lattice::with_edges(60, 60, [Edges::Periodic; 2]);
        let ellipse = |w: f64| {
            Shape::Cavity(Cavity {
                center: [30.0, 30.0],
                lambda: 5.0,
                s: 1,
                w,
                across: false,
                rotate: 0.0,
            })
        };
        let array = |count, spacing, staggered| Array {
            count,
            spacing,
            staggered,
        };
        let nan = f64::NAN;
        let close = array([3, 1], [12.0, 12.0], false);
        assert!(is_near(of(&free, ellipse(0.2), vec![], false), [8.0, nan]));
        // Semi-axes of 6 and 4: neighbours along x touch, those along y are 4 apart.
        assert!(is_near(
            of(
                &free,
                ellipse(0.2),
                vec![array([3, 3], [13.0, 12.0], false)],
                false
            ),
            [8.0, 1.0]
        ));
        assert!(is_near(of(&free, ellipse(0.0), vec![close], true), [2.0, 10.0]));
        // Beyond the edges, from 42 to 18 + 60.
        assert!(is_near(
            of(
                &periodic,
                ellipse(0.0),
                vec![array([2, 1], [48.0, 1.0], false)],
                false
            ),
            [10.0, 2.0]
        ));
        let diagonal = array([2, 2], [20.0, 10.0], true);
        assert!(is_near(
            of(&free, ellipse(0.0), vec![diagonal], false),
            [10.0, 200.0_f64.sqrt() - 10.0]
        ));
        // Clusters of four, which are nearer to each other than within.
        let clusters = vec![
            array([2, 1], [21.0, 1.0], false),
            array([2, 2], [11.0, 11.0], false),
        ];
        let found = of(&free, ellipse(-0.0), clusters, false);
        assert!(is_near(found, [10.0, 1.0]), "{found:?}");
        let groove = Shape::Groove(Groove {
            orientation: Orientation::Across,
            width: 2.5,
            offset: 0.0,
        });
        assert!(is_near(
            of(&free, groove, vec![array([4, 1], [10.0, 1.0], false)], false),
            [2.5, 7.5]
        ));
        let square = Shape::Polygon(vec![[10.0, 10.0], [20.0, 10.0], [20.0, 13.0], [10.0, 13.0]]);
        assert!(is_near(of(&free, square, vec![], false), [3.0, nan]));
        // Arms of 12 upright, at a slope of 2 to 3; between them the notch of a chevron is a corner, and no gap.
        let chevron = [
            [10.0, 12.0],
            [25.0, 22.0],
            [40.0, 12.0],
            [40.0, 24.0],
            [25.0, 34.0],
            [10.0, 24.0],
        ];
        let found = of(&free, Shape::Polygon(chevron.to_vec()), vec![], false);
        assert!(
            (found[0] - 12.0 * 15.0 / 325.0_f64.sqrt()).abs() < 1e-9,
            "{found:?}"
        );
    }
}
