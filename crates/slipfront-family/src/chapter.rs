//! A chapter: exact answers, and the values computed for them.

use slipfront_plot::{Response, Responses};

use crate::error::FamilyError;

/// The topic of a chapter: an option of the engine or a benchmark.
#[derive(Debug)]
pub(crate) struct Topic {
    /// Heading of the chapter.
    pub(crate) title: &'static str,
    /// Name of the file of the chapter's picture.
    pub(crate) name: &'static str,
    /// The model and the derivation of the answers, in Markdown.
    pub(crate) text: &'static str,
    /// Function that computes the answers and adds them to the chapter.
    pub(crate) compare: fn(&mut Chapter) -> Result<(), FamilyError>,
}

/// A chapter: one option of the engine and its exact answers.
#[derive(Debug)]
pub struct Chapter {
    pub(crate) topic: &'static Topic,
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
    /// The largest allowed distance of the computed value from the exact one.
    pub tolerance: f64,
    /// The largest distance of a value that is too small: less than `tolerance` if errors only increase the
    /// value.
    pub tolerance_below: f64,
    /// Reason for the tolerance, in one clause.
    pub reason: &'static str,
}

impl Chapter {
    /// The computed chapter about a topic.
    pub(crate) fn about(topic: &'static Topic) -> Result<Self, FamilyError> {
        let mut chapter = Self {
            topic,
            answers: Vec::new(),
            picture: None,
        };
        (topic.compare)(&mut chapter)?;
        Ok(chapter)
    }

    /// Adds an exact value and the value found, with the largest allowed distance between them.
    pub(crate) fn add(
        &mut self,
        quantity: impl Into<String>,
        [exact, found]: [f64; 2],
        tolerance: f64,
        reason: &'static str,
    ) -> &mut Answer {
        self.answers.push(Answer {
            quantity: quantity.into(),
            exact,
            found,
            tolerance,
            tolerance_below: tolerance,
            reason,
        });
        let last = self.answers.len() - 1;
        &mut self.answers[last]
    }

    /// Adds an exact value, and one that is read up to one `step` late, or includes the increment of one
    /// step.
    pub(crate) fn add_late(
        &mut self,
        quantity: impl Into<String>,
        [exact, found]: [f64; 2],
        step: f64,
        reason: &'static str,
    ) {
        self.add(quantity, [exact, found], step * (1.0 + 1e-9), reason)
            .tolerance_below = rounding(exact);
    }

    /// Sets the picture of curves, with the titles of its axes.
    pub(crate) fn draw(
        &mut self,
        caption: &'static str,
        [x, y]: [&str; 2],
        curves: Vec<Response>,
    ) -> &mut Responses {
        let (_, drawn) = self.picture.insert((
            caption,
            Responses {
                x_title: x.to_owned(),
                y_title: y.to_owned(),
                curves,
                ..Responses::default()
            },
        ));
        drawn
    }
}

impl Answer {
    /// The allowed distance on the side of the exact value where the computed one is.
    pub fn most(&self) -> f64 {
        if self.found < self.exact {
            self.tolerance_below
        } else {
            self.tolerance
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

    static TOPIC: Topic = Topic {
        title: "",
        name: "",
        text: "",
        compare: |_| Ok(()),
    };

    #[test]
    fn an_answer_holds_within_its_distances_alone() {
        let chapter = || Chapter::about(&TOPIC).unwrap();
        let holds = |found: f64| chapter().add("", [1.0, found], 0.25, "").holds();
        assert_eq!(
            [0.7, 0.75, 1.25, 1.3, f64::NAN, f64::INFINITY].map(holds),
            [false, true, true, false, false, false]
        );
        let holds = |found: f64| {
            let mut chapter = chapter();
            chapter.add_late("", [1.0, found], 0.25, "");
            chapter.answers[0].holds()
        };
        assert_eq!(
            [0.99, 1.0 - 1e-13, 1.25, 1.26, f64::NAN].map(holds),
            [false, true, true, false, false]
        );
    }
}
