//! The face of a slider as a closed solid in binary STL, in millimetres: blocks in contact end at z = 0,
//! textured ones at the depth of the texture below. The back is as far below these. Upper corners of blocks
//! that touch only along an edge are a little apart.

use super::error::TextureFileError;
use super::textured_blocks::textured_blocks;
use crate::case::Case;

/// Largest number of triangles: a file of 400 MB.
const MAX_TRIANGLES: usize = 1 << 23;

/// Shift, in blocks, of a corner at which a block would touch another one along a single edge: a closed
/// surface has two faces at an edge, not four.
const APART: f64 = 1.0 / 256.0;

/// The solid, with a texture of this depth in m.
pub(super) fn solid(case: &Case, depth: f64) -> Result<Vec<u8>, TextureFileError> {
    let lattice = &case.model.lattice;
    let (nx, ny) = (lattice.nx, lattice.ny);
    let textured = textured_blocks(case);
    // Level of the face of a block, in depths above the back, where it is 0 if there is no block.
    let level = |x: usize, y: usize| {
        // Indices begin at 1, so that there are some around the lattice.
        let is_on = (1..=nx).contains(&x) && (1..=ny).contains(&y);
        let block = is_on.then(|| (y - 1) * nx + x - 1);
        let block = block.filter(|&block| case.model.slider().exists(block));
        block.map_or(0, |block| if textured[block] { 1 } else { 2 })
    };
    let mut mesh = Mesh {
        bytes: vec![0; 84],
        lengths: [1e3 * case.scales.block_size, 1e3 * depth],
    };
    for y in 1..=ny {
        for x in 1..=nx {
            let top = level(x, y);
            if top == 0 {
                continue;
            }
            let square = |z: usize| {
                [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]: [usize; 2]| {
                    // The neighbours at this corner: indices at the block's end plus or minus one.
                    let [beside, above] = [x + 2 * i - 1, y + 2 * j - 1];
                    let touches =
                        z > 0 && level(beside, above) >= z && level(beside, y) < z && level(x, above) < z;
                    let inwards = if touches { APART } else { 0.0 };
                    let along =
                        |at: usize, end: usize| (at + end - 1) as f64 + inwards * (1.0 - 2.0 * end as f64);
                    [along(x, i), along(y, j), z as f64]
                })
            };
            let [a, b, c, d] = square(0);
            mesh.quad([a, d, c, b], [0.0, 0.0, -1.0]);
            mesh.quad(square(top), [0.0, 0.0, 1.0]);
            let sides = [
                (level(x, y - 1), [0, 1], [0.0, -1.0, 0.0]),
                (level(x + 1, y), [1, 2], [1.0, 0.0, 0.0]),
                (level(x, y + 1), [2, 3], [0.0, 1.0, 0.0]),
                (level(x - 1, y), [3, 0], [-1.0, 0.0, 0.0]),
            ];
            for (neighbour, [from, to], normal) in sides {
                // One wall for each depth, so that the walls of neighbours have the same corners.
                for z in neighbour..top {
                    let ([low, high], [p, q]) = ([square(z), square(z + 1)], [from, to]);
                    mesh.quad([low[p], low[q], high[q], high[p]], normal);
                }
            }
            let triangles = mesh.triangles();
            if triangles > MAX_TRIANGLES {
                let most = MAX_TRIANGLES;
                return Err(TextureFileError::TooManyTriangles { most });
            }
        }
    }
    let count = mesh.triangles() as u32;
    mesh.bytes[80..84].copy_from_slice(&count.to_le_bytes());
    Ok(mesh.bytes)
}

struct Mesh {
    /// A header of 80 bytes, the number of triangles, and 50 bytes for each.
    bytes: Vec<u8>,
    /// Edge of a block and depth of the texture, mm.
    lengths: [f64; 2],
}

impl Mesh {
    fn triangles(&self) -> usize {
        (self.bytes.len() - 84) / 50
    }

    /// Adds a rectangle of corners in blocks and depths, counterclockwise as seen from outside.
    fn quad(&mut self, corners: [[f64; 3]; 4], normal: [f32; 3]) {
        let [block, depth] = self.lengths;
        let corner =
            |[x, y, z]: [f64; 3]| [x * block, y * block, (z - 2.0) * depth].map(|length| length as f32);
        for triangle in [[0, 1, 2], [0, 2, 3]] {
            let vectors = std::iter::once(normal).chain(triangle.map(|at| corner(corners[at])));
            for number in vectors.flatten() {
                self.bytes.extend(number.to_le_bytes());
            }
            self.bytes.extend([0; 2]);
        }
    }
}
