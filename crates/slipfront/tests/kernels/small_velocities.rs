//! Velocities so small that their squares would be subnormal numbers are zero, in both kernels and in every
//! way to execute them.

use slipfront::surface::Orientation;
use slipfront::testing::FusedKernel;
use slipfront::{Execution, Simulation};
use test_case::{test_case, test_matrix};

use crate::common::{Slider, groove};
use crate::{executions, fused, general, ranks};

/// Least component of a velocity, 2^-480: no smaller one but zero occurs.
const SMALLEST: f64 = 3.203_806_5e-145;

/// Number of steps in which a wave from an edge travels so far into the groove that its velocities would
/// underflow.
const STEPS: u64 = 130;

/// A wide groove with blocks that oscillate on their drive springs: waves run into it from its edges and from
/// the corners of the slider; only the corners move blocks across the drive.
fn grooved(degrees: f64) -> Slider {
    Slider {
        blocks: [280, 12],
        textures: vec![groove(Orientation::Across, 240.0)],
        // So fast that the blocks at its edges slip before the wave has crossed it.
        v_star: 1.0,
        degrees,
        ..Slider::default()
    }
}

#[test_case(fused(); "fused")]
#[test_case(general(); "general")]
fn no_velocity_is_subnormal(execution: Execution) {
    let mut simulation = Simulation::new(grooved(0.0).model(), 0.1, None, execution);
    let mut least = f64::INFINITY;
    for _ in 0..STEPS {
        simulation.step();
        let state = simulation.state();
        for velocity in state.velocity.y.iter().filter(|velocity| **velocity != 0.0) {
            least = least.min(velocity.abs());
        }
        // A step moves a block by a tenth of its velocity, and the next may take back most of it.
        let displacement = state.displacement.y.iter().filter(|u| **u != 0.0);
        displacement.for_each(|u| assert!(u.abs() >= 1e-4 * SMALLEST, "{u:e}"));
    }
    // The front has reached the bound, but no smaller values; without the bound it would reach 1e-308.
    assert!((SMALLEST..1e3 * SMALLEST).contains(&least), "{least:e}");
}

#[test_matrix([0.0, 30.0])]
fn executions_and_ranks_give_the_same_bits(degrees: f64) {
    let slider = grooved(degrees);
    executions::assert_same_bits(&slider.model(), 0.1, None, STEPS);
    ranks::assert_same(&slider, None, STEPS);
}

#[test]
fn every_vector_width_gives_the_same_bits() {
    let model = grooved(0.0).model();
    let motions = |width| {
        let mut kernel = FusedKernel::new(model.clone(), 0.1, None, true, Some(width));
        (0..STEPS).for_each(|_| {
            kernel.step(false);
        });
        let motion = |b| kernel.motion(b).map(|vector| vector.map(f64::to_bits));
        (0..model.lattice.n_blocks()).map(motion).collect::<Vec<_>>()
    };
    let narrowest = motions(0);
    (1..FusedKernel::n_widths()).for_each(|width| assert!(motions(width) == narrowest, "width {width}"));
}
