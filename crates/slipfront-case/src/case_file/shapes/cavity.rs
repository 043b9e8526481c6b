//! `shape` = "cavity": the closed curves of Eq. 17.

use std::ops::Bound::{Excluded, Included};

use serde::{Deserialize, Serialize};
use slipfront::surface;

use super::outlined::{Blocks, Outlined};
use crate::case_file::check::{Check, Checked};
use crate::case_file::error::CaseError;
use crate::case_file::key::{COORDINATE, COVERAGE, DEGREES, Key, KeyKind, SIZE, key};
use crate::case_file::synonyms::{Synonyms, synonyms};
use crate::case_file::values::{Pair, length};
use crate::key_rows;
use crate::quantity::Length;

pub(super) const SYNONYMS: Synonyms = synonyms! {
    "circle" "circular" "dimple" "disc" "disk" "hole" "pit" "pocket" "sphere" =>
        "a circle is `shape` = \"cavity\" with `coverage`, or with `lambda`, its radius";
    "dimples" => "many dimples are one `shape` = \"cavity\" with `array` = [4, 4]";
    "ellipse" => "an ellipse is `shape` = \"cavity\" with `w` between -1 and 1";
    "triangle" =>
        "a triangle is `shape` = \"cavity\" with `s` = 2 and `w` between -1/2 and 1/2, or a \"polygon\"";
    "square" =>
        "a square is `shape` = \"cavity\" with `s` = 3 and `w` between -1/3 and 1/3, or a \"polygon\"";
    "radius" "diameter" => "the radius of a circle is `lambda`";
};

key_rows! {
    /// A cavity with the outline of Eq. 17.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(try_from = "CavityKeys", into = "CavityKeys")]
    pub struct Cavity from CavityKeys {
        /// Kind of outline: an ellipse for 1, otherwise a polygon with s + 1 curved edges.
        pub s: u32 = key("1", KeyKind::Whole { least: 1, most: 64, noun: "a whole number ", remark: "" })
            .paper("s")
            .title("cavity shape", "s", ""),
        /// Deviation of the outline from a circle; vertices are sharp at 1/s.
        pub w: f64 = key("0", KeyKind::Special("-1 < w < 1 for s = 1, else -1/s to 1/s")).paper("w")
            .title("cavity shape", "w", ""),
        [
            /// Size of the cavity: `coverage` or `lambda`.
            pub size: CavitySize or "a cavity needs a size: `coverage = 10` (percent of the area) or `lambda = \"8 um\"`" {
                /// Size: total coverage of all copies, in percent of the whole area.
                coverage: f64 => Coverage = key("", COVERAGE).paper("A* (Eq. 18, D5)")
                    .title("texture coverage", "A*", "%"),
                /// Size: the length of Eq. 17, the radius of a circle. A cavity needs one of these two keys.
                lambda: Length => Lambda = key("", SIZE).paper("lambda")
                    .title("cavity size", "\u{3bb}", "m"),
            }
        ]
        /// Whether x and y are swapped, as in the paper: an ellipse with w > 0 is then elongated along y, not
        /// x.
        pub across: bool = key("false", KeyKind::Switch),
        /// Centre of the cavity, or of its pattern.
        pub center: Center = key("\"middle\"", KeyKind::Special("`\"middle\"`, or a pair within 1e9 m")),
        /// Rotation, degrees from x towards y.
        pub rotate: f64 = key("0", DEGREES).title("rotation of the texture", "", "\u{b0}"),
    }
}

/// Position of a cavity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "CenterKey", into = "CenterKey")]
pub enum Center {
    /// The value `"middle"`: the middle of the slider.
    Middle,
    /// The value `[x, y]` from the slider's lower left corner, m.
    At([Length; 2]),
}

impl Cavity {
    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        self.check_values(check)?;
        let (most, remark) = match self.s {
            1 => (Excluded(1.0), "at 1 the cavity is a line".to_owned()),
            s => (
                Included(1.0 / f64::from(s)),
                format!("beyond 1/s = 1/{s} the outline crosses itself"),
            ),
        };
        let least = most.map(|most: f64| -most);
        check.number_within("w", self.w, (least, most), &remark)
    }
}

impl Checked for Center {
    fn complaint(&self, _: &KeyKind) -> Option<String> {
        match self {
            Self::Middle => None,
            Self::At(center) => center.iter().find_map(|length| length.complaint(&COORDINATE)),
        }
    }
}
impl Outlined for Cavity {
    fn noun(&self) -> &'static str {
        "dimple"
    }

    fn coverage(&self) -> Option<f64> {
        match self.size {
            CavitySize::Coverage(percent) => Some(percent),
            CavitySize::Lambda(_) => None,
        }
    }

    fn in_blocks(&self, on: &Blocks) -> (surface::Shape, Option<f64>) {
        let (s, w) = (self.s, self.w);
        let count = surface::n_copies(on.arrays);
        let (lambda, percent) = match &self.size {
            CavitySize::Coverage(percent) => (
                surface::cavity_lambda(*percent, on.n_blocks, s, w, count),
                *percent,
            ),
            CavitySize::Lambda(lambda) => {
                let lambda = on.scales.in_blocks(lambda.si());
                (lambda, surface::cavity_percent(lambda, on.n_blocks, s, w, count))
            }
        };
        let center = match &self.center {
            Center::Middle => [0.5 * on.lattice.nx as f64, 0.5 * on.lattice.ny as f64],
            Center::At(center) => on.point(center),
        };
        let cavity = surface::Cavity {
            center,
            lambda,
            s,
            w,
            across: self.across,
            rotate: self.rotate,
        };
        (surface::Shape::Cavity(cavity), Some(percent))
    }
}

/// The key `center` as in the file.
#[derive(Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "expected \"middle\" or a pair of lengths such as [\"25 um\", \"25 um\"]"
)]
enum CenterKey {
    Word(String),
    /// Two texts, so that a length that cannot be read keeps its own message.
    At(Pair<String>),
}

impl TryFrom<CenterKey> for Center {
    type Error = String;

    fn try_from(key: CenterKey) -> Result<Self, String> {
        match key {
            CenterKey::Word(word) if word == "middle" => Ok(Self::Middle),
            CenterKey::Word(_) => {
                Err("expected \"middle\" or a pair of lengths such as [\"25 um\", \"25 um\"]".to_owned())
            }
            CenterKey::At(Pair([x, y])) => Ok(Self::At([length(&x)?, length(&y)?])),
        }
    }
}

impl From<Center> for CenterKey {
    fn from(center: Center) -> Self {
        match center {
            Center::Middle => Self::Word("middle".to_owned()),
            Center::At(center) => Self::At(Pair(center.map(|length| length.to_string()))),
        }
    }
}
