//! The textured blocks of a case.

use crate::case::Case;
use crate::case_file::FrictionAlong;

/// Whether each block is textured. Blocks that do not exist, and blocks above the lowest row of an upright
/// sheet, have no contact either, but do not count as texture.
pub fn textured_blocks(case: &Case) -> Vec<bool> {
    let (model, along) = (&case.model, case.file.friction.along);
    let faces = |b: usize| along == FrictionAlong::Plane || b < model.lattice.nx;
    let blocks = model.surface.textured.iter().enumerate();
    blocks
        .map(|(b, textured)| *textured && faces(b) && model.slider().exists(b))
        .collect()
}
