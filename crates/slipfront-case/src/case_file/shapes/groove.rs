//! `shape` = "groove": straight strips through the whole slider (Eq. 15).

use serde::{Deserialize, Serialize};
use slipfront::surface::{self, Orientation};

use super::outlined::{Blocks, Outlined};
use crate::case_file::check::Check;
use crate::case_file::choice::keys_with_choice;
use crate::case_file::error::CaseError;
use crate::case_file::key::{COORDINATE, COVERAGE, Key, KeyKind, SIZE, key};
use crate::case_file::probe::names_of;
use crate::case_file::values::word;
use crate::quantity::Length;

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    key("orientation", "\"across\"", KeyKind::Words(names_of::<Orientation>),
        "whether the groove runs along y (across the x axis) or along x"),
    key("coverage", "", COVERAGE, "size: percent of the whole area").or("width").title("texture coverage", "A*", "%"),
    key("width", "", SIZE, "size: the width").or("coverage").title("groove width", "", "m"),
    key("offset", "\"0 um\"", COORDINATE, "distance of the groove's middle line from the slider's")
        .title("groove offset", "", "m"),
];

pub(super) const SYNONYMS: &[(&str, &str)] = &[
    ("line", GROOVE),
    ("stripe", GROOVE),
    ("channel", GROOVE),
    (
        "groove_across",
        "a groove is `shape` = \"groove\" with `orientation` = \"across\"",
    ),
    (
        "groove_along",
        "a groove is `shape` = \"groove\" with `orientation` = \"along\"",
    ),
];
const GROOVE: &str = "a straight one is `shape` = \"groove\" with `coverage` or `width`";

/// A straight groove through the whole slider, half-open: its lower edge in, its upper edge out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "GrooveKeys", into = "GrooveKeys")]
pub struct Groove {
    /// Whether the groove runs across or along the x axis of the lattice, whatever the direction of the drive.
    pub orientation: Orientation,
    /// The size: `coverage` or `width`.
    pub size: GrooveSize,
    /// Distance of the groove's middle line from the slider's middle line, m.
    pub offset: Length,
}

/// The size of a groove.
#[derive(Clone, Debug, PartialEq)]
pub enum GrooveSize {
    /// `coverage`: percent of the whole area, more than 0, less than 100.
    Coverage(f64),
    /// The key `width`, m.
    Width(Length),
}

impl Groove {
    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        self.size.check(check)?;
        check.value("offset", &self.offset)
    }
}

impl Outlined for Groove {
    fn noun(&self) -> &'static str {
        "groove"
    }

    fn coverage(&self) -> Option<f64> {
        match self.size {
            GrooveSize::Coverage(percent) => Some(percent),
            GrooveSize::Width(_) => None,
        }
    }

    fn in_blocks(&self, on: &Blocks) -> (surface::Shape, Option<f64>) {
        let of_width = |width: f64| {
            surface::Shape::Groove(surface::Groove {
                orientation: self.orientation,
                width,
                offset: on.scales.in_blocks(self.offset.si()),
            })
        };
        let count = of_width(0.0).n_copies(on.arrays) as f64;
        // A groove is as long as the lattice: the share of it that the slider fills is that of its area.
        let share = on.n_blocks as f64 / on.lattice.n_blocks() as f64;
        let breadth = match self.orientation {
            Orientation::Across => on.lattice.nx as f64 * share,
            Orientation::Along => on.lattice.ny as f64 * share,
        };
        let (width, percent) = match &self.size {
            GrooveSize::Coverage(percent) => (breadth * percent / 100.0 / count, *percent),
            GrooveSize::Width(width) => {
                let width = on.scales.in_blocks(width.si());
                (width, 100.0 * width / breadth * count)
            }
        };
        (of_width(width), Some(percent))
    }
}

keys_with_choice! {
    Groove: GrooveKeys {
        #[serde(deserialize_with = "word")]
        orientation: Orientation,
        (size: GrooveSize {
            coverage: f64 => Coverage,
            width: Length => Width,
            _ => "a groove needs a size: `coverage = 10` (percent of the area) or `width = \"5 um\"`"
        }),
        offset: Length,
    }
}
