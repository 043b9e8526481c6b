//! `shape` = "polygon": any closed polyline.

use serde::{Deserialize, Serialize};
use slipfront::surface;

use super::outlined::{Blocks, Outlined};
use crate::case_file::check::{Check, Checked};
use crate::case_file::error::CaseError;
use crate::case_file::key::{COORDINATE, KeyKind, key};
use crate::case_file::synonyms::{Synonyms, synonyms};
use crate::case_file::values::Pair;
use crate::key_rows;
use crate::quantity::Length;
use slipfront_base::number_format::count;

pub(super) const SYNONYMS: Synonyms = synonyms! {
    "rectangle" => "a rectangle is `shape` = \"polygon\" with its four `points`";
};

key_rows! {
    /// The inside of a closed polygon.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Polygon checked {
        /// Vertices; the even-odd rule determines the inside.
        #[serde(deserialize_with = "read_points")]
        pub points: Vec<[Length; 2]> = key("", KeyKind::Special("at least 3 pairs within 1e9 m")),
    }
}

impl Polygon {
    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        let corners = self.points.len();
        if corners < 3 {
            return check.refuse("points", |key| {
                format!(
                    "`{key}` has {}: a polygon needs at least 3",
                    count(corners, "point")
                )
            });
        }
        self.check_values(check)
    }
}

impl Checked for Vec<[Length; 2]> {
    fn complaint(&self, _: &KeyKind) -> Option<String> {
        self.iter()
            .flatten()
            .find_map(|length| length.complaint(&COORDINATE))
    }
}
impl Outlined for Polygon {
    fn noun(&self) -> &'static str {
        "feature"
    }

    fn coverage(&self) -> Option<f64> {
        None
    }

    fn in_blocks(&self, on: &Blocks) -> (surface::Shape, Option<f64>) {
        let points = self.points.iter().map(|point| on.point(point));
        (surface::Shape::Polygon(points.collect()), None)
    }
}

fn read_points<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Vec<[Length; 2]>, D::Error> {
    let points: Vec<Pair<Length>> = Vec::deserialize(deserializer)?;
    Ok(points.into_iter().map(|Pair(point)| point).collect())
}
