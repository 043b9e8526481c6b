//! CategoryAxis side by side below a panel.

use crate::canvas::Canvas;
use crate::geometry::{Align, Area};
use crate::style::{BLACK, MARGIN, SIZE_LABEL, SIZE_TICK};
use crate::text::{CAP_HEIGHT, Text};

/// CategoryAxis are broken into at most so many lines, and stand upright if that is not enough.
const MAX_LINES: usize = 3;
const LINE: f64 = 1.25 * SIZE_TICK as f64;
/// Upright names are broken at the first of these lengths if they can, and cut at the last.
const LENGTHS: [f64; 2] = [320.0, 480.0];
/// Between the panel and the names.
const GAP: f64 = 14.0;
/// Between two names.
const APART: f64 = 16.0;

/// CategoryAxis and the title below them.
pub(crate) struct CategoryAxis {
    /// How much room they take below the panel.
    pub(crate) height: f64,
    area: Area,
    lines: Lines,
    title: Text,
}

enum Lines {
    Across(Vec<Vec<Text>>),
    Upright(Vec<Vec<Text>>),
}

impl CategoryAxis {
    /// An upright name's place is no narrower than this.
    pub(crate) const MIN_SLOT: f64 = 1.35 * SIZE_TICK as f64;

    /// CategoryAxis in places of equal width below `area`.
    pub(crate) fn of(names: &[&str], title: &str, area: Area) -> Self {
        let room = area.width / names.len().max(1) as f64 - APART;
        let wrapped: Option<Vec<_>> = names
            .iter()
            .map(|name| Text::wrapped(name, SIZE_TICK, room, MAX_LINES))
            .collect();
        let (lines, deep) = match wrapped {
            Some(names) => {
                let most = names.iter().map(Vec::len).max().unwrap_or(0);
                (Lines::Across(names), LINE * most as f64)
            }
            None => {
                let most = ((room + APART) / LINE).floor().clamp(1.0, MAX_LINES as f64) as usize;
                let upright = |name: &&str| {
                    LENGTHS
                        .into_iter()
                        .find_map(|length| Text::wrapped(name, SIZE_TICK, length, most))
                        .unwrap_or_else(|| vec![Text::shortened(name, SIZE_TICK, LENGTHS[1])])
                };
                let names: Vec<Vec<Text>> = names.iter().map(upright).collect();
                let longest = names.iter().flatten().map(Text::width).fold(0.0, f64::max);
                (Lines::Upright(names), longest)
            }
        };
        let title = Text::fitted(title, area.width);
        let title_room = if title.width() > 0.0 {
            f64::from(SIZE_LABEL) + 8.0
        } else {
            0.0
        };
        Self {
            height: (GAP + deep + title_room + MARGIN).ceil(),
            area,
            lines,
            title,
        }
    }

    /// Draws them.
    pub(crate) fn draw(&self, canvas: &mut Canvas) {
        let top = self.area.bottom() + GAP;
        let cap = CAP_HEIGHT * f64::from(SIZE_TICK);
        match &self.lines {
            Lines::Across(names) => {
                for (index, lines) in names.iter().enumerate() {
                    for (line, text) in lines.iter().enumerate() {
                        let at = (self.middle(index, names.len()), top + cap + LINE * line as f64);
                        canvas.text(text, at, Align::Middle, BLACK);
                    }
                }
            }
            Lines::Upright(names) => {
                for (index, lines) in names.iter().enumerate() {
                    let first = self.middle(index, names.len()) - 0.5 * LINE * (lines.len() as f64 - 1.0);
                    for (line, text) in lines.iter().enumerate() {
                        let at = (first + LINE * line as f64 + 0.5 * cap, top);
                        canvas.text_upwards(text, at, Align::End, BLACK);
                    }
                }
            }
        }
        let middle = self.area.x + 0.5 * self.area.width;
        let baseline = self.area.bottom() + self.height - MARGIN - 4.0;
        canvas.text(&self.title, (middle, baseline), Align::Middle, BLACK);
    }

    /// The middle of a name's place.
    fn middle(&self, index: usize, count: usize) -> f64 {
        self.area.x + self.area.width * (index as f64 + 0.5) / count as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(names: &[&str], width: f64) -> (bool, Vec<usize>) {
        let area = Area {
            x: 0.0,
            y: 0.0,
            width,
            height: 100.0,
        };
        let (upright, lines) = match CategoryAxis::of(names, "", area).lines {
            Lines::Across(lines) => (false, lines),
            Lines::Upright(lines) => (true, lines),
        };
        (upright, lines.iter().map(Vec::len).collect())
    }

    #[test]
    fn names_are_broken_and_then_turned() {
        let names = ["circle", "groove across", "groove along"];
        assert_eq!(lines(&names, 900.0), (false, vec![1, 1, 1]));
        assert_eq!(lines(&names, 450.0), (false, vec![1, 2, 2]));
        assert_eq!(lines(&names, 200.0), (true, vec![1, 1, 1]));
        assert_eq!(lines(&["", " "], 200.0), (false, vec![0, 0]));
    }
}
