//! The textured blocks of a case.

use crate::case::Case;

/// Whether each block is textured: a block that does not exist has no contact either, but is no texture.
pub fn textured_blocks(case: &Case) -> Vec<bool> {
    let (surface, slider) = (&case.model.surface, case.model.slider());
    let blocks = surface.textured.iter().enumerate();
    blocks
        .map(|(b, textured)| *textured && slider.exists(b))
        .collect()
}
