//! Lines at the foot of a picture, with the meaning of its intervals or marks.

use crate::canvas::Canvas;
use crate::geometry::Align;
use crate::style::{GREY, MARGIN, SIZE_TEXT};
use crate::text::Text;

/// Largest number of lines of a note; one that needs more is cut.
const MAX_LINES: usize = 3;
/// Height of a line.
const LINE: f64 = SIZE_TEXT as f64 + 8.0;

/// A note, centred below the panel.
pub(crate) struct Note {
    /// Height of the note at the foot of the picture.
    pub(crate) height: f64,
    lines: Vec<Text>,
    middle: f64,
}

impl Note {
    /// A note around `middle` in a picture of this width; an empty one takes no room.
    pub(crate) fn new(text: &str, middle: f64, width: f64) -> Self {
        let room = width - 2.0 * MARGIN;
        let lines = Text::wrapped(text, SIZE_TEXT, room, MAX_LINES);
        let lines = lines.unwrap_or_else(|| vec![Text::shortened(text, SIZE_TEXT, room)]);
        let half = 0.5 * lines.iter().map(Text::width).fold(0.0, f64::max);
        Self {
            height: LINE * lines.len() as f64,
            lines,
            middle: middle.clamp(MARGIN + half, (width - MARGIN - half).max(MARGIN + half)),
        }
    }

    pub(crate) fn draw(&self, canvas: &mut Canvas) {
        let last = canvas.height - MARGIN - 4.0;
        for (above, line) in self.lines.iter().rev().enumerate() {
            let baseline = last - LINE * above as f64;
            canvas.text(line, (self.middle, baseline), Align::Middle, GREY);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_note_takes_the_lines_that_it_needs() {
        let heights = ["", "short", "a note of many words that has no room in one line"]
            .map(|text| Note::new(text, 200.0, 600.0).height / LINE);
        assert_eq!(heights, [0.0, 1.0, 2.0]);
        let endless = Note::new(&"words ".repeat(100), 200.0, 600.0);
        assert_eq!(endless.lines.len(), 1);
        assert!(endless.lines[0].width() <= 600.0 - 2.0 * MARGIN);
    }
}
