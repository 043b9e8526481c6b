//! Shapes with outlines that are known before any file is read.

use slipfront::surface::{self, Array};
use slipfront::{Lattice, Scales};

use crate::quantity::Length;

/// Blocks that are covered by shapes.
pub(crate) struct Blocks<'a> {
    pub(crate) scales: &'a Scales,
    pub(crate) lattice: &'a Lattice,
    /// Number of the blocks that exist.
    pub(crate) n_blocks: usize,
    /// The pattern of the copies of a shape.
    pub(crate) arrays: &'a [Array],
}

impl Blocks<'_> {
    /// A point in blocks.
    pub(super) fn point(&self, [x, y]: &[Length; 2]) -> [f64; 2] {
        [self.scales.in_blocks(x.si()), self.scales.in_blocks(y.si())]
    }
}

/// A shape with an outline.
pub(crate) trait Outlined {
    /// Name of one copy of the shape, in user terms.
    fn noun(&self) -> &'static str;

    /// The value of the key `coverage`, % of the whole area, if it gives the size of the shape.
    fn coverage(&self) -> Option<f64>;

    /// The shape in blocks, and the requested area of all copies, % of the area of the blocks that exist, if
    /// it is known before the shape is meshed.
    fn in_blocks(&self, on: &Blocks) -> (surface::Shape, Option<f64>);
}
