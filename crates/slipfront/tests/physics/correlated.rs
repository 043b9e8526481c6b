//! Correlated coefficients: one physical slider on finer and finer blocks.

use slipfront::lattice::K_DIAGONAL;
use slipfront::surface::{Coefficients, CorrelatedField, Distribution, Load};
use slipfront::{SlipWeakening, Surface};

use crate::common::{Slider, at_rest};

/// Spread of the coefficients on 50 x 50 blocks, or at a point.
const SIGMA: f64 = 0.1;

/// Method of drawing the coefficients of finer blocks.
#[derive(Clone, Copy)]
enum Draw {
    /// By block, with the spread that keeps that of means over areas: in proportion to the number of blocks
    /// along a side.
    ByBlock,
    /// Coefficients correlated over this share of the slider.
    Alike(f64),
}

/// mu_s* of one physical slider on `n` x `n` blocks: the mount per area, damping and speed in SI units and
/// the length of weakening are those of 50 x 50 blocks.
fn static_friction(n: usize, draw: Draw, seed: u64) -> f64 {
    let finer = n as f64 / 50.0;
    let by_block = matches!(draw, Draw::ByBlock);
    let slider = Slider {
        blocks: [n, n],
        sigma_static_star: if by_block { SIGMA * finer } else { SIGMA },
        sigma_kinetic_star: 0.0,
        omega_star: 0.1 / finer,
        v_star: 0.01 * finer,
        dt_star: 0.2,
        slip_weakening: Some(SlipWeakening {
            length: 0.6 * finer * finer,
            healing_time: None,
        }),
        seed,
        ..Slider::default()
    };
    let mut model = slider.model();
    model.drive.k_drive = K_DIAGONAL / (finer * finer);
    if let Draw::Alike(share) = draw {
        let gauss = |mean: f64, deviation: f64| Distribution { mean, deviation };
        let field = CorrelatedField::new(&slider.lattice(), share * n as f64);
        let drawn = Coefficients::draw_correlated(&field, &(0..n), gauss(1.0, SIGMA), gauss(0.5, 0.0), seed);
        model.surface = Surface::new(drawn, vec![false; n * n], Load::Redistributed, 1.0).unwrap();
    }
    let mut simulation = at_rest(&model, slider.dt_star);
    while !simulation.snapshot().peak.ended {
        simulation.step();
    }
    simulation.snapshot().peak.mu_star
}

/// With coefficients correlated over a tenth of the slider, finer blocks do not change static friction: means
/// over blocks, springs and weakening are of second order in the size of a block, so that its changes fall to
/// a quarter. With coefficients drawn by block it keeps changing, although their means over areas scatter
/// equally on all blocks.
#[test]
fn static_friction_of_correlated_coefficients_converges() {
    let changes = |draw: Draw| {
        let [coarse, middle, fine] = [50, 100, 200].map(|n| static_friction(n, draw, 1));
        [middle - coarse, fine - middle].map(f64::abs)
    };
    let [alike, by_block] = [Draw::Alike(0.1), Draw::ByBlock].map(changes);
    // Halfway between a quarter, for second order, and no convergence.
    assert!(alike[1] < 0.5 * alike[0] && alike[0] < 1e-3, "{alike:?}");
    // A hundred times the last change of the correlated case.
    assert!(by_block[1] > by_block[0] && by_block[1] > 0.01, "{by_block:?}");
}
