//! `shape` = "groove": straight strips through the whole slider (Eq. 15).

use serde::{Deserialize, Serialize};
use slipfront::surface::{self, Orientation};

use super::outlined::{Blocks, Outlined};
use crate::case_file::check::Check;
use crate::case_file::error::CaseError;
use crate::case_file::key::{COORDINATE, COVERAGE, Key, KeyKind, SIZE, key};
use crate::case_file::serde_names::names_of;
use crate::case_file::synonyms::{Synonyms, synonyms};
use crate::key_rows;
use crate::quantity::Length;

pub(super) const SYNONYMS: Synonyms = synonyms! {
    "line" "stripe" "channel" => "a straight one is `shape` = \"groove\" with `coverage` or `width`";
    "groove_across" => "a groove is `shape` = \"groove\" with `orientation` = \"across\"";
    "groove_along" => "a groove is `shape` = \"groove\" with `orientation` = \"along\"";
};

key_rows! {
    /// A straight groove through the whole slider, half-open: it includes its lower edge, but not its upper
    /// edge.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(try_from = "GrooveKeys", into = "GrooveKeys")]
    pub struct Groove from GrooveKeys {
        /// Orientation of the groove: along y (across the x axis), or along x.
        pub orientation: Orientation = key("\"across\"", KeyKind::Words(names_of::<Orientation>)),
        [
            /// Size of the groove: `coverage` or `width`.
            pub size: GrooveSize or "a groove needs a size: `coverage = 10` (percent of the area) or `width = \"5 um\"`" {
                /// Size: total coverage of all copies, in percent of the whole area.
                coverage: f64 => Coverage = key("", COVERAGE).paper("A*")
                    .title("texture coverage", "A*", "%"),
                /// Size: the width. A groove needs one of these two keys.
                width: Length => Width = key("", SIZE).title("groove width", "", "m"),
            }
        ]
        /// Distance between the centre lines of groove and slider.
        pub offset: Length = key("\"0 um\"", COORDINATE).title("groove offset", "", "m"),
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
        // A groove is as long as the lattice. The slider fills the same share of it as of the area.
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
