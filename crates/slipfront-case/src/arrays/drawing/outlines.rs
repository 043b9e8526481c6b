//! Outlines of a drawing, as they are read.

use slipfront::surface::Part;

/// Deepest nesting of groups and blocks.
#[cfg(feature = "drawings")]
pub(super) const MAX_DEPTH: usize = 32;
/// Name of the layer that `slipfront texture` gives the edge of the slider, which is no texture.
pub(crate) const SLIDER_LAYER: &str = "SLIDER";

/// Outlines in blocks, from the lower left corner of an SVG page or the origin of a DXF drawing, y upwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Outlines that are filled together; the inside of the drawing is the union of all.
    pub parts: Vec<Part>,
    /// Notes about what the file shows and the parts leave out.
    pub notes: Vec<String>,
}
