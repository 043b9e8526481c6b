//! `shape` = "drawing": the outlines of an SVG or a DXF.

use serde::{Deserialize, Serialize};

use crate::case_file::check::{Check, Checked};
use crate::case_file::error::CaseError;
use crate::case_file::key::{KeyKind, key};
use crate::case_file::synonyms::{Synonyms, synonyms};
use crate::key_rows;

pub(super) const SYNONYMS: Synonyms = synonyms! {
    "svg" "dxf" "cad" =>
        "outlines of a drawing are `shape` = \"drawing\" with `file` = \"cavity.svg\" or \"cavity.dxf\"";
};

key_rows! {
    /// The inside of the outlines of a drawing, in true size.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Drawing checked {
        /// Filled shapes of an SVG with width and height in mm, whose page has its lower left corner at that
        /// of the slider; or closed lines of a DXF with a unit, whose origin lies there.
        pub file: String = key("", KeyKind::File(&["svg", "dxf"])),
    }
}
