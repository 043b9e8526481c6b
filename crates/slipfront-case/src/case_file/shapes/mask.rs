//! `shape` = "mask": the dark pixels of an image, or the ones of an array.

use serde::{Deserialize, Serialize};

use crate::case_file::check::{Check, Checked};
use crate::case_file::error::CaseError;
use crate::case_file::key::{KeyKind, between, key, number};
use crate::case_file::synonyms::{Synonyms, synonyms};
use crate::key_rows;

pub(super) const SYNONYMS: Synonyms = synonyms! {
    "image" "png" => "an image is `shape` = \"mask\" with `file` = \"mask.png\"";
};

key_rows! {
    /// An image or array stretched over the slider.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Mask checked {
        /// Image, stretched over the slider with its top row at the largest y, with dark pixels textured; or
        /// an array of 0 and 1 of shape (ny, nx), with 1 textured.
        pub file: String = key("", KeyKind::File(&["png", "npy"])),
        /// Grey level below which a pixel of an image is dark, from 0 (black) to 1 (white); no effect on
        /// arrays.
        pub threshold: f64 = key("0.5", number(between(0.0, 1.0), "it is a share of white")),
    }
}

/// Default threshold, halfway to white.
pub const DEFAULT_THRESHOLD: f64 = 0.5;

impl Mask {
    /// Reason why a mask covers no block.
    pub(super) const EMPTY: &str =
        "no pixel at the centre of a block is dark, and no number of an array is 1; look at its file";
}
