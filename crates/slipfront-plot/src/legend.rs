//! The legend above a panel with several curves or bars.

use crate::canvas::Canvas;
use crate::geometry::{Align, Area};
use crate::markers::marker;
use crate::style::{BLACK, MARGIN, OPACITY_BAR, RADIUS_MARKER, Rgb, SIZE_TICK, WIDTH_CURVE, curve_colour};
use crate::text::Text;

/// The names of several curves or bars.
#[derive(Default)]
pub(crate) struct Legend {
    /// How much room it takes above the panels.
    pub(crate) height: f64,
    sample: Sample,
    /// What the names are values of, and where it stands.
    title: Option<(Text, (f64, f64))>,
    entries: Vec<Entry>,
}

/// What stands before a name.
#[derive(Clone, Copy, Default)]
pub(crate) enum Sample {
    /// A line.
    #[default]
    Line,
    /// A line with the curve's marker.
    Marker,
    /// A patch of colour.
    Patch,
}

struct Entry {
    x: f64,
    y: f64,
    text: Text,
    colour: Rgb,
    /// A line alone, whatever the samples of the others are.
    line: bool,
}

impl Legend {
    const SAMPLE: f64 = 44.0;
    const ROW: f64 = 44.0;

    /// Places the labels in rows between `left` and `right`, from the top of the picture down.
    pub(crate) fn of(labels: &[&str], left: f64, right: f64) -> Self {
        Self::titled("", labels, Sample::Line, left, right)
    }

    /// Places the labels with a title before them, or above them if it is long.
    pub(crate) fn titled(title: &str, labels: &[&str], sample: Sample, left: f64, right: f64) -> Self {
        let title = Text::shortened(title, SIZE_TICK, right - left);
        let width = title.width();
        let (left, first) = match width {
            0.0 => (left, 0),
            ..150.0 => (left + width + 30.0, 0),
            _ => (left, 1),
        };
        let room = right - left - Self::SAMPLE - 10.0;
        let texts: Vec<Text> = labels
            .iter()
            .map(|label| Text::shortened(label, SIZE_TICK, room))
            .collect();
        // Equal columns, so that labels stand under each other.
        let widest = texts.iter().map(Text::width).fold(0.0, f64::max) + Self::SAMPLE + 10.0 + 30.0;
        let columns = ((right - left + 30.0) / widest).floor().max(1.0) as usize;
        let rows = first + labels.len().div_ceil(columns);
        let middle = |row: usize| MARGIN + Self::ROW * (row as f64 + 0.5);
        let entries = texts.into_iter().enumerate().map(|(index, text)| Entry {
            x: left + (index % columns) as f64 * widest,
            y: middle(first + index / columns),
            text,
            colour: curve_colour(index, labels.len()),
            line: false,
        });
        let title_x = if first == 0 { left - width - 30.0 } else { left };
        Self {
            height: Self::ROW * rows as f64 + 6.0,
            sample,
            entries: entries.collect(),
            title: (width > 0.0).then_some((title, (title_x, middle(0)))),
        }
    }

    /// Lets some of the names have a line alone before them.
    pub(crate) fn with_lines(mut self, lines: &[bool]) -> Self {
        for (entry, &line) in self.entries.iter_mut().zip(lines) {
            entry.line = line;
        }
        self
    }

    /// Draws it.
    pub(crate) fn draw(&self, canvas: &mut Canvas) {
        if let Some((title, (x, y))) = &self.title {
            canvas.text(title, (*x, y + 0.5 * title.height()), Align::Start, BLACK);
        }
        for (index, entry) in self.entries.iter().enumerate() {
            let Entry {
                x,
                y,
                text,
                colour,
                line,
            } = entry;
            let middle = x + 0.5 * Self::SAMPLE;
            match self.sample {
                Sample::Line | Sample::Marker => {
                    canvas.line((*x, *y), (x + Self::SAMPLE, *y), WIDTH_CURVE, *colour);
                }
                Sample::Patch => {
                    let area = Area {
                        x: middle - 14.0,
                        y: y - 12.0,
                        width: 28.0,
                        height: 24.0,
                    };
                    canvas.fill(area, *colour, OPACITY_BAR);
                }
            }
            if let (Sample::Marker, false) = (self.sample, line) {
                marker(canvas, index, (middle, *y), RADIUS_MARKER, *colour);
            }
            canvas.text(
                text,
                (x + Self::SAMPLE + 10.0, y + 0.5 * text.height()),
                Align::Start,
                BLACK,
            );
        }
    }
}
