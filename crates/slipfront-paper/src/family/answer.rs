//! An exact answer and what was computed in its place.

use crate::drawing::Drawing;

/// What one option of the engine is held against.
#[derive(Clone, Debug)]
pub struct Chapter {
    /// Its heading.
    pub title: &'static str,
    /// Name of its picture's file.
    pub name: &'static str,
    /// What is modelled, and how the answers are derived, in Markdown.
    pub text: &'static str,
    /// The answers.
    pub answers: Vec<Answer>,
    /// A picture with its caption, where one helps.
    pub picture: Option<(&'static str, Drawing)>,
}

/// An exact answer and what was computed.
#[derive(Clone, Debug)]
pub struct Answer {
    /// What it is.
    pub quantity: String,
    /// The exact value.
    pub exact: f64,
    /// The computed one.
    pub found: f64,
    /// How far they may be apart.
    pub tolerance: Tolerance,
}

/// How far a computed value may be from the exact one, and why as far.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// The largest distance.
    pub distance: f64,
    /// Its reason, in one clause.
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

    /// Whether the two agree; not so of a value that is none.
    pub fn holds(&self) -> bool {
        (self.found - self.exact).abs() <= self.tolerance.distance
    }
}
