//! Surfaces that several ranks create, each for its own rows, compared with the surface that one process
//! creates.

use proptest::prelude::*;
use slipfront::Surface;
use slipfront::communicator::Communicator;
use slipfront::surface::{Meshed, mesh, mesh_watched};
use slipfront::testing::Threads;

use crate::common::Slider;
use crate::{has_contact, slider};

/// The mesh and surface of a rank.
fn make(slider: &Slider, rank: &dyn Communicator) -> (Meshed, Surface) {
    let lattice = slider.lattice();
    let rows = lattice.rows_of(rank);
    let Ok(meshed) =
        mesh_watched::<std::convert::Infallible>(&lattice, &rows, &slider.textures, &mut |_| Ok(()));
    let coefficients = slider.coefficients_of(lattice.blocks_of(&rows));
    let textured = meshed.textured.clone();
    let surface = Surface::of_ranks(coefficients, textured, slider.contact(rows), &slider.body, rank);
    (meshed, surface.unwrap())
}

/// Values for the whole surface.
fn numbers(surface: &Surface) -> ([usize; 2], [u64; 5]) {
    let numbers = [
        surface.texture_percent(),
        surface.min_slip_threshold(),
        surface.mean_kinetic_force(),
        surface.mean_static_coefficient(),
        surface.mean_kinetic_coefficient(),
    ];
    let counts = [surface.n_contact(), surface.negative_draws()];
    (counts, numbers.map(f64::to_bits))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn ranks_make_the_surface_that_one_process_makes(slider in slider()) {
        prop_assume!(has_contact(&slider));
        let (meshed, whole) = (mesh(&slider.lattice(), &slider.textures), slider.surface());
        for size in [1, 2, 3, 4, 7].into_iter().filter(|size| *size <= slider.blocks[1]) {
            let made = Threads::run(size, |rank| make(&slider, rank));
            let surfaces = || made.iter().map(|(_, surface)| surface);
            for value in [Surface::normal_force, Surface::static_limit, Surface::kinetic_force] {
                let all = |surface: &Surface| -> Vec<u64> { (0..surface.n_blocks()).map(|b| value(surface, b).to_bits()).collect() };
                let joined: Vec<u64> = surfaces().flat_map(all).collect();
                prop_assert_eq!(joined, all(&whole));
            }
            let textured: Vec<bool> = surfaces().flat_map(|surface| &surface.textured).copied().collect();
            prop_assert_eq!(&textured, &whole.textured);
            for (rank, (part, surface)) in made.iter().enumerate() {
                prop_assert_eq!(numbers(surface), numbers(&whole), "rank {} of {}", rank, size);
                prop_assert_eq!(&part.clipped, &meshed.clipped);
            }
            // A texture covers nothing if it covers no rows of any rank.
            let covers_nothing = |texture: &usize| made.iter().all(|(part, _)| part.empty.contains(texture));
            let empty: Vec<usize> = (0..slider.textures.len()).filter(covers_nothing).collect();
            prop_assert_eq!(&empty, &meshed.empty);
        }
    }

    #[test]
    fn numbers_of_the_surface_are_those_of_its_blocks(slider in slider()) {
        prop_assume!(has_contact(&slider));
        let surface = slider.surface();
        let n = surface.n_blocks();
        let in_contact = (0..n).filter(|&b| !surface.textured[b]);
        let thresholds = in_contact.map(|b| surface.static_limit(b).max(surface.kinetic_force(b)));
        prop_assert_eq!(surface.min_slip_threshold(), thresholds.fold(f64::INFINITY, f64::min));
        let mean = (0..n).map(|b| surface.kinetic_force(b)).sum::<f64>() / n as f64;
        let largest = (0..n).map(|b| surface.kinetic_force(b)).fold(0.0, f64::max);
        // Each of n terms is rounded by 2^-51 of the largest, and each of n plain additions by 2^-53 of a sum
        // of at most n.
        let bound = largest * (2f64.powi(-50) + n as f64 * 2f64.powi(-52));
        prop_assert!((surface.mean_kinetic_force() - mean).abs() <= bound);
    }
}
