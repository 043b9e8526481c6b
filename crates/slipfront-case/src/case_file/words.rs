//! Keys that accept one of several words.

use serde::{Deserialize, Serialize};

/// The shape of the slider: blocks outside do not exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outline {
    /// The shape with all blocks.
    Rectangle,
    /// The disc inscribed in a square of blocks.
    Disc,
    /// The shape with the blocks of a file.
    Mask,
}

/// Kind of body of the slider.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Body {
    /// A sheet of the thickness of the slider.
    #[default]
    Sheet,
    /// A body that is thick under its texture, by its exact elastic response.
    Bulk,
}

/// Direction in which friction acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FrictionAlong {
    /// The plane of the slider, which lies flat on its substrate.
    #[default]
    Plane,
    /// The axis along rows, for a sheet that is upright on its substrate.
    X,
}

/// Stiffness of the springs along free edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EdgeSprings {
    /// Springs as stiff as those inside, as in the paper.
    #[default]
    Whole,
    /// Springs half as stiff.
    Halved,
}

/// The words of `attach`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AttachedEdge {
    /// All blocks.
    All,
    /// The blocks at x = 0.
    Left,
    /// The blocks at the largest x.
    Right,
    /// The blocks at y = 0.
    Bottom,
    /// The blocks at the largest y.
    Top,
}

/// Motion of the far ends of the drive springs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// Motion along the direction of the drive.
    Translation,
    /// Rotation about the middle of the slider.
    Rotation,
}

/// Times when the far ends of the drive springs move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Loading {
    /// The far ends move in every step.
    Constant,
    /// The far ends stop while a block in contact slides.
    Held,
}

/// The key `lattice`: arrangement of columns and rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Arrangement {
    /// A square grid.
    #[default]
    Square,
    /// A hexagonal arrangement: every second row is shifted by half a pitch, and rows are sqrt(3)/2 pitches
    /// apart, so that every copy has six neighbours at equal distance.
    Hexagonal,
    /// A staggered arrangement: every second row is shifted by half a pitch.
    Staggered,
}
