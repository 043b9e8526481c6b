//! A colour bar with its name.

use crate::canvas::Canvas;
use crate::frame::{BAR_WIDTH, bar_room, colour_bar};
use crate::geometry::{Align, Area, CanvasPoint};
use crate::style::{BLACK, SIZE_LABEL};
use crate::text::Text;

/// Between the numbers and the name.
const GAP: f64 = 14.0;
/// A name above the bar stands so far above it, or above what is written over the map.
pub(crate) const ABOVE: f64 = 18.0;

/// A colour bar, dark at its foot. Its name reads upwards beside it, or stands above it where it is too short for that.
pub(crate) struct ColourBar {
    name: Text,
    /// The values at its ends.
    pub(crate) range: [f64; 2],
    height: f64,
}

impl ColourBar {
    pub(crate) fn of(name: Text, range: [f64; 2], height: f64) -> Self {
        Self { name, range, height }
    }

    /// A bar whose name is as large as other labels, with subscripts after underscores.
    pub(crate) fn labelled(name: &str, range: [f64; 2], height: f64) -> Self {
        Self::of(Text::math(name, SIZE_LABEL), range, height)
    }

    fn is_named_above(&self) -> bool {
        self.name.width() > self.height
    }

    /// The room that a name above the bar takes.
    pub(crate) fn upper_room(&self) -> f64 {
        if self.is_named_above() {
            ABOVE + f64::from(SIZE_LABEL)
        } else {
            0.0
        }
    }

    /// How wide it is with its numbers and a name beside them.
    pub(crate) fn room(&self) -> f64 {
        let numbered = bar_room(self.range, self.height);
        if self.is_named_above() || self.name.width() == 0.0 {
            numbered
        } else {
            numbered + GAP + self.name.height() + self.name.depth()
        }
    }

    /// Draws it with its upper left corner here, and its name, if that is above it, on the line `above`.
    pub(crate) fn draw(&self, canvas: &mut Canvas, (x, top): CanvasPoint, above: f64) {
        let area = Area::new(x, top, BAR_WIDTH, self.height);
        colour_bar(canvas, area, self.range);
        let right = x + self.room();
        if self.is_named_above() {
            canvas.text(&self.name, (right, above), Align::End, BLACK);
        } else {
            let place = (right - self.name.depth(), area.centre().1);
            canvas.text_upwards(&self.name, place, Align::Middle, BLACK);
        }
    }
}
