//! The tolerance of a wish, and the parts within it.

use serde::Serialize;

/// Share of parts that must be within the tolerance for a design to pass: that within two standard deviations
/// of a normal distribution, as for the intervals of a report. At least 61 of 64 surfaces must be within it,
/// or all of 8.
const PASSING_SHARE: f64 = 0.95;

/// Number of parts within the tolerance of a wish.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct WithinTolerance {
    /// Number of parts within it.
    pub within: usize,
    /// Number of parts, each with its own surface.
    pub parts: usize,
}

impl WithinTolerance {
    /// Whether enough parts are within the tolerance for the design to pass.
    pub fn passes(self) -> bool {
        self.within as f64 >= PASSING_SHARE * self.parts as f64
    }

    /// The parts in a cell of a table.
    pub(crate) fn cell(self) -> String {
        let Self { within, parts } = self;
        let end = if self.passes() { "" } else { ", fails" };
        format!("{within} of {parts}{end}")
    }

    /// The end of a sentence on the parts, for a tolerance as text.
    pub(crate) fn in_words(self, tolerance: &str) -> String {
        let Self { within, parts } = self;
        let verdict = if self.passes() {
            "the design passes".to_owned()
        } else {
            format!(
                "the design fails, because at least {} % must",
                100.0 * PASSING_SHARE
            )
        };
        format!("{within} of {parts} parts lie within \u{b1} {tolerance}: {verdict}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_twentieth_of_the_parts_may_be_outside() {
        let passes = |within, parts| WithinTolerance { within, parts }.passes();
        assert!(passes(61, 64) && !passes(60, 64));
        assert!(passes(8, 8) && !passes(7, 8));
        assert!(passes(1, 1) && !passes(0, 1) && passes(19, 20));
        assert_eq!(WithinTolerance { within: 5, parts: 8 }.cell(), "5 of 8, fails");
    }
}
