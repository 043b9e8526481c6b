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
    /// A picture with its caption, where one helps.
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
    /// Largest allowed distance.
    pub tolerance: Tolerance,
}

/// Largest allowed distance of a computed value from the exact one, and its reason.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// The largest distance.
    pub distance: f64,
    /// Reason for the distance, in one clause.
    pub reason: &'static str,
}

impl Answer {
    /// An answer with the largest distance from the exact value that is allowed.
    pub fn new(
        quantity: impl Into<String>,
        [exact, found]: [f64; 2],
        (distance, reason): (f64, &'static str),
    ) -> Self {
        Self {
            quantity: quantity.into(),
            exact,
            found,
            tolerance: Tolerance { distance, reason },
        }
    }

    /// Whether the two values agree; false for NaN.
    pub fn holds(&self) -> bool {
        (self.found - self.exact).abs() <= self.tolerance.distance
    }
}
