//! The load of textured blocks that nearby blocks in contact take, compared with plain loops.

use proptest::prelude::*;
use slipfront::communicator::Alone;
use slipfront::surface::share_load;
use slipfront::testing::Threads;
use slipfront::{Communicator, Edges, Lattice, SurfaceError};

use crate::lattice;

/// Square of the distance between two blocks, the least distance on a periodic axis.
fn distance_square(lattice: &Lattice, a: usize, b: usize) -> usize {
    let (ia, ja) = lattice.column_row(a);
    let (ib, jb) = lattice.column_row(b);
    let along = |from: usize, to: usize, axis: usize| {
        let apart = from.abs_diff(to);
        match lattice.edges[axis] {
            Edges::Free => apart,
            Edges::Periodic => apart.min([lattice.nx, lattice.ny][axis] - apart),
        }
    };
    along(ia, ib, 0).pow(2) + along(ja, jb, 1).pow(2)
}

/// Load of every block in contact, 0 for other blocks; none if a textured block has no block in contact near
/// it.
fn plainly(
    lattice: &Lattice,
    textured: &[bool],
    exists: &[bool],
    pressure: &[f64],
    distance: f64,
) -> Option<Vec<f64>> {
    let n = lattice.n_blocks();
    let is_in_contact = |b: usize| exists[b] && !textured[b];
    let mut loads: Vec<f64> = (0..n)
        .map(|b| if is_in_contact(b) { pressure[b] } else { 0.0 })
        .collect();
    for j in (0..n).filter(|&j| textured[j] && exists[j]) {
        let near =
            |i: &usize| is_in_contact(*i) && distance_square(lattice, *i, j) as f64 <= distance * distance;
        let near: Vec<usize> = (0..n).filter(near).collect();
        if near.is_empty() {
            return None;
        }
        near.iter()
            .for_each(|&i| loads[i] += pressure[j] / near.len() as f64);
    }
    Some(loads)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn load_goes_to_the_blocks_near(
        lattice in lattice(),
        marks in prop::collection::vec((any::<bool>(), prop::bool::weighted(0.9), 0.1..3.0_f64), 14 * 14),
        distance in 1.0..20.0_f64,
        is_even in any::<bool>(),
        ranks in 1..4_usize,
    ) {
        let n = lattice.n_blocks();
        let exists: Vec<bool> = marks[..n].iter().map(|(_, exists, _)| *exists).collect();
        // Meshes do not know of outlines: a block outside may be textured or not.
        let textured: Vec<bool> = marks[..n].iter().map(|(textured, ..)| *textured).collect();
        let is_in_contact = |b: usize| exists[b] && !textured[b];
        let pressure: Vec<f64> = marks[..n].iter().map(|(.., p)| if is_even { 1.0 } else { *p }).collect();
        prop_assume!((0..n).any(is_in_contact));
        let share = |ranks: &dyn Communicator| {
            let rows = lattice.rows_of(ranks);
            let own = lattice.blocks_of(&rows);
            let given = (!is_even).then(|| pressure[own.clone()].to_vec());
            share_load(&lattice, &rows, &textured[own.clone()], Some(&exists[own]), given, distance, ranks)
        };
        let found = share(&Alone);
        let Some(expected) = plainly(&lattice, &textured, &exists, &pressure, distance) else {
            let is_refused = matches!(found, Err(SurfaceError::NoContactNear { .. }));
            prop_assert!(is_refused, "{:?}", found);
            return Ok(());
        };
        let found = found.unwrap();
        // Sums of loads over the factor of equal sharing.
        let sum = |of: &dyn Fn(usize) -> bool| (0..n).filter(|&b| of(b)).map(|b| pressure[b]).sum::<f64>();
        let factor = sum(&|b| exists[b]) / sum(&is_in_contact);
        for b in 0..n {
            let load = if is_in_contact(b) { expected[b] / factor } else { pressure[b] };
            // Each load is rounded, and so is each of at most 14 x 14 shares, to 2^-62 of the largest row.
            prop_assert!((found[b] - load).abs() < 1e-12 * load, "{} {}", found[b], load);
        }
        if ranks <= lattice.ny {
            let parts = Threads::run(ranks, |rank| share(rank).unwrap());
            let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            prop_assert_eq!(bits(&parts.concat()), bits(&found));
        }
    }
}
