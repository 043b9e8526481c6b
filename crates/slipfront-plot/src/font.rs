//! The font of all pictures, a part of `DejaVu` Sans: widths and outlines of its letters. `font/README.md` says how its
//! files were made.

use std::sync::LazyLock;

use skrifa::charmap::Charmap;
use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::GlyphMetrics;
use skrifa::outline::{DrawSettings, OutlineGlyphCollection, OutlinePen};
use skrifa::{FontRef, MetadataProvider};

/// What an SVG embeds.
pub(crate) const WOFF2: &[u8] = include_bytes!("font/DejaVuSans-subset.woff2");
/// What text is measured and drawn with.
const TTF: &[u8] = include_bytes!("font/DejaVuSans-subset.ttf");
/// The font's unit of length: the font size divided by this.
const UNITS_PER_EM: f64 = 2048.0;

struct Font {
    characters: Charmap<'static>,
    metrics: GlyphMetrics<'static>,
    outlines: OutlineGlyphCollection<'static>,
}

#[allow(clippy::expect_used)]
static FONT: LazyLock<Font> = LazyLock::new(|| {
    let font = FontRef::new(TTF).expect("the embedded font is a TrueType file");
    Font {
        characters: font.charmap(),
        metrics: font.glyph_metrics(Size::unscaled(), LocationRef::default()),
        outlines: font.outline_glyphs(),
    }
});

/// How far `character` moves the pen, over the font size. One that the font lacks, which a viewer of the SVG takes from another
/// font, is given an em: wide enough for nearly everything, so that nothing collides.
pub(crate) fn advance(character: char) -> f64 {
    let glyph = FONT.characters.map(character);
    let units = glyph.and_then(|glyph| FONT.metrics.advance_width(glyph));
    units.map_or(1.0, |units| f64::from(units) / UNITS_PER_EM)
}

/// Draws the outline of `character` with its origin at (0, 0) for a font size of 1, y upwards; a box if the font lacks it.
pub(crate) fn draw(character: char, pen: &mut impl OutlinePen) {
    let glyph = FONT.characters.map(character).unwrap_or_default();
    if let Some(outline) = FONT.outlines.get(glyph) {
        let settings = DrawSettings::unhinted(Size::new(1.0), LocationRef::default());
        // An outline of the embedded font, which a test draws whole, cannot be damaged.
        let _ = outline.draw(settings, pen);
    }
}

#[cfg(test)]
mod tests {
    use skrifa::outline::pen::NullPen;

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
    fn every_glyph_can_be_drawn() {
        let font = FontRef::new(TTF).unwrap();
        assert_eq!(
            f64::from(
                font.metrics(Size::unscaled(), LocationRef::default())
                    .units_per_em
            ),
            UNITS_PER_EM
        );
        let mut count = 0;
        for (_, outline) in font.outline_glyphs().iter() {
            let settings = DrawSettings::unhinted(Size::new(1.0), LocationRef::default());
            outline.draw(settings, &mut NullPen).unwrap();
            count += 1;
        }
        assert!(count > 600, "{count}");
    }
}
