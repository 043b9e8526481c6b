//! `shape` = "mask": the dark pixels of an image, or the ones of an array.

use serde::{Deserialize, Serialize};

use crate::case_file::check::Check;
use crate::case_file::error::CaseError;
use crate::case_file::key::{Key, KeyKind, between, key, number};

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    key("file", "", KeyKind::File(&["png", "npy"]), "an image, stretched over the slider"),
    key("threshold", "0.5", number(between(0.0, 1.0), "it is a share of white"),
        "a pixel of an image is dark below this share of white"),
];

pub(super) const SYNONYMS: &[(&str, &str)] = &[
    (
        "image",
        "an image is `shape` = \"mask\" with `file` = \"mask.png\"",
    ),
    ("png", "an image is `shape` = \"mask\" with `file` = \"mask.png\""),
];

/// An image or array stretched over the slider.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mask {
    /// A `.png` (dark pixels are textured) or a `.npy` of shape (ny, nx) of 0 and 1 (textured), relative to the case file.
    pub file: String,
    /// A pixel of an image is dark below this share of white, more than 0, less than 1.
    pub threshold: f64,
}

/// Default threshold, halfway to white.
pub const DEFAULT_THRESHOLD: f64 = 0.5;

impl Mask {
    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        check.value("file", &self.file)?;
        check.value("threshold", &self.threshold)
    }

    /// Reason for which a mask covers no block.
    pub(super) const EMPTY: &str =
        "no pixel at the centre of a block is dark, and no number of an array is 1; look at its file";
}
