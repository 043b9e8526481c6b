//! Short texts with subscripts, and their widths.

use crate::font::advance;
use crate::style::{SIZE_NARROW, SIZE_TEXT};

/// Height of capitals and digits over the font size.
pub(crate) const CAP_HEIGHT: f64 = 0.729;

/// A true minus sign, as wide as a plus.
pub(crate) const MINUS: &str = "\u{2212}";

/// A line of text.
#[derive(Clone, Debug, Default)]
pub(crate) struct Text {
    pub(crate) runs: Vec<TextRun>,
    pub(crate) size: u32,
}

/// Part of a line, all of one size and height.
#[derive(Clone, Debug)]
pub(crate) struct TextRun {
    pub(crate) text: String,
    pub(crate) size: u32,
    /// Distance of the part below the line.
    pub(crate) drop: f64,
}

impl Text {
    /// A text of a user, without markup. Control characters and repeated spaces, which SVG does not keep, are
    /// dropped. Unicode's subscript letters, which the font lacks, become lowered ordinary letters.
    pub(crate) fn plain(text: &str, size: u32) -> Self {
        let words = text.split(|c: char| c.is_whitespace() || c.is_control());
        let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
        let letter = |c| subscript(c).map_or((c, Height::Line), |letter| (letter, Height::Below));
        Self::set(words.join(" ").chars().map(letter), size)
    }

    /// A text in which the character after an underscore is a subscript: `mu_s*`.
    pub(crate) fn math(text: &str, size: u32) -> Self {
        let mut height = Height::Line;
        let letters = text.chars().filter_map(|c| {
            if c == '_' && height == Height::Line {
                height = Height::Below;
                return None;
            }
            Some((c, std::mem::replace(&mut height, Height::Line)))
        });
        Self::set(letters, size)
    }

    /// A number in source notation, such as `1.2e-9`, with its power of ten as a superscript.
    pub(crate) fn number(written: &str, size: u32) -> Self {
        let Some((digits, power)) = written.split_once('e') else {
            return Self::plain(written, size);
        };
        let base = format!("{digits}\u{d7}10");
        let base = if digits == "1" { "10" } else { &base };
        let line = base.chars().map(|c| (c, Height::Line));
        let above = power.chars().map(|c| (c, Height::Above));
        Self::set(line.chain(above), size)
    }

    /// Gathers neighbouring letters of one height into runs.
    fn set(letters: impl Iterator<Item = (char, Height)>, size: u32) -> Self {
        let letters: Vec<(char, Height)> = letters.collect();
        let runs = letters.chunk_by(|a, b| a.1 == b.1).map(|run| {
            let (small, drop) = match run[0].1 {
                Height::Line => (1.0, 0.0),
                Height::Below => (0.72, 0.16),
                Height::Above => (0.72, -0.38),
            };
            TextRun {
                text: run.iter().map(|(c, _)| c).collect(),
                size: (f64::from(size) * small).round() as u32,
                drop: drop * f64::from(size),
            }
        });
        Self {
            runs: runs.collect(),
            size,
        }
    }

    /// A title no wider than `room`: in the usual size, else in the smaller size, else cut.
    pub(crate) fn fitted(text: &str, room: f64) -> Self {
        let whole = Self::plain(text, SIZE_TEXT);
        if whole.width() <= room {
            whole
        } else {
            Self::shortened(text, SIZE_NARROW, room)
        }
    }

    /// The words of a text in at most `most` lines no wider than `room`, if they fit.
    pub(crate) fn wrapped(text: &str, size: u32, room: f64, most: usize) -> Option<Vec<Self>> {
        let mut lines: Vec<String> = Vec::new();
        for word in text.split_whitespace() {
            match lines.last_mut() {
                Some(line) if Self::plain(&format!("{line} {word}"), size).width() <= room => {
                    *line += &format!(" {word}");
                }
                _ => lines.push(word.to_string()),
            }
        }
        let lines: Vec<Self> = lines.iter().map(|line| Self::plain(line, size)).collect();
        (lines.len() <= most && lines.iter().all(|line| line.width() <= room)).then_some(lines)
    }

    pub(crate) fn width(&self) -> f64 {
        self.runs.iter().map(|run| width(&run.text, run.size)).sum()
    }

    /// Height of the text's capitals.
    pub(crate) fn height(&self) -> f64 {
        CAP_HEIGHT * f64::from(self.size)
    }

    /// Depth of the text's lowest letter below the line.
    pub(crate) fn depth(&self) -> f64 {
        let reach = |run: &TextRun| {
            let letters = ['g', 'j', 'p', 'q', 'y', '\u{3bc}', '(', ')', ','];
            let descends = run.text.contains(letters);
            run.drop + if descends { 0.24 * f64::from(run.size) } else { 0.0 }
        };
        self.runs.iter().map(reach).fold(0.0, f64::max)
    }

