//! Key `shape = "height_map"` of a `[[texture]]`: measured topography with its highest parts in contact.

use serde::{Deserialize, Serialize};

use crate::case_file::check::Check;
use crate::case_file::error::CaseError;
use crate::case_file::key::{COORDINATE, COVERAGE, Key, KeyKind, SIZE, key};
use crate::case_file::pattern::{PITCH, Pitch};
use crate::case_file::serde_names::names_of;
use crate::case_file::synonyms::{Synonyms, synonyms};
use crate::case_file::values::WordOrNumber;
use crate::key_rows;
use crate::quantity::Length;
use crate::table::{DecimalSign, FieldSeparator};

pub(super) const SYNONYMS: Synonyms = synonyms! {
    "topography" "heightmap" "heights" =>
        "measured heights are `shape` = \"height_map\" with `file` and `bearing_percent` or `depth`";
};

key_rows! {
    /// A measured surface stretched over the slider: parts below the contact height are textured.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(try_from = "HeightMapKeys", into = "HeightMapKeys")]
    pub struct HeightMap from HeightMapKeys {
        /// Measured heights, stretched over the slider.
        pub file: String = key("", KeyKind::File(&["npy", "csv", "txt", "dat", "asc", "xyz", "gsf", "x3p", "png", "tif", "tiff"])),
        [
            /// Heights that touch: `bearing_percent` or `depth`.
            pub bearing: Bearing or "a height map needs what touches: `bearing_percent = 60` (percent of the area, the highest parts) or \
                                     `depth = \"0.5 um\"` (below the highest)" {
                /// Percentage of the area in contact, starting with the highest parts.
                bearing_percent: f64 => Percent = key("", COVERAGE)
                    .title("bearing area", "", "%"),
                /// Depth below the reference down to which a block is in contact. A map needs one of these
                /// two keys.
                depth: Length => Depth = key("", SIZE)
                    .title("depth of contact", "", "m"),
            }
        ]
        /// Height from which `depth` is measured; the height of the highest block if not given.
        pub reference: Option<Length> = key("", COORDINATE),
        /// Height of a value of 1 in the file, if the file has no unit.
        pub height_unit: Option<Length> = key("", SIZE),
        /// Distance between neighbouring points, if the file does not contain it.
        pub pixel_size: Option<Pitch> = key("", PITCH),
        /// Surface that is subtracted from the heights first: the least-squares plane.
        pub level: Option<Level> = key("", KeyKind::Words(names_of::<Level>)),
        /// Decimal sign of a text table.
        pub decimal: Option<DecimalSign> = key("", KeyKind::Words(names_of::<DecimalSign>)).without("found"),
        /// Separator of the numbers in a text table.
        pub separator: Option<FieldSeparator> = key("", KeyKind::Words(names_of::<FieldSeparator>)).without("found"),
        /// Value of points that were not measured, a number or `"nan"`; a block has the mean of its other
        /// points.
        pub missing: Option<Missing> = key("", KeyKind::Special("a number or `\"nan\"`")),
    }
}

/// The key `level`: the surface that is subtracted from heights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Level {
    /// The least-squares plane.
    Plane,
}

/// The key `missing`: the value of unmeasured points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "WordOrNumber", into = "WordOrNumber")]
pub enum Missing {
    /// A number.
    Value(f64),
    /// The word `"nan"`: any value that is not a number.
    Nan,
}

impl Missing {
    /// The value itself; NaN for the word `"nan"`.
    pub(crate) fn value(self) -> f64 {
        match self {
            Self::Value(value) => value,
            Self::Nan => f64::NAN,
        }
    }
}

impl TryFrom<WordOrNumber> for Missing {
    type Error = &'static str;

    fn try_from(value: WordOrNumber) -> Result<Self, Self::Error> {
        match value {
            WordOrNumber::Number(number) if number.is_finite() => Ok(Self::Value(number)),
            WordOrNumber::Word(word) if word == "nan" => Ok(Self::Nan),
            _ => Err("expected a finite number or \"nan\""),
        }
    }
}

impl From<Missing> for WordOrNumber {
    fn from(value: Missing) -> Self {
        match value {
            Missing::Value(number) => Self::Number(number),
            Missing::Nan => Self::Word("nan".to_owned()),
        }
    }
}

impl HeightMap {
    /// Reason why a height map covers no block.
    pub(super) fn why_empty(&self) -> &'static str {
        match self.bearing {
            Bearing::Percent(_) => "none is lower than the lowest that touch; lower `bearing_percent`",
            Bearing::Depth(_) => "none is below the height of contact; lower `depth`",
        }
    }

    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        self.check_values(check)?;
        if self.reference.is_some() && matches!(self.bearing, Bearing::Percent(_)) {
            return check.refuse("reference", |key| {
                format!(
                    "`{key}` is what `depth` is counted from, and `bearing_percent` needs none: leave it out"
                )
            });
        }
        Ok(())
    }
}
