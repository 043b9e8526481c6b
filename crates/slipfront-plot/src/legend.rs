//! The legend above a panel with several curves or bars.

use crate::canvas::Canvas;
use crate::geometry::{Align, Area, CanvasPoint};
use crate::series::marker;
use crate::short_names::fitted_names;
use crate::style::{BLACK, MARGIN, OPACITY_BAR, RADIUS_MARKER, SIZE_TEXT, bar_colour, curve_style};
use crate::text::Text;

/// The names of several curves or bars, after the quantity that they are values of.
#[derive(Default)]
pub(crate) struct Legend {
    /// Height of the legend above the panels.
    pub(crate) height: f64,
    title: Text,
    title_at: CanvasPoint,
    entries: Vec<Entry>,
}

/// Sample before a name.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum LegendSample {
    Line,
    /// Points without a line.
    Points,
    /// A line with the curve's marker.
    Marker,
    /// A patch of colour.
    Patch,
}

struct Entry {
    sample: LegendSample,
    x: f64,
    y: f64,
    text: Text,
}

const SAMPLE_WIDTH: f64 = 44.0;
const ROW: f64 = 44.0;
/// Distance between a sample and its name.
const NAME_GAP: f64 = 10.0;
/// Distance between a name and the next sample.
const COLUMN_GAP: f64 = 30.0;

impl Legend {
    /// Places the names in rows between `left` and `right`, from the top of the picture down, with the title
    /// before them, or above them if it is long. Without a name there is no legend.
    pub(crate) fn new<'n>(
        title: &str,
        names: impl Iterator<Item = (&'n str, LegendSample)>,
        left: f64,
        right: f64,
    ) -> Self {
        let (names, samples): (Vec<&str>, Vec<LegendSample>) = names.unzip();
        if names.is_empty() {
            return Self::default();
        }
        let title = Text::shortened(title, SIZE_TEXT, right - left);
        let title_x = left;
        let (left, first) = match title.width() {
            0.0 => (left, 0),
            width @ ..150.0 => (left + width + COLUMN_GAP, 0),
            _ => (left, 1),
        };
        let room = right - left - SAMPLE_WIDTH - NAME_GAP;
        let texts = fitted_names(&names, SIZE_TEXT, room);
        // Equal columns, so that names are aligned.
        let widest = texts.iter().map(Text::width).fold(0.0, f64::max) + SAMPLE_WIDTH + NAME_GAP + COLUMN_GAP;
        let columns = ((right - left + COLUMN_GAP) / widest).floor().max(1.0) as usize;
        let middle = |row: usize| MARGIN + ROW * (row as f64 + 0.5);
        let entry = |(index, text): (usize, Text)| Entry {
            sample: samples[index],
            x: left + (index % columns) as f64 * widest,
            y: middle(first + index / columns),
            text,
        };
        Self {
            height: ROW * (first + names.len().div_ceil(columns)) as f64 + 6.0,
            title_at: (title_x, middle(0) + 0.5 * title.height()),
            title,
            entries: texts.into_iter().enumerate().map(entry).collect(),
        }
    }

    pub(crate) fn draw(&self, canvas: &mut Canvas) {
        canvas.text(&self.title, self.title_at, Align::Start, BLACK);
        for (index, entry) in self.entries.iter().enumerate() {
            let (x, y, style) = (entry.x, entry.y, curve_style(index));
            let (middle, end) = (x + 0.5 * SAMPLE_WIDTH, x + SAMPLE_WIDTH);
            if entry.sample == LegendSample::Patch {
                let patch = Area::new(middle - 14.0, y - 12.0, 28.0, 24.0);
                canvas.fill(patch, bar_colour(index, self.entries.len()), OPACITY_BAR);
            } else if entry.sample == LegendSample::Points {
                for share in [0.2, 0.5, 0.8] {
                    canvas.disc((x + share * SAMPLE_WIDTH, y), 3.0, style.colour);
                }
            } else {
                canvas.curve(vec![(x, y), (end, y)], style);
            }
            if entry.sample == LegendSample::Marker {
                marker(canvas, index, (middle, y), RADIUS_MARKER, style.colour);
            }
            let at = (end + NAME_GAP, y + 0.5 * entry.text.height());
            canvas.text(&entry.text, at, Align::Start, BLACK);
        }
    }
}
