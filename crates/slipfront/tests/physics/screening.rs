//! The mount: the distance over which it screens a local change of stress.

use std::sync::Arc;

use slipfront::lattice::{K_DIAGONAL, K_STRAIGHT};
use slipfront::{Edges, Program, Surface};
use test_case::test_matrix;

use crate::common::{Slider, at_rest};

/// One column in contact, which does not slip, and textured blocks on both sides, which the mount pulls
/// along. When the drive has stopped and everything is at rest, `D = X - u` of the mount decays from the
/// column as `cosh` towards the free ends, with
///
/// ```text
/// 2 cosh(kappa) - 2 = k_s/K_el
/// ```
///
/// for a chain and for a strip that is periodic across the drive.
#[test_matrix([(1, Edges::Free, K_STRAIGHT), (4, Edges::Periodic, K_STRAIGHT + K_DIAGONAL)], [0.375, 0.02])]
fn what_is_held_is_felt_over_the_screening_length(
    (ny, across, stiffness): (usize, Edges, f64),
    k_drive: f64,
) {
    let (nx, held) = (41, 15);
    let (speed, until) = (1e-3, 100.0);
    let slider = Slider {
        blocks: [nx, ny],
        edges: [Edges::Free, across],
        omega_star: 1.0,
        // Springs that are linear to 1e-12.
        epsilon: 1e-12,
        program: Some(Arc::new(Program::new([(speed, until), (0.0, f64::INFINITY)]))),
        ..Slider::default()
    };
    let mut model = slider.model();
    let textured = (0..nx * ny).map(|b| b % nx != held).collect();
    model.surface = Surface::new(slider.coefficients(), textured, slider.load, 1.0).unwrap();
    model.drive.k_drive = k_drive;
    let mut simulation = at_rest(&model, 0.1);
    // The slowest motion decays at least as exp(-2 k_s t/Omega), here to below e^-40.
    while simulation.snapshot().time_star < until + 1500.0 {
        simulation.step();
    }
    let now = simulation.snapshot();
    assert_eq!(now.totals.n_slipping, 0);
    let kappa = (1.0 + 0.5 * k_drive / stiffness).acosh();
    for b in 0..nx * ny {
        let i = b % nx;
        let from_end = |i: usize, end: usize| i.abs_diff(end) as f64 + 0.5;
        let end = if i < held { 0 } else { nx - 1 };
        let expected =
            speed * until * (kappa * from_end(i, end)).cosh() / (kappa * from_end(held, end)).cosh();
        let found = speed * until - now.block(b).displacement[0];
        // Rounding of displacements of 0.1.
        assert!((found - expected).abs() < 1e-12, "{i}: {found}, exact {expected}");
    }
    // The length is that of the continuum if it is many blocks.
    let [along, _] = model.drive.screening_lengths(&model.lattice);
    let of_chain = if ny == 1 {
        along
    } else {
        (stiffness / k_drive).sqrt()
    };
    assert!((1.0 / kappa / of_chain - 1.0).abs() < 0.05, "{along}");
}
