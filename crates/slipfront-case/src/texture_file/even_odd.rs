//! Textures with outlines that the even-odd rule fills, as programs for lasers fill them.

use std::sync::Arc;

use slipfront::surface::{FillRule, Part, Shape, Texture, mesh};

use crate::case::Case;
use crate::case_file::CaseError;

/// The textures of a case in blocks. A drawing with outlines that the even-odd rule of all of them would fill
/// in the same way becomes one with that rule, or a polygon.
pub(super) fn textures(case: &Case) -> Result<Vec<Texture>, CaseError> {
    let lattice = &case.model.lattice;
    let mut textures = case.textures_in_blocks()?;
    for texture in &mut textures {
        let Shape::Drawing(parts) = &texture.shape else {
            continue;
        };
        let mut rings: Vec<_> = parts.iter().flat_map(|part| part.rings.iter().cloned()).collect();
        let shape = if rings.len() == 1 {
            Shape::Polygon(rings.remove(0))
        } else {
            let rule = FillRule::EvenOdd;
            Shape::Drawing(Arc::new(vec![Part { rings, rule }]))
        };
        let same = Texture {
            shape,
            ..texture.clone()
        };
        if mesh(lattice, std::slice::from_ref(&same)) == mesh(lattice, std::slice::from_ref(texture)) {
            *texture = same;
        }
    }
    Ok(textures)
}
