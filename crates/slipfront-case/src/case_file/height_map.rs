//! `shape = "height_map"` of a `[[texture]]`: measured topography, of which the highest parts touch.

use serde::{Deserialize, Serialize};

use super::check::Check;
use super::choice::keys_with_choice;
use super::error::CaseError;
use super::key_table::SIZE;
use super::pattern::Pitch;
use crate::quantity::Length;

/// A measured surface stretched over the slider: what lies below the height of contact is textured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "HeightMapKeys", into = "HeightMapKeys")]
pub struct HeightMap {
    /// A `.npy`, `.csv`, `.gsf`, `.x3p`, or a `.png` or `.tif` of grey levels, relative to the case file.
    pub file: String,
    /// Which heights touch: `bearing_percent` or `depth`.
    pub bearing: Bearing,
    /// The height from which `depth` is counted, m; none is that of the highest block.
    pub reference: Option<Length>,
    /// The height that a value of 1 in the file means, m; none where the file has a unit.
    pub height_unit: Option<Length>,
    /// Distance of neighbouring points along x and along y, m; none where the file has it.
    pub pixel_size: Option<Pitch>,
}

/// Which heights touch.
#[derive(Clone, Debug, PartialEq)]
pub enum Bearing {
    /// `bearing_percent`: the highest blocks, this share of all in percent; more than 0, less than 100.
    Percent(f64),
    /// `depth`: the blocks that are at most this far below the reference, m.
    Depth(Length),
}

impl HeightMap {
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
