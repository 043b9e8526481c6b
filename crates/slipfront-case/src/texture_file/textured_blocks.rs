//! The textured blocks of a case.

use crate::case::Case;
use crate::case_file::FrictionAlong;

/// Whether each block is textured: blocks that do not exist, or stand above the lowest row of an upright
/// sheet, have no contact either, but are no texture.
pub fn textured_blocks(case: &Case) -> Vec<bool> {
    let (model, along) = (&case.model, case.file.friction.along);
    let faces = |b: usize| along == FrictionAlong::Plane || b < model.lattice.nx;
    let blocks = model.surface.textured.iter().enumerate();
    blocks
        .map(|(b, textured)| *textured && faces(b) && model.slider().exists(b))
        .collect()
}
