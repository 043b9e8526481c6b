//! An exact answer and the value computed for it.

use slipfront_plot::Responses;

/// A chapter: one option of the engine and its exact answers.
#[derive(Clone, Debug)]
pub struct Chapter {
    /// Heading of the chapter.
    pub title: &'static str,
    /// Name of the file of the chapter's picture.
    pub name: &'static str,
    /// The model and the derivation of the answers, in Markdown.
    pub text: &'static str,
    /// The answers.
    pub answers: Vec<Answer>,
    /// A picture with its caption, if the chapter has one.
    pub picture: Option<(&'static str, Responses)>,
}

/// An exact answer and the computed value.
#[derive(Clone, Debug)]
pub struct Answer {
    /// Name of the quantity.
    pub quantity: String,
    /// The exact value.
    pub exact: f64,
    /// The computed value.
    pub found: f64,
    /// Largest allowed distances.
    pub tolerance: Tolerance,
}

/// Largest allowed distances of a computed value from the exact one, and their reason.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// The largest distance.
    pub distance: f64,
    /// The largest distance of a value that is too small: less than `distance` if errors only increase the
    /// value.
    pub below: f64,
    /// Reason for the distance, in one clause.
    pub reason: &'static str,
}

impl Answer {
    /// An answer with the largest allowed distance from the exact value.
    pub fn new(
        quantity: impl Into<String>,
        [exact, found]: [f64; 2],
        (distance, reason): (f64, &'static str),
    ) -> Self {
        Self {
            quantity: quantity.into(),
            exact,
            found,
            tolerance: Tolerance {
                distance,
                below: distance,
                reason,
            },
        }
    }

    /// An exact answer that is read up to one `step` late, or includes the increment of one step.
    pub fn seen_late(
        quantity: impl Into<String>,
        [exact, found]: [f64; 2],
        (step, reason): (f64, &'static str),
    ) -> Self {
        Self::new(quantity, [exact, found], (step * (1.0 + 1e-9), reason)).at_most_below(rounding(exact))
    }

    /// The answer with a smaller allowed distance for a value below the exact one.
    pub fn at_most_below(mut self, distance: f64) -> Self {
        self.tolerance.below = distance;
        self
    }

    /// The allowed distance on the side of the exact value where the computed one is.
    pub fn most(&self) -> f64 {
        if self.found < self.exact {
            self.tolerance.below
        } else {
            self.tolerance.distance
        }
    }

    /// Whether the two values agree; false for NaN.
    pub fn holds(&self) -> bool {
        (self.found - self.exact).abs() <= self.most()
    }
}

/// Distance by which rounding may reduce a value below the exact one, if other errors only increase it.
pub(crate) fn rounding(exact: f64) -> f64 {
    1e-12 * exact.abs().max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_holds_within_its_distances_alone() {
        let holds = |found: f64| Answer::new("", [1.0, found], (0.25, "")).holds();
        assert_eq!(
            [0.7, 0.75, 1.25, 1.3, f64::NAN, f64::INFINITY].map(holds),
            [false, true, true, false, false, false]
        );
        let holds = |found: f64| Answer::seen_late("", [1.0, found], (0.25, "")).holds();
        assert_eq!(
            [0.99, 1.0 - 1e-13, 1.25, 1.26, f64::NAN].map(holds),
            [false, true, true, false, false]
        );
    }
}
