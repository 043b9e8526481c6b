//! A colour bar with its name.

use crate::canvas::Canvas;
use crate::frame::{BAR_WIDTH, bar_room, colour_bar};
use crate::geometry::{Align, Area, CanvasPoint};
use crate::style::{BLACK, SIZE_TEXT};
use crate::text::Text;

/// Distance between the numbers and the name.
const GAP: f64 = 14.0;
/// Distance from a name above the bar to the bar, or to the text above the map.
pub(crate) const ABOVE: f64 = 18.0;

/// A colour bar, dark at the bottom. The name reads upwards next to the bar, or is above it if the bar is too
/// short.
pub(crate) struct ColourBar {
    name: Text,
    /// Values at the ends of the bar.
    pub(crate) range: [f64; 2],
    height: f64,
}

impl ColourBar {
    pub(crate) fn new(name: Text, range: [f64; 2], height: f64) -> Self {
        Self { name, range, height }
    }

    /// A bar with a name of the same size as other labels; the character after an underscore is a subscript.
    pub(crate) fn labelled(name: &str, range: [f64; 2], height: f64) -> Self {
        Self::new(Text::math(name, SIZE_TEXT), range, height)
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

    /// Width of the bar with its numbers and a name next to them.
    pub(crate) fn room(&self) -> f64 {
        let numbered = bar_room(self.range, self.height);
        if self.is_named_above() || self.name.width() == 0.0 {
            numbered
        } else {
            numbered + GAP + self.name.height() + self.name.depth()
        }
    }

    /// Draws the bar with its upper left corner at `(x, top)`, and its name, if it is above the bar, on the
    /// line `above`.
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
