//! A Gwyddion simple field: a header of lines, and the heights as 32-bit numbers, the top row first.

use super::textured_blocks::textured_blocks;
use crate::case::Case;

/// The height of the blocks, without a unit: 1 for blocks in contact, 0 for textured ones.
pub(super) fn field(case: &Case) -> Vec<u8> {
    let (nx, ny) = (case.model.lattice.nx, case.model.lattice.ny);
    let length = |blocks: usize| blocks as f64 * case.scales.block_size;
    let mut bytes = format!(
        "Gwyddion Simple Field 1.0\nXRes = {nx}\nYRes = {ny}\nXReal = {:e}\nYReal = {:e}\nXYUnits = m\nTitle = Contact\n",
        length(nx),
        length(ny)
    )
    .into_bytes();
    // Pads with one to four zeros, so that the numbers begin at a multiple of four.
    bytes.resize(bytes.len() / 4 * 4 + 4, 0);
    for row in textured_blocks(case).chunks(nx).rev() {
        for textured in row {
            let height: f32 = if *textured { 0.0 } else { 1.0 };
            bytes.extend(height.to_le_bytes());
        }
    }
    bytes
}