    /// A plain text cut so that it is at most `width` wide, with an ellipsis for the part that is left out.
    pub(crate) fn shortened(text: &str, size: u32, width: f64) -> Self {
        let whole = Self::plain(text, size);
        if whole.width() <= width {
            return whole;
        }
        let mut kept = text;
        while let Some((last, _)) = kept.char_indices().next_back() {
            kept = &kept[..last];
            let cut = Self::plain(&format!("{}\u{2026}", kept.trim_end()), size);
            if cut.width() <= width {
                return cut;
            }
        }
        Self::plain("", size)
    }
}

/// Vertical position of a letter.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Height {
    Line,
    Below,
    Above,
}

/// Unicode's subscript letters, and the corresponding ordinary letters.
const SUBSCRIPTS: [&str; 2] = [
    "\u{2090}\u{2091}\u{2092}\u{2093}\u{2095}\u{2096}\u{2097}\u{2098}\u{2099}\u{209a}\u{209b}\u{209c}\
     \u{1d62}\u{1d63}\u{1d64}\u{1d65}",
    "aeoxhklmnpstiruv",
];

fn subscript(character: char) -> Option<char> {
    let [small, letters] = SUBSCRIPTS.map(str::chars);
    small
        .zip(letters)
        .find(|(small, _)| *small == character)
        .map(|(_, letter)| letter)
}

/// Width of letters of this size.
pub(crate) fn width(letters: &str, size: u32) -> f64 {
    letters.chars().map(advance).sum::<f64>() * f64::from(size)
}

/// `value` with `decimals` digits after the point and a true minus sign; never a negative zero.
pub(crate) fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().any(|b| b.is_ascii_digit() && b != b'0') => format!("{MINUS}{digits}"),
        Some(digits) => digits.to_string(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_subscript_is_smaller_and_lower() {
        let text = Text::math("\u{3bc}_s* = 1", 30);
        let parts: Vec<_> = text
            .runs
            .iter()
            .map(|r| (r.text.as_str(), r.size < 30, r.drop > 0.0))
            .collect();
        assert_eq!(
            parts,
            [
                ("\u{3bc}", false, false),
                ("s", true, true),
                ("* = 1", false, false)
            ]
        );
    }

    #[test]
    fn subscript_letters_and_powers_become_small_digits() {
        let parts = |text: Text| -> Vec<(String, f64)> {
            let height = |run: TextRun| (run.text, run.drop.signum() * f64::from(u8::from(run.size < 30)));
            text.runs.into_iter().map(height).collect()
        };
        let of = |list: &[(&str, f64)]| -> Vec<(String, f64)> {
            list.iter()
                .map(|(text, drop)| ((*text).to_string(), *drop))
                .collect()
        };
        assert_eq!(
            parts(Text::plain("\u{3bc}\u{209b}* (%)", 30)),
            of(&[("\u{3bc}", 0.0), ("s", 1.0), ("* (%)", 0.0)])
        );
        assert_eq!(
            parts(Text::number("1.2e\u{2212}9", 30)),
            of(&[("1.2\u{d7}10", 0.0), ("\u{2212}9", -1.0)])
        );
        assert_eq!(parts(Text::number("1e4", 30)), of(&[("10", 0.0), ("4", -1.0)]));
    }

    #[test]
    fn words_are_kept_whole_in_their_lines() {
        let lines = |room: f64, most: usize| {
            let lines = Text::wrapped("groove across  it", 30, room, most)?;
            Some(
                lines
                    .iter()
                    .map(|line| line.runs[0].text.clone())
                    .collect::<Vec<_>>(),
            )
        };
        assert_eq!(lines(400.0, 1).unwrap(), ["groove across it"]);
        assert_eq!(lines(150.0, 2).unwrap(), ["groove", "across it"]);
        assert_eq!(lines(120.0, 2), None);
        assert_eq!(lines(30.0, 9), None);
    }

    #[test]
    fn a_long_label_is_cut_to_its_room() {
        let text = Text::shortened("a rather long label of a curve", 30, 200.0);
        assert!(text.width() <= 200.0 && text.runs[0].text.ends_with('\u{2026}'));
        assert_eq!(Text::shortened("short", 30, 200.0).runs[0].text, "short");
        assert!(Text::shortened("no room", 30, 1.0).runs.is_empty());
    }

    #[test]
    fn numbers_have_a_true_minus_and_no_negative_zero() {
        assert_eq!(number(-0.25, 2), "\u{2212}0.25");
        assert_eq!(number(-0.001, 2), "0.00");
    }
}
