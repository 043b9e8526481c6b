//! Sliders with runs that must have the same bits in every way to execute them.

use std::sync::Arc;

use slipfront::surface::Texture;
use slipfront::{Edges, Loading, Program, SlipWeakening, State};

use crate::common::{self, Slider};

/// A lattice of any shape.
pub(crate) fn shaped(blocks: [usize; 2], edges: [Edges; 2]) -> Slider {
    Slider {
        blocks,
        edges,
        degrees: 25.0,
        v_star: 0.1,
        sigma_static_star: 0.1,
        dt_star: 0.2,
        ..Slider::default()
    }
}

/// A slider with textured blocks, which are rarely at rest; strains may need either series or the square
/// root.
pub(crate) fn textured(texture: Option<Texture>, epsilon: f64) -> Slider {
    Slider {
        blocks: [40, 40],
        edges: [Edges::Periodic, Edges::Free],
        textures: texture.into_iter().collect(),
        epsilon,
        v_star: 0.1,
        dt_star: 0.2,
        ..Slider::default()
    }
}

/// A slider that is wholly at rest between slips, and mostly during a slip.
pub(crate) fn slow(blocks: [usize; 2], edges: Edges, degrees: f64, epsilon: f64) -> Slider {
    Slider {
        blocks,
        edges: [edges; 2],
        degrees,
        epsilon,
        v_star: 0.004,
        dt_star: 0.5,
        sigma_static_star: 0.1,
        ..Slider::default()
    }
}

/// A slider with a drive that stands still while blocks slip; with a program the drive moves back and forth.
pub(crate) fn held(blocks: [usize; 2], edges: Edges, degrees: f64, has_program: bool) -> Slider {
    let program = || Program::new([(0.06, 40.0), (-0.03, 60.0), (0.1, f64::INFINITY)]);
    Slider {
        v_star: 0.1,
        program: has_program.then(|| Arc::new(program())),
        loading: Loading::Held { onset_steps: 30 },
        ..slow(blocks, edges, degrees, 1e-6)
    }
}

/// Under a held drive and with strong damping, blocks with strength that falls with slip but with stable
/// slip: they creep forever, so that the residual force decides when the drive moves on.
pub(crate) fn creeping() -> Slider {
    Slider {
        blocks: [12, 10],
        omega_star: 2.0,
        slip_weakening: Some(SlipWeakening {
            length: 2.0,
            healing_time: None,
        }),
        v_star: 0.1,
        dt_star: 0.8,
        loading: Loading::Held { onset_steps: 90 },
        ..Slider::default()
    }
}

/// Blocks displaced at the start, a few of them with a velocity.
pub(crate) fn in_motion(edges: [Edges; 2], epsilon: f64) -> (Slider, State) {
    let slider = Slider {
        blocks: [17, 90],
        edges,
        epsilon,
        degrees: 200.0,
        ..Slider::default()
    };
    (slider, common::thrown(1530, 0.1, 400))
}
