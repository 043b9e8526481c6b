//! A colour bar with its name.

use crate::canvas::Canvas;
use crate::frame::{BAR_WIDTH, bar_room, colour_bar};
use crate::geometry::{Align, Area, CanvasPoint};
use crate::style::{BLACK, SIZE_TEXT};
use crate::text::Text;

/// Distance between the numbers and the name.
const GAP: f64 = 14.0;
/// Distance of a name above the bar from the bar, or from the text over the map.
pub(crate) const ABOVE: f64 = 18.0;

/// A colour bar, dark at its foot. The name reads upwards beside the bar, or stands above it where the bar is
/// too short.
pub(crate) struct ColourBar {
    name: Text,
    /// Values at the ends of the bar.
    pub(crate) range: [f64; 2],
    height: f64,
}

impl ColourBar {
    pub(crate) fn of(name: Text, range: [f64; 2], height: f64) -> Self {
        Self { name, range, height }
    }

    /// A bar whose name is as large as other labels, with subscripts after underscores.
    pub(crate) fn labelled(name: &str, range: [f64; 2], height: f64) -> Self {
        Self::of(Text::math(name, SIZE_TEXT), range, height)
    }

    fn is_named_above(&self) -> bool {
        self.name.width() > self.height
    }

    /// Room for a name above the bar.
    pub(crate) fn upper_room(&self) -> f64 {
        if self.is_named_above() {
            ABOVE + f64::from(SIZE_TEXT)
        } else {
            0.0
        }
    }

    /// Width of the bar with its numbers and a name beside them.
    pub(crate) fn room(&self) -> f64 {
        let numbered = bar_room(self.range, self.height);
        if self.is_named_above() || self.name.width() == 0.0 {
            numbered
        } else {
            numbered + GAP + self.name.height() + self.name.depth()
        }
    }

    /// Draws the bar with its upper left corner at `(x, top)`, and its name, if that is above it, on the line
    /// `above`.
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
