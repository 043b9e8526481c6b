//! The legend above a panel with several curves.

use super::canvas::{Align, Canvas};
use super::style::{BLACK, MARGIN, Rgb, SIZE_TICK, WIDTH_CURVE, curve_colour};
use super::text::Text;

/// The names of several curves.
#[derive(Default)]
pub(super) struct Legend {
    /// How much room it takes above the panels.
    pub(super) height: f64,
    entries: Vec<Entry>,
}

struct Entry {
    x: f64,
    y: f64,
    text: Text,
    colour: Rgb,
}

impl Legend {
    const SAMPLE: f64 = 44.0;
    const ROW: f64 = 44.0;

    /// Places the labels in rows between `left` and `right`, from the top of the picture down.
    pub(super) fn of(labels: &[&str], left: f64, right: f64) -> Self {
        let room = right - left - Self::SAMPLE - 10.0;
        let texts: Vec<Text> = labels
            .iter()
            .map(|label| Text::shortened(label, SIZE_TICK, room))
            .collect();
        // Equal columns, so that labels stand under each other.
        let widest = texts.iter().map(Text::width).fold(0.0, f64::max) + Self::SAMPLE + 10.0 + 30.0;
        let columns = ((right - left + 30.0) / widest).floor().max(1.0) as usize;
        let rows = labels.len().div_ceil(columns);
        let entries = texts.into_iter().enumerate().map(|(index, text)| Entry {
            x: left + (index % columns) as f64 * widest,
            y: MARGIN + Self::ROW * ((index / columns) as f64 + 0.5),
            text,
            colour: curve_colour(index, labels.len()),
        });
        Self {
            height: Self::ROW * rows as f64 + 6.0,
            entries: entries.collect(),
        }
    }

    /// Draws it.
    pub(super) fn draw(&self, canvas: &mut Canvas) {
        for Entry { x, y, text, colour } in &self.entries {
            canvas.line((*x, *y), (x + Self::SAMPLE, *y), WIDTH_CURVE, *colour);
            canvas.text(
                text,
                (x + Self::SAMPLE + 10.0, y + 0.5 * text.height()),
                Align::Start,
                BLACK,
            );
        }
    }
}
