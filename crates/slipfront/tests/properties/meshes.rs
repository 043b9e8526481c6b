//! Meshes of patterns compared with the simplest method: every block of every copy, one after the other.

use std::f64::consts::TAU;

use proptest::prelude::*;
use slipfront::surface::{Array, Cavity, Groove, Orientation, Shape, Texture, Tile, mesh};
use slipfront::{Drive, Edges, Lattice};

use crate::lattice_below;

/// A coordinate on a grid of quarters of a block, for which block centres lie on outlines, or any coordinate.
fn coordinate(range: std::ops::Range<f64>) -> impl Strategy<Value = f64> {
    (range, any::<bool>()).prop_map(|(x, is_round)| if is_round { (4.0 * x).round() / 4.0 } else { x })
}

prop_compose! {
    fn cavity()(
        center in [coordinate(-4.0..24.0), coordinate(-4.0..24.0)],
        lambda in coordinate(0.3..16.0),
        s in prop_oneof![1..6_u32, Just(64)],
        w in prop_oneof![Just(-1.0), Just(0.0), Just(0.5), Just(1.0), -1.0..1.0_f64],
        across in any::<bool>(),
        rotate in prop_oneof![Just(0.0), Just(90.0), Just(45.0), -360.0..360.0_f64],
    ) -> Cavity {
        // |w| = 1/s gives cusps; for an ellipse (s = 1) |w| must be less than 1.
        let w = if s == 1 { 0.99 * w } else { w / f64::from(s) };
        Cavity { center, lambda, s, w, across, rotate }
    }
}

/// Whether the centre of a block lies inside a cavity with this centre; the block may lie beyond a periodic
/// edge.
type IsInside = Box<dyn Fn([isize; 2]) -> bool>;

/// Eq. 17 as printed, for one cavity: the formula of a circle, which no rotation changes, or of an ellipse,
/// or the crossings of a polygon of 4096 vertices with the row of the block: a centre is inside if an odd
/// number of them lies to its left.
fn inside(cavity: &Cavity, [x, y]: [f64; 2], rows: std::ops::Range<isize>) -> IsInside {
    let Cavity { lambda, w, .. } = *cavity;
    let s = f64::from(cavity.s);
    let axis = Drive::at_angle(1.0, cavity.rotate).direction;
    let swap = |p: [f64; 2]| if cavity.across { [p[1], p[0]] } else { p };
    if w == 0.0 {
        return Box::new(move |[column, row]| {
            let (dx, dy) = (column as f64 + 0.5 - x, row as f64 + 0.5 - y);
            (dx / lambda).powi(2) + (dy / lambda).powi(2) < 1.0
        });
    }
    if cavity.s == 1 {
        let [a, b] = swap([lambda * (1.0 + w), lambda * (1.0 - w)]);
        return Box::new(move |[column, row]| {
            let (dx, dy) = (column as f64 + 0.5 - x, row as f64 + 0.5 - y);
            let turned = [dx * axis[0] + dy * axis[1], dy * axis[0] - dx * axis[1]];
            (turned[0] / a).powi(2) + (turned[1] / b).powi(2) < 1.0
        });
    }
    let vertex = |k: usize| {
        let phi = TAU * k as f64 / 4096.0;
        let p = swap([
            lambda * (libm::cos(phi) + w * libm::cos(s * phi)),
            lambda * (libm::sin(phi) - w * libm::sin(s * phi)),
        ]);
        [
            x + axis[0] * p[0] - axis[1] * p[1],
            y + axis[1] * p[0] + axis[0] * p[1],
        ]
    };
    let vertices: Vec<[f64; 2]> = (0..4096).map(vertex).collect();
    let crossings = |row: isize| -> Vec<f64> {
        let y = row as f64 + 0.5;
        let edges = (0..4096).map(|k| (vertices[(k + 4095) % 4096], vertices[k]));
        let cut = edges.filter(|(p, q)| (p[1] <= y) != (q[1] <= y));
        cut.map(|(p, q)| p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]))
            .collect()
    };
    let first = rows.start;
    let crossings: Vec<Vec<f64>> = rows.map(crossings).collect();
    Box::new(move |[column, row]| {
        // The first block with a centre that does not lie left of a crossing.
        let blocks = crossings[(row - first) as usize].iter().map(|x| (x - 0.5).ceil());
        blocks.filter(|block| *block <= column as f64).count() % 2 == 1
    })
}

