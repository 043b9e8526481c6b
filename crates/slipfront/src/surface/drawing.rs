//! Parts of a drawing: closed lines, and the rule by which they are filled. slipfront-case reads them from
//! files, and `outline.rs` lays them over the blocks.

/// Closed polylines that are filled together.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Corners of each polyline.
    pub rings: Vec<Vec<[f64; 2]>>,
    /// Rule of the inside.
    pub rule: FillRule,
}

/// Rule that defines the inside of closed lines by the lines which a ray from a point crosses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FillRule {
    /// An odd number of lines.
    #[default]
    EvenOdd,
    /// Unequal numbers of lines that cross the ray upwards and downwards.
    NonZero,
}
