//! Keys that take one word of several.

use serde::{Deserialize, Serialize};

/// The shape of the slider: blocks outside do not exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outline {
    /// All blocks.
    Rectangle,
    /// The disc that fills as many blocks along x as along y.
    Disc,
    /// The blocks of a file.
    Mask,
}

/// The words of `attach`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AttachedEdge {
    /// Every block.
    All,
    /// The blocks at x = 0.
    Left,
    /// Those at the largest x.
    Right,
    /// Those at y = 0.
    Bottom,
    /// Those at the largest y.
    Top,
}

/// How the far ends of the drive springs move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// Along the direction of the drive.
    Translation,
    /// About the middle of the slider.
    Rotation,
}

/// When the far ends of the drive springs move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Loading {
    /// In every step.
    Constant,
    /// While no block in contact slides.
    Held,
}

/// `lattice`: how columns and rows lie to each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Arrangement {
    /// In a grid.
    #[default]
    Square,
    /// Every second row is shifted by half a pitch, and rows are sqrt(3)/2 pitches apart: six neighbours at one distance.
    Hexagonal,
    /// Every second row is shifted by half a pitch.
    Staggered,
}