/// The mask of all copies of a cavity.
fn by_the_letter(lattice: &Lattice, cavity: &Cavity, arrays: &[Array]) -> Vec<bool> {
    let blocks = [lattice.nx as isize, lattice.ny as isize];
    let places = places(arrays);
    // As many sliders next to each other as the farthest outline reaches.
    let range = |axis: usize| match lattice.edges[axis] {
        Edges::Free => 0..blocks[axis],
        Edges::Periodic => {
            let farthest = places.iter().map(|place| place[axis].abs()).fold(0.0, f64::max);
            let reach = (cavity.center[axis].abs() + farthest + 2.0 * cavity.lambda) as isize + 3;
            let turns = reach / blocks[axis] + 1;
            -turns * blocks[axis]..(turns + 1) * blocks[axis]
        }
    };
    let (columns, rows) = (range(0), range(1));
    let mut textured = vec![false; lattice.n_blocks()];
    for place in places {
        let center = [cavity.center[0] + place[0], cavity.center[1] + place[1]];
        let is_inside = inside(cavity, center, rows.clone());
        for row in rows.clone() {
            for column in columns.clone() {
                let [i, j] = [column.rem_euclid(blocks[0]), row.rem_euclid(blocks[1])];
                textured[(j * blocks[0] + i) as usize] |= is_inside([column, row]);
            }
        }
    }
    textured
}

/// The shifts of all copies: every position of an array is the middle of the next array.
fn places(arrays: &[Array]) -> Vec<[f64; 2]> {
    let Some((array, others)) = arrays.split_last() else {
        return vec![[0.0; 2]];
    };
    let [columns, rows] = array.count;
    let mut places_here = Vec::new();
    for [x, y] in places(others) {
        for row in 0..rows {
            for column in 0..columns {
                let aside = match (array.staggered && rows > 1, row % 2) {
                    (false, _) => 0.0,
                    (true, 0) => -0.25,
                    (true, _) => 0.25,
                };
                let shift =
                    |k: usize, count: usize, spacing: f64| spacing * (k as f64 - 0.5 * (count as f64 - 1.0));
                places_here.push([
                    x + (shift(column, columns, array.spacing[0]) + aside * array.spacing[0]),
                    y + shift(row, rows, array.spacing[1]),
                ]);
            }
        }
    }
    places_here
}

prop_compose! {
    fn array()(
        count in [1..5_usize, 1..5_usize],
        // In quarters of four blocks, so that the shifts of staggered rows are on the grid of the
        // coordinates, too.
        spacing in [coordinate(0.5..9.0), coordinate(0.5..9.0)],
        staggered in any::<bool>(),
    ) -> Array {
        Array { count, spacing, staggered }
    }
}

/// A shape other than a cavity, in a slider of these blocks.
fn other_shape(blocks: [usize; 2]) -> impl Strategy<Value = Shape> {
    let place = || coordinate(-4.0..24.0);
    let orientation = prop_oneof![Just(Orientation::Across), Just(Orientation::Along)];
    let groove = (orientation, coordinate(0.3..6.0), coordinate(-8.0..8.0));
    let size = [1..=blocks[0], 1..=blocks[1]];
    let tile = size.prop_flat_map(|size| {
        let blocks = prop::collection::vec(any::<bool>(), size[0] * size[1]);
        blocks.prop_map(move |blocks| Tile {
            size,
            rows: 0..size[1],
            blocks: blocks.into(),
        })
    });
    prop_oneof![
        groove.prop_map(|(orientation, width, offset)| Shape::Groove(Groove {
            orientation,
            width,
            offset
        })),
        prop::collection::vec([place(), place()], 3..9).prop_map(Shape::Polygon),
        tile.prop_map(Shape::Tile),
    ]
}

