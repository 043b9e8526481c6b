//! Textures: cavities, grooves, polygons and masks (Eqs. 15, 17, 18). Positions and sizes are in blocks.

use std::f64::consts::{PI, TAU};
use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::drawing::Part;
use super::outline::{Curve, Outlines, Ring, Vertex};
use super::pattern::{Array, Crossings, grids, n_copies};
use crate::lattice::Lattice;
use crate::vector_field::unit_vector;

/// A textured zone: the blocks inside the copies of one shape, or the blocks between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The shape.
    pub shape: Shape,
    /// Positions of the copies: every position of the first array contains the second array, and so on.
    /// Without an array there is only one copy.
    pub arrays: Vec<Array>,
    /// Whether all blocks except those inside the copies are textured: the shapes are pillars.
    pub inverted: bool,
}

impl From<Shape> for Texture {
    fn from(shape: Shape) -> Self {
        Self {
            shape,
            arrays: Vec::new(),
            inverted: false,
        }
    }
}

/// A shape with a textured inside, or with the outside textured.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// The closed curve of Eq. 17.
    Cavity(Cavity),
    /// A straight strip from edge to edge.
    Groove(Groove),
    /// Any polygon, by the even-odd rule; the copies are spread around its position.
    Polygon(Vec<[f64; 2]>),
    /// The union of parts, each of which is filled by its own rule; the copies are spread around their place.
    Drawing(Arc<Vec<Part>>),
    /// A mask, block by block; the copies are spread around the middle of the slider.
    Tile(Tile),
}

impl Shape {
    /// Number of copies of the shape that cover different places: copies of a groove next to each other
    /// count, copies along it do not.
    pub fn n_copies(&self, arrays: &[Array]) -> usize {
        match self {
            Self::Groove(groove) => groove.shifts(&grids(arrays)).len(),
            _ => n_copies(arrays),
        }
    }

    /// Distance from the origin up to which the shape reaches, in blocks, or somewhat more; 0 for a mask,
    /// which lies in the slider.
    pub fn reach(&self) -> f64 {
        let farthest = |lengths: &[f64]| lengths.iter().copied().map(f64::abs).fold(0.0, f64::max);
        match self {
            Self::Cavity(cavity) => farthest(&cavity.center) + 2.0 * cavity.lambda,
            Self::Groove(groove) => groove.offset.abs() + groove.width,
            Self::Polygon(points) => farthest(points.as_flattened()),
            Self::Drawing(parts) => {
                let rings = parts.iter().flat_map(|part| &part.rings);
                rings
                    .map(|ring| farthest(ring.as_flattened()))
                    .fold(0.0, f64::max)
            }
            Self::Tile(_) => 0.0,
        }
    }

    /// Largest number of corners of the outline of a copy; none for a mask.
    pub fn n_corners(&self) -> usize {
        match self {
            Self::Cavity(cavity) if cavity.s > 1 && cavity.w != 0.0 => OUTLINE_VERTICES,
            Self::Polygon(points) => points.len(),
            Self::Drawing(parts) => parts.iter().flat_map(|part| &part.rings).map(Vec::len).sum(),
            Self::Cavity(_) | Self::Groove(_) => 4,
            Self::Tile(_) => 0,
        }
    }
}

/// A mask, block by block.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// Number of blocks along x and along y.
    pub size: [usize; 2],
    /// The known rows of the mask: all, or for a mask that covers the lattice the meshed rows.
    pub rows: Range<usize>,
    /// Whether each block of the known rows is inside, row by row in ascending y; several textures may share
    /// a mask.
    pub blocks: Arc<Vec<bool>>,
}

impl Tile {
    /// First blocks of the copies of a mask of this size: blocks of the lattice, which may lie beyond its
    /// edges.
    pub fn starts(lattice: &Lattice, size: [usize; 2], arrays: &[Array]) -> Vec<[isize; 2]> {
        let places = |[columns, heights]: &Crossings| -> Vec<[f64; 2]> {
            let rows = heights.iter();
            rows.flat_map(|&y| columns.iter().map(move |&x| [x, y])).collect()
        };
        let places = grids(arrays).into_iter().flat_map(|grid| places(&grid));
        places.map(|place| Self::start(lattice, size, place)).collect()
    }

    /// First block of the copy that is shifted by `shift` from the middle: the block nearest to its position.
    pub(super) fn start(lattice: &Lattice, size: [usize; 2], shift: [f64; 2]) -> [isize; 2] {
        let lattice = [lattice.nx, lattice.ny];
        [0, 1].map(|axis| {
            let at = 0.5 * (lattice[axis] as f64 - size[axis] as f64) + shift[axis];
            (at + 0.5).floor() as isize
        })
    }
}

/// The cavity of Eq. 17 (Fig. 13):
///
/// ```text
/// x = x_0 + lambda (cos phi + w cos(s phi)),   y = y_0 + lambda (sin phi - w sin(s phi))
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cavity {
    /// Centre (x_0, y_0) of the cavity, or of its copies.
    pub center: [f64; 2],
    /// Size `lambda`.
    pub lambda: f64,
    /// Vertices less one: 1 makes ellipses, s > 1 semi-polygons of s + 1 edges.
    pub s: u32,
    /// Elongation (s = 1) or sharpness of the vertices; |w| <= 1/s, and |w| < 1 for s = 1.
    pub w: f64,
    /// Swaps x and y: elongated across the x axis.
    pub across: bool,
    /// Rotation in degrees from x towards y, after the swap.
    pub rotate: f64,
}

