//! Outlines of the textures of a case, layer by layer.

use slipfront::surface::{
    Contour, Ellipse, Shape, Texture, clip, contours, copies_overlap, mask_outline, mesh,
};

use super::error::TextureFileError;
use crate::case::Case;
use crate::case_file::Outline;

/// Largest number of corners of all outlines: they give a file of about a gigabyte.
const MAX_CORNERS: usize = 1 << 24;

/// Outlines of one or all textures of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlineDrawing {
    /// Width and height of the slider, in blocks.
    pub size: [usize; 2],
    /// Edge of a block, mm.
    pub block: f64,
    /// The edge of the slider, in blocks: one line, or several if it has holes or islands.
    pub slider: Vec<Contour>,
    /// Outlines in blocks, one layer per texture that has any; a block is textured if any layer fills it.
    pub layers: Vec<Layer>,
    /// Notes about the drawing.
    pub notes: Vec<String>,
}

/// Outlines that are filled together.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Name of the layer: that of its texture, counted from 1.
    pub name: String,
    /// Fill rule of the outlines.
    pub fill: Fill,
    /// Outlines of the layer.
    pub contours: Vec<Contour>,
}

/// Fill rule of outlines.
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
            slider: edge(case, size),
            layers: Vec::new(),
            notes: Vec::new(),
        };
        let textures = case.textures_in_blocks()?;
        let corners = textures.iter().map(corners).sum();
        if corners > MAX_CORNERS {
            let most = MAX_CORNERS;
            return Err(TextureFileError::TooManyCorners { corners, most });
        }
        for (texture, number) in textures.iter().zip(1..) {
            let name = format!("TEXTURE_{number}");
            let parts = |shape: &Contour| clip(shape, &drawing.slider);
            let shapes: Option<Vec<Vec<Contour>>> =
                contours(lattice, texture).map(|shapes| shapes.iter().map(parts).collect());
            // Parts of one shape may enclose each other, if it crosses itself or the slider has holes.
            let may_nest = matches!(texture.shape, Shape::Polygon(_)) || drawing.slider.len() > 1;
            let nests = may_nest && shapes.iter().flatten().any(|parts| parts.len() > 1);
            let is_even_odd = texture.inverted || nests;
            let overlaps = is_even_odd && copies_overlap(lattice, texture);
            match shapes.filter(|_| !overlaps) {
                Some(shapes) if !is_even_odd => drawing.add(name, Fill::Each, shapes.concat()),
                Some(mut shapes) => {
                    if texture.inverted {
                        shapes.push(drawing.slider.clone());
                    }
                    drawing.add(name, Fill::EvenOdd, shapes.concat());
                }
                None => {
                    let blocks = mesh(lattice, std::slice::from_ref(texture)).textured;
                    let edges = block_edges(&blocks, size);
                    drawing.add(name, Fill::EvenOdd, edges.iter().flat_map(parts).collect());
                    if overlaps {
                        drawing.notes.push(format!(
                            "the outlines of texture {number} are the edges of blocks, since its copies overlap and are filled together"
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
        if !contours.is_empty() {
            self.layers.push(Layer { name, fill, contours });
        }
    }
}

/// The edge of the slider.
fn edge(case: &Case, size: [usize; 2]) -> Vec<Contour> {
    let [x, y] = size.map(|blocks| blocks as f64);
    match case.file.slider.outline {
        Outline::Rectangle => vec![Contour::rectangle([0.0, 0.0], [x, y])],
        Outline::Disc => vec![Contour::Ellipse(Ellipse {
            center: [0.5 * x, 0.5 * y],
            semi_axes: [0.5 * x.min(y); 2],
            axis: [1.0, 0.0],
        })],
        Outline::Mask => {
            let exists = (0..size[0] * size[1]).map(|block| case.model.slider().exists(block));
            block_edges(&exists.collect::<Vec<bool>>(), size)
        }
    }
}

/// Corners of all copies of a texture's shape.
fn corners(texture: &Texture) -> usize {
    let copies = texture.shape.n_copies(&texture.arrays);
    copies.saturating_mul(texture.shape.n_corners())
}

/// Lines around the chosen blocks, including the edges of holes.
fn block_edges(chosen: &[bool], [nx, ny]: [usize; 2]) -> Vec<Contour> {
    // A frame of unchosen blocks closes the lines along the slider's edges.
    let mut framed = vec![false; (nx + 2) * (ny + 2)];
    for (row, blocks) in chosen.chunks(nx).enumerate() {
        framed[(row + 1) * (nx + 2) + 1..][..nx].copy_from_slice(blocks);
    }
    let chains = mask_outline(&framed, nx + 2, ny + 2).into_iter();
    let closed = chains.map(|chain| {
        let corners = chain[1..].iter().map(|&(x, y)| [x as f64 - 1.0, y as f64 - 1.0]);
        Contour::Polygon(corners.collect())
    });
    closed.collect()
}
