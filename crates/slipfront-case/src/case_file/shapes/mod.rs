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
use toml::Spanned;
use toml::de::DeValue;

pub use self::cavity::{Cavity, CavitySize, Center};
pub use self::drawing::Drawing;
pub use self::groove::{Groove, GrooveSize};
pub use self::height_map::{Bearing, HeightMap, Level, Missing};
pub use self::mask::{DEFAULT_THRESHOLD, Mask};
pub(crate) use self::outlined::{Blocks, Outlined};
pub use self::polygon::Polygon;
use super::check::Check;
use super::error::CaseError;
use super::key_table::Section;
use super::synonyms::Synonyms;
use super::tables::Tables;

/// Words that people try first, with the advice on each, by shape.
pub(super) const SYNONYMS: [Synonyms; 6] = [
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

/// Origin of the blocks of a shape.
pub(crate) enum ShapeSource<'a> {
    /// An outline that is known before any file is read.
    Outline(&'a dyn Outlined),
    Mask(&'a Mask),
    HeightMap(&'a HeightMap),
    Drawing(&'a Drawing),
}

impl Shape {
    /// Reads the shape of a section from the table with its keys; none if no shape has the name of the
    /// section.
    pub(super) fn read<'i>(
        tables: &Tables<'_, 'i>,
        section: &Section,
        table: Spanned<DeValue<'i>>,
        header: &str,
    ) -> Result<Option<Self>, CaseError> {
        let of_shape = Some(section);
        Ok(Some(match section.name {
            "cavity" => Self::Cavity(tables.read_keys(table, header, of_shape)?),
            "groove" => Self::Groove(tables.read_keys(table, header, of_shape)?),
            "polygon" => Self::Polygon(tables.read_keys(table, header, of_shape)?),
            "mask" => Self::Mask(tables.read_keys(table, header, of_shape)?),
            "height_map" => Self::HeightMap(tables.read_keys(table, header, of_shape)?),
            "drawing" => Self::Drawing(tables.read_keys(table, header, of_shape)?),
            _ => return Ok(None),
        }))
    }

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

    /// Returns the origin of the blocks of the shape.
    pub(crate) fn source(&self) -> ShapeSource<'_> {
        match self {
            Self::Cavity(cavity) => ShapeSource::Outline(cavity),
            Self::Groove(groove) => ShapeSource::Outline(groove),
            Self::Polygon(polygon) => ShapeSource::Outline(polygon),
            Self::Mask(mask) => ShapeSource::Mask(mask),
            Self::HeightMap(map) => ShapeSource::HeightMap(map),
            Self::Drawing(drawing) => ShapeSource::Drawing(drawing),
        }
    }

    /// Outline of the shape, if it is known before any file is read.
    pub(crate) fn outline(&self) -> Option<&dyn Outlined> {
        match self.source() {
            ShapeSource::Outline(outline) => Some(outline),
            _ => None,
        }
    }

    /// Whether the outline of the shape is known before any file is read.
    pub fn has_outline(&self) -> bool {
        self.outline().is_some()
    }

    /// Reason why the shape covers no block, with the keys to check.
    pub(crate) fn why_empty(&self) -> &'static str {
        match self {
            Self::Mask(_) => Mask::EMPTY,
            Self::HeightMap(map) => map.why_empty(),
            _ => "it lies off the slider, or between the centres of blocks; look at its size and place",
        }
    }

    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        match self {
            Self::Cavity(cavity) => cavity.check(check),
            Self::Groove(groove) => groove.check_values(check),
            Self::Polygon(polygon) => polygon.check(check),
            Self::Mask(mask) => mask.check_values(check),
            Self::HeightMap(map) => map.check(check),
            Self::Drawing(drawing) => drawing.check_values(check),
        }
    }
}