/// Size `lambda` of each of `count` cavities that together cover `percent` of `n_blocks` blocks (Eq. 18, D5):
///
/// ```text
/// lambda = sqrt(N A*/(100 pi (1 - s w^2)))
/// ```
///
/// ```
/// let lambda = slipfront::surface::cavity_lambda(10.0, 2500, 1, 0.0, 1);
/// assert!((std::f64::consts::PI * lambda * lambda - 250.0).abs() < 1e-9);
/// ```
pub fn cavity_lambda(percent: f64, n_blocks: usize, s: u32, w: f64, count: usize) -> f64 {
    (n_blocks as f64 * percent / (100.0 * count as f64 * PI * (1.0 - f64::from(s) * w * w))).sqrt()
}

/// Share of `n_blocks` blocks, in %, that `count` cavities of size `lambda` enclose: the inverse of
/// [`cavity_lambda`].
pub fn cavity_percent(lambda: f64, n_blocks: usize, s: u32, w: f64, count: usize) -> f64 {
    100.0 * count as f64 * PI * lambda * lambda * (1.0 - f64::from(s) * w * w) / n_blocks as f64
}

/// Direction in which a groove runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Orientation {
    /// Across the x axis: the strip runs along y.
    Across,
    /// Along the x axis.
    Along,
}

/// A straight groove, half-open: a block with its centre on the lower edge is inside, on the upper edge
/// outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Groove {
    /// Direction in which the groove runs.
    pub orientation: Orientation,
    /// Width.
    pub width: f64,
    /// Distance of the groove's centre line from the middle of the slider.
    pub offset: f64,
}

impl Groove {
    /// The axis along which the groove's width is measured.
    pub(super) fn axis(&self) -> usize {
        match self.orientation {
            Orientation::Across => 0,
            Orientation::Along => 1,
        }
    }

    /// Shifts of the copies across the groove, each once per grid.
    pub(super) fn shifts(&self, grids: &[Crossings]) -> Vec<f64> {
        let across = grids.iter().flat_map(|grid| &grid[self.axis()]);
        across.copied().collect()
    }

    /// Smallest and largest (x, y) of the copy that is shifted by `shift` across, infinite along the strip.
    pub(super) fn bounds(&self, lattice: &Lattice, shift: f64) -> [[f64; 2]; 2] {
        let along_x = self.orientation == Orientation::Along;
        let size = if along_x { lattice.ny } else { lattice.nx } as f64;
        let middle = 0.5 * size + self.offset + shift;
        let (from, to) = (middle - 0.5 * self.width, middle + 0.5 * self.width);
        if along_x {
            [[f64::NEG_INFINITY, from], [f64::INFINITY, to]]
        } else {
            [[from, f64::NEG_INFINITY], [to, f64::INFINITY]]
        }
    }

    /// Smallest and largest (x, y) of the rectangle that the copy covers, as long as the slider.
    pub(super) fn rectangle(&self, lattice: &Lattice, shift: f64) -> [[f64; 2]; 2] {
        let [mut low, mut high] = self.bounds(lattice, shift);
        let along = 1 - self.axis();
        (low[along], high[along]) = (0.0, [lattice.nx, lattice.ny][along] as f64);
        [low, high]
    }
}

/// Number of vertices of a semi-polygon's outline. The vertices lie on the curve, and the chords between them
/// differ from it by less than `lambda (1 + s) (2 pi/4096)^2/8`, a ten-thousandth of a block at `lambda` =
/// 100.
pub(super) const OUTLINE_VERTICES: usize = 4096;

impl Cavity {
    pub(super) fn outlines(&self, grids: &[Crossings]) -> Outlines {
        Outlines::at(self.curve(), self.center, grids)
    }

    pub(super) fn curve(&self) -> Curve {
        // A turned circle is the same circle, to the last bit.
        let axis = unit_vector(if self.w == 0.0 { 0.0 } else { self.rotate });
        let swap = |p: [f64; 2]| if self.across { [p[1], p[0]] } else { p };
        if self.s == 1 || self.w == 0.0 {
            let w = if self.s == 1 { self.w } else { 0.0 };
            let semi_axes = swap([self.lambda * (1.0 + w), self.lambda * (1.0 - w)]);
            return Curve::Ellipse { semi_axes, axis };
        }
        let s = f64::from(self.s);
        let vertex = |k: usize| {
            let phi = TAU * k as f64 / OUTLINE_VERTICES as f64;
            let p = swap([
                self.lambda * (libm::cos(phi) + self.w * libm::cos(s * phi)),
                self.lambda * (libm::sin(phi) - self.w * libm::sin(s * phi)),
            ]);
            Vertex {
                x: [axis[0] * p[0], -axis[1] * p[1]],
                y: [axis[1] * p[0], axis[0] * p[1]],
            }
        };
        Curve::Polygon(vec![Ring::alone((0..OUTLINE_VERTICES).map(vertex).collect())])
    }
}
