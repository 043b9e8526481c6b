//! The shapes of `[[texture]]`.
//!
//! Each shape has a file with its keys, the words that people try for them, its name for a user, and the
//! shape in blocks that they define. This file has one row per shape.

mod cavity;
mod drawing;
mod groove;
mod height_map;
mod mask;
mod outlined;
mod polygon;

use serde::Serialize;

pub use self::cavity::{Cavity, CavitySize, Center};
pub use self::drawing::Drawing;
pub use self::groove::{Groove, GrooveSize};
pub use self::height_map::{Bearing, HeightMap, Level, Missing};
pub use self::mask::{DEFAULT_THRESHOLD, Mask};
pub(crate) use self::outlined::{Blocks, Outlined};
pub use self::polygon::Polygon;
use super::check::Check;
use super::error::CaseError;
use super::key::{Key, joined};
use super::pattern::Pattern;

/// Joins the keys of a shape and the keys common to all shapes.
macro_rules! keys {
    ($shape:ident) => {
        &joined::<{ $shape::KEYS.len() + Pattern::KEYS.len() }>($shape::KEYS, Pattern::KEYS)
    };
}

/// The names of the shapes and their keys, in the order of the documentation.
pub(super) const ALL: [(&str, &[Key]); 6] = [
    ("cavity", keys!(Cavity)),
    ("groove", keys!(Groove)),
    ("polygon", keys!(Polygon)),
    ("mask", keys!(Mask)),
    ("height_map", keys!(HeightMap)),
    ("drawing", keys!(Drawing)),
];

/// Words that people try first, with the advice on each, by shape.
pub(super) const SYNONYMS: &[&[(&str, &str)]] = &[
    cavity::SYNONYMS,
    groove::SYNONYMS,
    polygon::SYNONYMS,
    mask::SYNONYMS,
    height_map::SYNONYMS,
    drawing::SYNONYMS,
];

/// The shape of a texture.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "shape", rename_all = "snake_case")]
pub enum Shape {
    /// A cavity with the outline of Eq. 17.
    Cavity(Cavity),
    /// A straight groove through the whole slider (Eq. 15).
    Groove(Groove),
    /// The inside of a closed polygon, by the even-odd rule.
    Polygon(Polygon),
    /// The dark pixels of an image, or the ones of an array.
    Mask(Mask),
    /// Measured topography.
    HeightMap(HeightMap),
    /// The outlines of a drawing.
    Drawing(Drawing),
}

/// Definition of the inside of a shape.
pub(crate) enum Inside<'a> {
    /// The inside of an outline.
    Outline(&'a dyn Outlined),
    /// The blocks of a file.
    Mask(&'a Mask),
    /// The heights of a file.
    HeightMap(&'a HeightMap),
    /// The outlines of a file.
    Drawing(&'a Drawing),
}

impl Shape {
    /// Name of the shape in the file.
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Cavity(_) => "cavity",
            Self::Groove(_) => "groove",
            Self::Polygon(_) => "polygon",
            Self::Mask(_) => "mask",
            Self::HeightMap(_) => "height_map",
            Self::Drawing(_) => "drawing",
        }
    }

    /// Definition of the inside of the shape.
    pub(crate) fn form(&self) -> Inside<'_> {
        match self {
            Self::Cavity(cavity) => Inside::Outline(cavity),
            Self::Groove(groove) => Inside::Outline(groove),
            Self::Polygon(polygon) => Inside::Outline(polygon),
            Self::Mask(mask) => Inside::Mask(mask),
            Self::HeightMap(map) => Inside::HeightMap(map),
            Self::Drawing(drawing) => Inside::Drawing(drawing),
        }
    }

    /// Outline of the shape, if it is known before any file is read.
    pub(crate) fn outline(&self) -> Option<&dyn Outlined> {
        match self.form() {
            Inside::Outline(outline) => Some(outline),
            Inside::Mask(_) | Inside::HeightMap(_) | Inside::Drawing(_) => None,
        }
    }

    /// Whether the outline of the shape is known before any file is read.
    pub fn has_outline(&self) -> bool {
        self.outline().is_some()
    }

    /// Reason why the shape covers no block, with the keys to check.
    pub(crate) fn why_empty(&self) -> &'static str {
        match self.form() {
            Inside::Outline(_) | Inside::Drawing(_) => {
                "it lies off the slider, or between the centres of blocks; look at its size and place"
            }
            Inside::Mask(_) => Mask::EMPTY,
            Inside::HeightMap(map) => map.why_empty(),
        }
    }

    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        match self {
            Self::Cavity(cavity) => cavity.check(check),
            Self::Groove(groove) => groove.check(check),
            Self::Polygon(polygon) => polygon.check(check),
            Self::Mask(mask) => mask.check(check),
            Self::HeightMap(map) => map.check(check),
            Self::Drawing(drawing) => drawing.check(check),
        }
    }
}
