//! Textures: cavities, grooves, polygons and masks (Eqs. 15, 17, 18). Positions and sizes are in blocks.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::outline::{Outlines, Shape, Vertex};
use crate::lattice::Lattice;
use crate::vector_field::unit_vector;

/// A textured zone.
#[derive(Clone, Debug, PartialEq)]
pub enum Texture {
    /// The closed curve of Eq. 17, once or on a grid.
    Cavity(Cavity),
    /// A straight strip from edge to edge.
    Groove(Groove),
    /// Any polygon, by the even-odd rule.
    Polygon(Vec<[f64; 2]>),
    /// Block by block of the rows that are meshed, row by row in rising y; several textures may be the same mask.
    Blocks(Arc<Vec<bool>>),
}

/// The cavity of Eq. 17 (Fig. 13):
///
/// ```text
/// x = x_0 + lambda (cos phi + w cos(s phi)),   y = y_0 + lambda (sin phi - w sin(s phi))
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cavity {
    /// Centre (x_0, y_0) of the cavity, or of the grid of cavities.
    pub center: [f64; 2],
    /// Size `lambda`.
    pub lambda: f64,
    /// Vertices less one: 1 makes ellipses, s > 1 semi-polygons of s + 1 edges.
    pub s: u32,
    /// Elongation (s = 1) or sharpness of the vertices; |w| <= 1/s, and |w| < 1 for s = 1.
    pub w: f64,
    /// Swaps x and y: elongated across the x axis.
    pub across: bool,
    /// Turn in degrees from x towards y, after the swap.
    pub rotate: f64,
    /// Columns and rows of the grid on which the cavity is repeated, spread over the slider.
    pub array: [usize; 2],
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

/// Which way a groove runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Orientation {
    /// Across the x axis: the strip runs along y.
    Across,
    /// Along the x axis.
    Along,
}

/// A straight groove, half-open: the block whose centre lies on its lower edge is in, on its upper edge out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Groove {
    /// Which way it runs.
    pub orientation: Orientation,
    /// Width.
    pub width: f64,
    /// Distance of its middle line from the middle of the slider.
    pub offset: f64,
}

impl Groove {
    /// Smallest and largest (x, y), infinite along the strip.
    pub(super) fn bounds(&self, lattice: &Lattice) -> [[f64; 2]; 2] {
        let along_x = self.orientation == Orientation::Along;
        let size = if along_x { lattice.ny } else { lattice.nx } as f64;
        let middle = 0.5 * size + self.offset;
        let (from, to) = (middle - 0.5 * self.width, middle + 0.5 * self.width);
        if along_x {
            [[f64::NEG_INFINITY, from], [f64::INFINITY, to]]
        } else {
            [[from, f64::NEG_INFINITY], [to, f64::INFINITY]]
        }
    }
}

/// Number of vertices of a semi-polygon's outline. They lie on the curve, and the chords between them differ from it by less
/// than `lambda (1 + s) (2 pi/4096)^2/8`, a ten-thousandth of a block at `lambda` = 100.
const OUTLINE_VERTICES: usize = 4096;

impl Cavity {
    pub(super) fn outlines(&self, lattice: &Lattice) -> Outlines {
        let spacing = |size: usize, count: usize| size as f64 / count as f64;
        let [columns, rows] = self.array;
        let spacing = [spacing(lattice.nx, columns), spacing(lattice.ny, rows)];
        let centers = |axis: usize| {
            let count = self.array[axis];
            let position = move |k: usize| k as f64 - 0.5 * (count as f64 - 1.0);
            (0..count)
                .map(|k| self.center[axis] + spacing[axis] * position(k))
                .collect()
        };
        Outlines {
            shape: self.shape(),
            centers: [centers(0), centers(1)],
        }
    }

    fn shape(&self) -> Shape {
        let axis = unit_vector(self.rotate);
        let swap = |p: [f64; 2]| if self.across { [p[1], p[0]] } else { p };
        if self.s == 1 || self.w == 0.0 {
            let w = if self.s == 1 { self.w } else { 0.0 };
            let semi_axes = swap([self.lambda * (1.0 + w), self.lambda * (1.0 - w)]);
            return Shape::Ellipse { semi_axes, axis };
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
        Shape::Polygon((0..OUTLINE_VERTICES).map(vertex).collect())
    }
}
