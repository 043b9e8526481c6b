//! Openings of sets of blocks by squares, their widths and their pieces.

use proptest::prelude::*;
use slipfront::{Edges, Lattice, block_sets};

/// The definition of an opening, square by square.
fn opened_by_squares(lattice: &Lattice, set: &[bool], side: usize) -> Vec<bool> {
    let Lattice { nx, ny, edges } = *lattice;
    let mut found = vec![false; set.len()];
    for y in 0..ny {
        for x in 0..nx {
            if (edges[0] == Edges::Free && x + side > nx) || (edges[1] == Edges::Free && y + side > ny) {
                continue;
            }
            let square: Vec<usize> = (0..side * side)
                .map(|k| (y + k / side) % ny * nx + (x + k % side) % nx)
                .collect();
            if square.iter().all(|&block| set[block]) {
                for block in square {
                    found[block] = true;
                }
            }
        }
    }
    found
}

proptest! {
    #[test]
    fn an_opening_is_the_union_of_its_squares(
        (lattice, set) in ([3_usize..11, 3_usize..11], super::edges()).prop_flat_map(|([nx, ny], edges)| {
            let set = prop::collection::vec(prop::bool::weighted(0.8), nx * ny);
            (Just(Lattice::with_edges(nx, ny, edges)), set)
        }),
        side in 1_usize..6,
    ) {
        let expected = if side > lattice.nx.min(lattice.ny) {
            vec![false; set.len()]
        } else {
            opened_by_squares(&lattice, &set, side)
        };
        prop_assert_eq!(block_sets::opened(&lattice, &set, side), expected);
    }
}

/// A set drawn with `#`, the largest y first.
fn drawn<const N: usize>(rows: [&str; N]) -> Vec<bool> {
    let rows = rows.iter().rev();
    rows.flat_map(|row| row.bytes().map(|byte| byte == b'#'))
        .collect()
}

/// A strip of one block along an edge is one block wide, whatever lies beyond the edge.
#[test]
fn slivers_at_edges_are_seen() {
    let lattice = Lattice::free(5, 5);
    let set = drawn(["#....", "#....", "#.###", "#.###", "#.###"]);
    assert_eq!(block_sets::width(&lattice, &set), Some(1));
    assert_eq!(block_sets::n_pieces(&lattice, &set), 2);
    let opened = block_sets::opened(&lattice, &set, 3);
    assert_eq!(opened, drawn([".....", ".....", "..###", "..###", "..###"]));
    assert_eq!(block_sets::width(&lattice, &opened), Some(3));
    // Around a periodic axis, the strip is a part of the set at the opposite edge.
    let around = Lattice::with_edges(5, 3, [Edges::Periodic, Edges::Free]);
    let set = drawn(["##..#"; 3]);
    assert_eq!(
        (
            block_sets::width(&around, &set),
            block_sets::n_pieces(&around, &set)
        ),
        (Some(3), 1)
    );
    assert_eq!(block_sets::width(&around, &[false; 15]), None);
}
