//! Outlines of the textures of a case, layer by layer.

use slipfront::surface::{
    Contour, Ellipse, Shape, Texture, clip, contours, copies_overlap, mask_outline, mesh,
};

use super::error::TextureFileError;
use super::even_odd::textures;
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

/// Outlines whose inside the even-odd rule defines, as in programs for lasers.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Name of the layer: that of its texture, counted from 1.
    pub name: String,
    /// Number of its colour.
    pub color: usize,
    /// Whether some of the outlines may be holes of others.
    pub nests: bool,
    /// Outlines of the layer.
    pub contours: Vec<Contour>,
}

/// Colours of layers, each as it is written in SVG and in DXF: those that programs for lasers tell apart.
const COLORS: [(&str, u16); 7] = [
    ("#ff0000", 1),
    ("#0000ff", 5),
    ("#00ff00", 3),
    ("#ff00ff", 6),
    ("#00ffff", 4),
    ("#ff7f00", 30),
    ("#ffff00", 2),
];

impl Layer {
    /// Colour of the layer in SVG and in DXF.
    pub(super) fn color(&self) -> (&'static str, u16) {
        COLORS[self.color % COLORS.len()]
    }
}

impl OutlineDrawing {
    /// The outlines of a case's textures.
    pub(super) fn new(case: &Case) -> Result<Self, TextureFileError> {
        let lattice = &case.model.lattice;
        let size = [lattice.nx, lattice.ny];
        let mut drawing = Self {
            size,
            block: case.scales.block_size * 1e3,
            slider: edge(case, size),
            layers: Vec::new(),
            notes: Vec::new(),
        };
        let textures = textures(case)?;
        let corners = textures.iter().map(corners).sum();
        if corners > MAX_CORNERS {
            let most = MAX_CORNERS;
            return Err(TextureFileError::TooManyCorners { corners, most });
        }
        for (color, texture) in textures.iter().enumerate() {
            let number = color + 1;
            let parts = |shape: &Contour| clip(shape, &drawing.slider);
            let shapes: Option<Vec<Vec<Contour>>> =
                contours(lattice, texture).map(|shapes| shapes.iter().map(parts).collect());
            let overlaps = shapes.is_some() && copies_overlap(lattice, texture);
            let is_drawing = matches!(texture.shape, Shape::Drawing(_));
            let (contours, nests) = match shapes.filter(|_| !overlaps) {
                Some(mut shapes) => {
                    // Parts of one shape may enclose each other, if it crosses itself or the slider has
                    // holes.
                    let may_nest = matches!(texture.shape, Shape::Polygon(_)) || drawing.slider.len() > 1;
                    let nests = may_nest && shapes.iter().any(|parts| parts.len() > 1);
                    if texture.inverted {
                        shapes.push(drawing.slider.clone());
                    }
                    (shapes.concat(), nests || texture.inverted || is_drawing)
                }
                None => {
                    let blocks = mesh(lattice, std::slice::from_ref(texture)).textured;
                    let edges = block_edges(&blocks, size);
                    if overlaps || is_drawing {
                        let why = if overlaps { "copies" } else { "parts" };
                        drawing.notes.push(format!(
                            "the outlines of texture {number} are the edges of blocks, since its {why} may overlap, and lasers leave \
                             out what lies in two outlines"
                        ));
                    }
                    (edges.iter().flat_map(parts).collect(), true)
                }
            };
            if !contours.is_empty() {
                let name = format!("TEXTURE_{number}");
                drawing.layers.push(Layer {
                    name,
                    color,
                    nests,
                    contours,
                });
            }
        }
        if drawing.layers.len() > COLORS.len() {
            drawing.notes.push(format!(
                "the colours of layers repeat after {} textures: choose layers by name",
                COLORS.len()
            ));
        }
        Ok(drawing)
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
