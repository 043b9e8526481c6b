//! Names of categories side by side below a panel.

use crate::canvas::Canvas;
use crate::geometry::{Align, Area};
use crate::style::{BLACK, MARGIN, SIZE_TEXT};
use crate::text::{CAP_HEIGHT, Text};

/// Largest number of lines of a name; a name that needs more is turned upright.
const MAX_LINES: usize = 3;
const LINE: f64 = 1.25 * SIZE_TEXT as f64;
/// Lengths of upright names: a name is wrapped at the first if it fits, else at the second, else cut there.
const LENGTHS: [f64; 2] = [365.0, 550.0];
/// Distance between the panel and the names.
const GAP: f64 = 14.0;
/// Distance between two names.
const APART: f64 = 16.0;
/// Least width of the slot of an upright name.
pub(crate) const MIN_SLOT: f64 = 1.35 * SIZE_TEXT as f64;

/// Names and the title below them.
pub(crate) struct CategoryAxis {
    /// Height of the names and the title below the panel.
    pub(crate) height: f64,
    /// The lines of every name.
    names: Vec<Vec<Text>>,
    upright: bool,
    title: Text,
}

impl CategoryAxis {
    /// Names in slots of equal width below a panel of this width.
    pub(crate) fn new(names: &[&str], title: &str, width: f64) -> Self {
        let room = width / names.len().max(1) as f64 - APART;
        let across = |name: &&str| Text::wrapped(name, SIZE_TEXT, room, MAX_LINES);
        let most = ((room + APART) / LINE).floor().clamp(1.0, MAX_LINES as f64) as usize;
        let upright = |name: &&str| {
            let mut lengths = LENGTHS.into_iter();
            let lines = lengths.find_map(|length| Text::wrapped(name, SIZE_TEXT, length, most));
            lines.unwrap_or_else(|| vec![Text::shortened(name, SIZE_TEXT, LENGTHS[1])])
        };
        let (names, upright, depth) = match names.iter().map(across).collect::<Option<Vec<_>>>() {
            Some(names) => {
                let most = names.iter().map(Vec::len).max().unwrap_or(0);
                (names, false, LINE * most as f64)
            }
            None => {
                let names: Vec<_> = names.iter().map(upright).collect();
                let longest = names.iter().flatten().map(Text::width).fold(0.0, f64::max);
                (names, true, longest)
            }
        };
        let title = Text::fitted(title, width);
        let has_title = title.width() > 0.0;
        let title_room = if has_title {
            f64::from(SIZE_TEXT) + 8.0
        } else {
            0.0
        };
        Self {
            height: (GAP + depth + title_room + MARGIN).ceil(),
            names,
            upright,
            title,
        }
    }

    /// Draws names and title below a panel.
    pub(crate) fn draw(&self, canvas: &mut Canvas, area: Area) {
        let top = area.bottom() + GAP;
        let cap = CAP_HEIGHT * f64::from(SIZE_TEXT);
        for (index, lines) in self.names.iter().enumerate() {
            let middle = area.x + area.width * (index as f64 + 0.5) / self.names.len() as f64;
            let first = middle - 0.5 * LINE * (lines.len() as f64 - 1.0);
            for (line, text) in lines.iter().enumerate() {
                let offset = LINE * line as f64;
                if self.upright {
                    canvas.text_upwards(text, (first + offset + 0.5 * cap, top), Align::End, BLACK);
                } else {
                    canvas.text(text, (middle, top + cap + offset), Align::Middle, BLACK);
                }
            }
        }
        let baseline = area.bottom() + self.height - MARGIN - 4.0;
        canvas.text(&self.title, (area.centre().0, baseline), Align::Middle, BLACK);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(names: &[&str], width: f64) -> (bool, Vec<usize>) {
        let axis = CategoryAxis::new(names, "", width);
        (axis.upright, axis.names.iter().map(Vec::len).collect())
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
