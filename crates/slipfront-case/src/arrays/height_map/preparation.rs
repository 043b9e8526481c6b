//! Treatment of heights before they are averaged.

use crate::table::TableOptions;

/// Treatment of heights before they are averaged.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Preparation {
    /// Value of unmeasured points, which are ignored; it may be NaN.
    pub missing: Option<f64>,
    /// Whether the least-squares plane is subtracted.
    pub is_levelled: bool,
    /// Format of a text table, where it is not to be detected.
    pub table: TableOptions,
}

impl Preparation {
    /// Whether this height marks a point that was not measured.
    pub(super) fn is_missing(&self, height: f64) -> bool {
        self.missing
            .is_some_and(|missing| height == missing || (height.is_nan() && missing.is_nan()))
    }
}
