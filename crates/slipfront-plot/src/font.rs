//! The font of all pictures, a part of `DejaVu` Sans: widths and outlines of its letters. `font/README.md`
//! describes how the files were made.

use std::collections::HashMap;
use std::sync::LazyLock;

use tiny_skia::{PathBuilder, PathSegment, Point};

/// Font that an SVG embeds.
pub(crate) const WOFF2: &[u8] = include_bytes!("font/DejaVuSans-subset.woff2");
/// Data used to measure and draw text: in each line a character's code, its width and its outline.
const OUTLINES: &str = include_str!("font/outlines.txt");
/// Units of length of the font in the font size.
pub(crate) const UNITS_PER_EM: f32 = 2048.0;

struct Glyph {
    width: f32,
    outline: &'static str,
}

/// The glyphs by the code of their character; `missing` is the glyph for any other.
static GLYPHS: LazyLock<HashMap<&str, Glyph>> = LazyLock::new(|| {
    let glyph = |line: &'static str| {
        let mut parts = line.splitn(3, ' ');
        let (code, width) = (parts.next()?, parts.next()?.parse().ok()?);
        let outline = parts.next().unwrap_or_default();
        Some((code, Glyph { width, outline }))
    };
    OUTLINES.lines().filter_map(glyph).collect()
});

fn glyph(character: char) -> Option<&'static Glyph> {
    GLYPHS.get(format!("{:x}", u32::from(character)).as_str())
}

/// Advance width of `character`, over the font size. A viewer of the SVG takes a character that the font
/// lacks from another font. Such a character gets one em, which is wide enough for nearly all, so that texts
/// do not overlap.
pub(crate) fn advance(character: char) -> f64 {
    f64::from(glyph(character).map_or(1.0, |glyph| glyph.width / UNITS_PER_EM))
}

/// The outline of `character`; a box if the font lacks it. Points are x from the pen and y above the
/// baseline, in units of the font.
pub(crate) fn outline(character: char) -> impl Iterator<Item = PathSegment> {
    let point = Point::from_xy;
    let outline = glyph(character)
        .or_else(|| GLYPHS.get("missing"))
        .map_or("", |glyph| glyph.outline);
    outline
        .split(' ')
        .filter(|command| !command.is_empty())
        .map(move |command| {
            let numbers = command.split(&['M', 'L', 'Q', ',']);
            let coordinates: Vec<f32> = numbers.filter_map(|number| number.parse().ok()).collect();
            match coordinates[..] {
                [x, y] if command.starts_with('M') => PathSegment::MoveTo(point(x, y)),
                [x, y] => PathSegment::LineTo(point(x, y)),
                [cx, cy, x, y] => PathSegment::QuadTo(point(cx, cy), point(x, y)),
                _ => PathSegment::Close,
            }
        })
}

/// Adds the outline of `character` to a path; a box if the font lacks it. `place` maps a point of the outline
/// (x from the pen and y above the baseline, over the font size) to the picture.
pub(crate) fn draw(character: char, path: &mut PathBuilder, place: impl Fn(f32, f32) -> (f32, f32)) {
    let place = |at: Point| Point::from(place(at.x / UNITS_PER_EM, at.y / UNITS_PER_EM));
    for part in outline(character) {
        match part {
            PathSegment::MoveTo(start) => path.move_to(place(start).x, place(start).y),
            PathSegment::LineTo(end) => path.line_to(place(end).x, place(end).y),
            PathSegment::QuadTo(control, end) => {
                let [control, end] = [control, end].map(place);
                path.quad_to(control.x, control.y, end.x, end.y);
            }
            PathSegment::Close => path.close(),
            // TrueType has no cubic curves.
            PathSegment::CubicTo(..) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_as_wide_as_in_the_whole_font() {
        let widths = [
            ' ', '0', 'W', '~', '\u{3bc}', '\u{3c4}', '\u{2212}', '\u{27e8}', '\u{2026}',
        ];
        let units = widths.map(|character| (advance(character) * 2048.0) as u32);
        assert_eq!(units, [651, 1303, 2025, 1716, 1303, 1233, 1716, 799, 2048]);
        assert_eq!(advance('\u{4e00}'), 1.0);
    }

    #[test]
    fn every_line_of_the_file_is_a_glyph_of_known_commands() {
        assert_eq!(GLYPHS.len(), OUTLINES.lines().count());
        assert!(GLYPHS.len() > 590, "{}", GLYPHS.len());
        assert!(GLYPHS.contains_key("missing"));
        for (code, glyph) in &*GLYPHS {
            assert_eq!(
                glyph.outline.matches('M').count(),
                glyph.outline.matches('Z').count(),
                "{code}"
            );
            for command in glyph.outline.split(' ').filter(|command| !command.is_empty()) {
                let expected = match command.split_at(1).0 {
                    "Z" => 0,
                    "M" | "L" => 2,
                    "Q" => 4,
                    other => panic!("{code}: {other}"),
                };
                let numbers = command
                    .split(&['M', 'L', 'Q', ','])
                    .filter(|word| word.parse::<f32>().is_ok());
                assert_eq!(numbers.count(), expected, "{code}: {command}");
            }
        }
    }
}
