//! Confidence intervals as error bars.

use crate::canvas::Canvas;
use crate::range::drawable;
use crate::style::Rgb;

/// How far the cross lines at the ends reach to both sides.
const CAP: f64 = 9.0;

/// A confidence interval that can be drawn.
pub(crate) struct Interval {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Interval {
    /// The interval around a mean, if all three are numbers.
    pub(crate) fn of(mean: f64, low: f64, high: f64) -> Option<Self> {
        [mean, low, high].into_iter().all(drawable).then(|| Self {
            low: low.min(high),
            high: low.max(high),
        })
    }
}

/// Draws an error bar from one pixel of y to another.
pub(crate) fn error_bar(canvas: &mut Canvas, x: f64, (low, high): (f64, f64), width: f64, colour: Rgb) {
    canvas.line((x, low), (x, high), width, colour);
    for y in [low, high] {
        canvas.line((x - CAP, y), (x + CAP, y), width, colour);
    }
}
