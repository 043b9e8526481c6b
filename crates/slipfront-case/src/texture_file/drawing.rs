//! The outlines of the textures of a case, layer by layer.

use slipfront::surface::{Contour, Texture, contours, copies_overlap, mask_outline, mesh};

use super::error::TextureFileError;
use super::textured_blocks::textured_blocks;
use crate::case::Case;

/// Largest number of corners of all outlines: a file of about a gigabyte.
const MAX_CORNERS: usize = 1 << 24;

/// The outlines of a texture, or of all.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlineDrawing {
    /// Width and height of the slider, in blocks.
    pub size: [usize; 2],
    /// Edge of a block, mm.
    pub block: f64,
    /// Outlines in blocks, a layer for each texture; a block is textured if any layer fills it.
    pub layers: Vec<Layer>,
    /// Notes about the drawing.
    pub notes: Vec<String>,
}

/// Outlines that are filled together.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Name of the layer: that of a texture, counted from 1.
    pub name: String,
    /// Filling of the outlines.
    pub fill: Fill,
    /// Outlines of the layer.
    pub contours: Vec<Contour>,
}

/// Filling of outlines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    /// The points inside any of the outlines.
    Each,
    /// The points inside an odd number of the outlines.
    EvenOdd,
}

impl OutlineDrawing {
    /// The outlines of a case's textures.
    pub(super) fn of(case: &Case) -> Result<Self, TextureFileError> {
        let lattice = &case.model.lattice;
        let size = [lattice.nx, lattice.ny];
        let mut drawing = Self {
            size,
            block: case.scales.block_size * 1e3,
            layers: Vec::new(),
            notes: Vec::new(),
        };
        if (0..lattice.n_blocks()).any(|block| !case.model.slider().exists(block)) {
            let contours = block_edges(&textured_blocks(case), size);
            drawing.add("TEXTURE".to_owned(), Fill::EvenOdd, contours);
            let note = "the outlines are the edges of blocks, since the slider has an outline of its own";
            drawing.notes.push(note.to_owned());
            return Ok(drawing);
        }
        let textures = case.textures_in_blocks()?;
        let corners = textures.iter().map(corners).sum();
        if corners > MAX_CORNERS {
            let most = MAX_CORNERS;
            return Err(TextureFileError::TooManyCorners { corners, most });
        }
        for (texture, number) in textures.iter().zip(1..) {
            let name = format!("TEXTURE_{number}");
            let overlaps = texture.inverted && copies_overlap(lattice, texture);
            match contours(lattice, texture).filter(|_| !overlaps) {
                Some(contours) if !texture.inverted => drawing.add(name, Fill::Each, contours),
                Some(pillars) => {
                    let [x, y] = size.map(|blocks| blocks as f64);
                    let slider = Contour::Polygon(vec![[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]]);
                    let contours = std::iter::once(slider).chain(pillars).collect();
                    drawing.add(name, Fill::EvenOdd, contours);
                }
                None => {
                    let blocks = mesh(lattice, std::slice::from_ref(texture)).textured;
                    drawing.add(name, Fill::EvenOdd, block_edges(&blocks, size));
                    if overlaps {
                        drawing.notes.push(format!(
                            "the outlines of texture {number} are the edges of blocks, since its pillars overlap"
                        ));
                    }
                }
            }
        }
        Ok(drawing)
    }

    fn add(&mut self, name: String, fill: Fill, contours: Vec<Contour>) {
        let name = match fill {
            Fill::Each => name,
            Fill::EvenOdd => name + "_EVEN_ODD",
        };
        self.layers.push(Layer { name, fill, contours });
    }
}

/// Corners of all copies of a texture's shape.
fn corners(texture: &Texture) -> usize {
    let copies = texture.shape.n_copies(&texture.arrays);
    copies.saturating_mul(texture.shape.n_corners())
}

/// The lines around blocks that are textured, holes among them.
fn block_edges(textured: &[bool], [nx, ny]: [usize; 2]) -> Vec<Contour> {
    // A frame of other blocks closes the lines along the slider's edges.
    let mut framed = vec![false; (nx + 2) * (ny + 2)];
    for (row, blocks) in textured.chunks(nx).enumerate() {
        framed[(row + 1) * (nx + 2) + 1..][..nx].copy_from_slice(blocks);
    }
    let chains = mask_outline(&framed, nx + 2, ny + 2).into_iter();
    let closed = chains.map(|chain| {
        let corners = chain[1..].iter().map(|&(x, y)| [x as f64 - 1.0, y as f64 - 1.0]);
        Contour::Polygon(corners.collect())
    });
    closed.collect()
}
