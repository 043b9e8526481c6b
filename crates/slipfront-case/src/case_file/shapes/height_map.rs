//! Key `shape = "height_map"` of a `[[texture]]`: measured topography whose highest parts touch.

use serde::{Deserialize, Serialize};

use crate::case_file::check::Check;
use crate::case_file::choice::keys_with_choice;
use crate::case_file::error::CaseError;
use crate::case_file::key::{COORDINATE, COVERAGE, Key, KeyKind, SIZE, key};
use crate::case_file::pattern::Pitch;
use crate::quantity::Length;

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    key("file", "", KeyKind::File(&["npy", "csv", "gsf", "x3p", "png", "tif", "tiff"]), "measured heights, stretched over the slider"),
    key("bearing_percent", "", COVERAGE, "the share of the area that touches, the highest parts first")
        .or("depth").title("bearing area", "", "%"),
    key("depth", "", SIZE, "how far below the reference a block still touches").or("bearing_percent").title("depth of contact", "", "m"),
    key("reference", "", COORDINATE, "height from which `depth` is counted; that of the highest block if left out"),
    key("height_unit", "", SIZE, "the height that a value of 1 in the file means, if the file has no unit"),
    key("pixel_size", "", KeyKind::Special("a length, or a pair; more than 0, at most 1e9 m"),
        "distance of neighbouring points, if the file does not have it"),
];

pub(super) const SYNONYMS: &[(&str, &str)] = &[
    ("topography", HEIGHT_MAP),
    ("heightmap", HEIGHT_MAP),
    ("heights", HEIGHT_MAP),
];
const HEIGHT_MAP: &str =
    "measured heights are `shape` = \"height_map\" with `file` and `bearing_percent` or `depth`";

/// A measured surface stretched over the slider: parts below the height of contact are textured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "HeightMapKeys", into = "HeightMapKeys")]
pub struct HeightMap {
    /// A `.npy`, `.csv`, `.gsf`, `.x3p`, or a `.png` or `.tif` of grey levels, relative to the case file.
    pub file: String,
    /// Heights that touch: `bearing_percent` or `depth`.
    pub bearing: Bearing,
    /// The height from which `depth` is counted, m; the highest block if there is none.
    pub reference: Option<Length>,
    /// The height of the value 1 in the file, m; none where the file has a unit.
    pub height_unit: Option<Length>,
    /// Distance of neighbouring points along x and along y, m; none where the file has it.
    pub pixel_size: Option<Pitch>,
}

/// Heights that touch.
#[derive(Clone, Debug, PartialEq)]
pub enum Bearing {
    /// `bearing_percent`: the highest blocks, this share of all in percent; more than 0, less than 100.
    Percent(f64),
    /// `depth`: the blocks that are at most this far below the reference, m.
    Depth(Length),
}

impl HeightMap {
    /// Reason for which a height map covers no block.
    pub(super) fn why_empty(&self) -> &'static str {
        match self.bearing {
            Bearing::Percent(_) => "none is lower than the lowest that touch; lower `bearing_percent`",
            Bearing::Depth(_) => "none is below the height of contact; lower `depth`",
        }
    }

    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        check.value("file", &self.file)?;
        self.bearing.check(check)?;
        check.value("reference", &self.reference)?;
        if self.reference.is_some() && matches!(self.bearing, Bearing::Percent(_)) {
            return check.refuse("reference", |key| {
                format!(
                    "`{key}` is what `depth` is counted from, and `bearing_percent` needs none: leave it out"
                )
            });
        }
        check.value("height_unit", &self.height_unit)?;
        let mut lengths = self.pixel_size.iter().flat_map(Pitch::lengths);
        lengths.try_for_each(|length| check.value_of(&SIZE, "pixel_size", length))
    }
}

keys_with_choice! {
    HeightMap: HeightMapKeys {
        file: String,
        (bearing: Bearing {
            bearing_percent: f64 => Percent,
            depth: Length => Depth,
            _ => "a height map needs what touches: `bearing_percent = 60` (percent of the area, the highest parts) or \
                  `depth = \"0.5 um\"` (below the highest)"
        }),
        reference: Option<Length>,
        height_unit: Option<Length>,
        pixel_size: Option<Pitch>,
    }
}
