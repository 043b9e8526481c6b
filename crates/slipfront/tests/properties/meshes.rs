//! Meshes of arrays of cavities against the plainest way to find them: every block of every cavity, one after the other.

use std::f64::consts::TAU;

use proptest::prelude::*;
use slipfront::surface::{Cavity, Texture, mesh};
use slipfront::{Drive, Edges, Lattice};

use crate::lattice_below;

/// A coordinate on a grid of quarters of a block, where block centres lie on outlines, or anywhere.
fn coordinate(range: std::ops::Range<f64>) -> impl Strategy<Value = f64> {
    (range, any::<bool>()).prop_map(|(x, is_round)| if is_round { (4.0 * x).round() / 4.0 } else { x })
}

prop_compose! {
    fn array()(
        center in [coordinate(-4.0..24.0), coordinate(-4.0..24.0)],
        lambda in coordinate(0.3..16.0),
        s in prop_oneof![1..6_u32, Just(64)],
        w in prop_oneof![Just(-1.0), Just(0.0), Just(0.5), Just(1.0), -1.0..1.0_f64],
        across in any::<bool>(),
        rotate in prop_oneof![Just(0.0), Just(90.0), Just(45.0), -360.0..360.0_f64],
        array in [1..8_usize, 1..8_usize],
    ) -> Cavity {
        // |w| = 1/s gives cusps; an ellipse must be one.
        let w = if s == 1 { 0.99 * w } else { w / f64::from(s) };
        Cavity { center, lambda, s, w, across, rotate, array }
    }
}

/// Whether the centre of a block lies inside a cavity with this centre; the block may lie beyond a periodic edge.
type IsInside = Box<dyn Fn([isize; 2]) -> bool>;

/// Eq. 17 as printed, for one cavity: the formula of an ellipse, or the crossings of a polygon of 4096 vertices with the row of
/// the block, of which an odd number lies left of its centre.
fn inside(cavity: &Cavity, [x, y]: [f64; 2], rows: std::ops::Range<isize>) -> IsInside {
    let Cavity { lambda, w, .. } = *cavity;
    let s = f64::from(cavity.s);
    let axis = Drive::at_angle(1.0, cavity.rotate).direction;
    let swap = |p: [f64; 2]| if cavity.across { [p[1], p[0]] } else { p };
    if cavity.s == 1 || w == 0.0 {
        let [a, b] = if w == 0.0 {
            [lambda; 2]
        } else {
            swap([lambda * (1.0 + w), lambda * (1.0 - w)])
        };
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
        // The first block whose centre does not lie left of a crossing.
        let blocks = crossings[(row - first) as usize].iter().map(|x| (x - 0.5).ceil());
        blocks.filter(|block| *block <= column as f64).count() % 2 == 1
    })
}

/// The mask of all cavities of an array, and whether a free edge clips it.
fn by_the_letter(lattice: &Lattice, cavity: &Cavity) -> Vec<bool> {
    let blocks = [lattice.nx as isize, lattice.ny as isize];
    // As many sliders side by side as the farthest outline reaches.
    let range = |axis: usize| match lattice.edges[axis] {
        Edges::Free => 0..blocks[axis],
        Edges::Periodic => {
            let reach = cavity.center[axis].abs() as isize + blocks[axis] + 2 * cavity.lambda as isize + 3;
            let turns = reach / blocks[axis] + 1;
            -turns * blocks[axis]..(turns + 1) * blocks[axis]
        }
    };
    let (columns, rows) = (range(0), range(1));
    let place = |axis: usize, k: usize| {
        let count = cavity.array[axis] as f64;
        let spacing = blocks[axis] as f64 / count;
        cavity.center[axis] + spacing * (k as f64 - 0.5 * (count - 1.0))
    };
    let mut textured = vec![false; lattice.n_blocks()];
    for k in 0..cavity.array[0] * cavity.array[1] {
        let center = [place(0, k % cavity.array[0]), place(1, k / cavity.array[0])];
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

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn arrays_of_cavities_cover_what_each_of_them_covers(lattice in lattice_below(24), cavity in array()) {
        let meshed = mesh(&lattice, &[Texture::Cavity(cavity)]);
        let expected = by_the_letter(&lattice, &cavity);
        prop_assert_eq!(meshed.empty.is_empty(), expected.contains(&true));
        prop_assert_eq!(meshed.textured, expected);
    }
}