/// The mask of one copy, moved from the position of the shape.
fn copy(lattice: &Lattice, shape: &Shape, [x, y]: [f64; 2]) -> Vec<bool> {
    let moved = match shape.clone() {
        Shape::Groove(groove) => {
            let shift = if groove.orientation == Orientation::Across {
                x
            } else {
                y
            };
            Shape::Groove(Groove {
                offset: groove.offset + shift,
                ..groove
            })
        }
        Shape::Polygon(points) => Shape::Polygon(
            points
                .into_iter()
                .map(|point| [point[0] + x, point[1] + y])
                .collect(),
        ),
        Shape::Tile(tile) => return copy_of_tile(lattice, &tile, [x, y]),
        other @ (Shape::Cavity(_) | Shape::Drawing(_)) => other,
    };
    mesh(lattice, &[moved.into()]).textured
}

fn copy_of_tile(lattice: &Lattice, tile: &Tile, [x, y]: [f64; 2]) -> Vec<bool> {
    let mut textured = vec![false; lattice.n_blocks()];
    let start = |blocks: usize, size: usize, shift: f64| {
        (0.5 * (blocks as f64 - size as f64) + shift + 0.5).floor() as isize
    };
    for (at, _) in tile.blocks.iter().enumerate().filter(|(_, inside)| **inside) {
        let i = start(lattice.nx, tile.size[0], x) + (at % tile.size[0]) as isize;
        let j = start(lattice.ny, tile.size[1], y) + (at / tile.size[0]) as isize;
        let within = |at: isize, count: usize, edges: Edges| match edges {
            Edges::Free => usize::try_from(at).ok().filter(|at| *at < count),
            Edges::Periodic => Some(at.rem_euclid(count as isize) as usize),
        };
        if let (Some(i), Some(j)) = (
            within(i, lattice.nx, lattice.edges[0]),
            within(j, lattice.ny, lattice.edges[1]),
        ) {
            textured[lattice.block(i, j)] = true;
        }
    }
    textured
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn patterns_of_cavities_cover_what_each_of_them_covers(
        lattice in lattice_below(24),
        cavity in cavity(),
        arrays in prop::collection::vec(array(), 0..3),
        spread in prop::option::of([1..8_usize, 1..8_usize]),
    ) {
        let arrays = spread.map_or(arrays, |count| vec![Array::spread(&lattice, count)]);
        let texture = Texture { arrays, ..Shape::Cavity(cavity).into() };
        let expected = by_the_letter(&lattice, &cavity, &texture.arrays);
        let meshed = mesh(&lattice, &[texture]);
        prop_assert_eq!(meshed.empty.is_empty(), expected.contains(&true));
        prop_assert_eq!(meshed.textured, expected);
    }

    #[test]
    fn patterns_of_other_shapes_cover_what_each_copy_covers(
        (lattice, shape) in lattice_below(24).prop_flat_map(|lattice| {
            let shape = other_shape([lattice.nx, lattice.ny]);
            (Just(lattice), shape)
        }),
        arrays in prop::collection::vec(array(), 0..3),
    ) {
        let mut expected = vec![false; lattice.n_blocks()];
        for place in places(&arrays) {
            let copy = copy(&lattice, &shape, place);
            expected.iter_mut().zip(copy).for_each(|(textured, here)| *textured |= here);
        }
        let texture = Texture { arrays, ..shape.into() };
        prop_assert_eq!(mesh(&lattice, &[texture]).textured, expected);
    }

    #[test]
    fn an_inverted_texture_is_the_complement_block_by_block(
        lattice in lattice_below(24),
        cavity in cavity(),
        arrays in prop::collection::vec(array(), 0..2),
        beside in other_shape([3, 3]),
    ) {
        let plain = Texture { arrays, ..Shape::Cavity(cavity).into() };
        let inverted = Texture { inverted: true, ..plain.clone() };
        let beside = Texture::from(beside);
        let inside = mesh(&lattice, std::slice::from_ref(&plain)).textured;
        let outside = mesh(&lattice, std::slice::from_ref(&inverted));
        prop_assert!(inside.iter().zip(&outside.textured).all(|(inside, outside)| inside != outside));
        prop_assert_eq!(outside.empty.is_empty(), inside.contains(&false));
        // Together with another texture, the two are still combined.
        let other = mesh(&lattice, std::slice::from_ref(&beside)).textured;
        let both = mesh(&lattice, &[beside, inverted]).textured;
        for b in 0..lattice.n_blocks() {
            prop_assert_eq!(both[b], other[b] || !inside[b]);
        }
    }
}
