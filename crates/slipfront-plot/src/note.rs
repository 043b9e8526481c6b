//! A line at the foot of a picture, with the meaning of its intervals.

use crate::canvas::Canvas;
use crate::geometry::Align;
use crate::style::{GREY, MARGIN, SIZE_TEXT};
use crate::text::Text;

/// A note, centred below the panel.
pub(crate) struct Note {
    /// Height of the note at the foot of the picture.
    pub(crate) height: f64,
    text: Text,
    middle: f64,
}

impl Note {
    /// A note around `middle` in a picture of this width; an empty one takes no room.
    pub(crate) fn of(text: &str, middle: f64, width: f64) -> Self {
        let text = Text::shortened(text, SIZE_TEXT, width - 2.0 * MARGIN);
        let half = 0.5 * text.width();
        let height = if half > 0.0 {
            f64::from(SIZE_TEXT) + 8.0
        } else {
            0.0
        };
        Self {
            height,
            text,
            middle: middle.clamp(MARGIN + half, (width - MARGIN - half).max(MARGIN + half)),
        }
    }

    pub(crate) fn draw(&self, canvas: &mut Canvas) {
        let baseline = canvas.height - MARGIN - 4.0;
        canvas.text(&self.text, (self.middle, baseline), Align::Middle, GREY);
    }
}
