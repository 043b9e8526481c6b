//! The sliders whose runs have the same bits, however they are executed.

use slipfront::surface::Texture;
use slipfront::{Edges, State};

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

/// Textured blocks are seldom at rest; strains may need either series or the square root.
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

/// Between slips the whole slider is at rest, and during a slip most blocks are.
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

/// Blocks that are displaced at the start, a few of them with a velocity.
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
