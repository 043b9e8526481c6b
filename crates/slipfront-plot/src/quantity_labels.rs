//! Names of a quantity along an axis and in a legend.

use crate::font::advance;
use crate::text::Text;

/// Title of the time of first slip.
pub const FIRST_SLIP: &str = "first slip t*";
/// Title of the share of the blocks in contact that slide.
pub const SLIDING_SHARE: &str = "sliding fraction";

/// The names of a quantity.
#[derive(Clone, Copy, Debug, Default)]
pub struct QuantityLabel<'a> {
    /// Name of the quantity in words.
    pub words: &'a str,
    /// Symbol of the quantity; empty if it has none. Subscripts are Unicode's subscript letters.
    pub symbol: &'a str,
    /// Unit of the quantity; empty for a number without unit.
    pub unit: &'a str,
    /// Number of the quantity's texture, from 1, where there are several.
    pub texture: Option<usize>,
}

impl QuantityLabel<'_> {
    /// The title of an axis: words, symbol, unit.
    ///
    /// ```
    /// use slipfront_plot::QuantityLabel;
    ///
    /// let coverage = QuantityLabel { words: "texture coverage", symbol: "A*", unit: "%", texture: Some(2) };
    /// assert_eq!(coverage.title(), "texture coverage A* of texture 2 (%)");
    /// ```
    pub fn title(&self) -> String {
        let texture = self.texture.map(|texture| format!("of texture {texture}"));
        let texture = texture.unwrap_or_default();
        let unit = format!("({})", self.unit);
        let unit = if self.unit.is_empty() { "" } else { &unit };
        let mut parts = vec![self.words, self.symbol, &texture, unit];
        parts.retain(|part| !part.is_empty());
        parts.join(" ")
    }

    /// The title of a legend: the symbol and unit of a quantity that has a symbol and belongs to no numbered
    /// texture, else [`title`](Self::title).
    ///
    /// ```
    /// use slipfront_plot::QuantityLabel;
    ///
    /// let damping = QuantityLabel { words: "damping", symbol: "\u{3a9}*", ..QuantityLabel::default() };
    /// assert_eq!(damping.legend(), "\u{3a9}*");
    /// ```
    pub fn legend(&self) -> String {
        if self.symbol.is_empty() || self.texture.is_some() {
            return self.title();
        }
        let short = QuantityLabel { words: "", ..*self };
        short.title()
    }
}

/// Whether the font of the pictures has every character of a text.
pub fn has_glyphs(text: &str) -> bool {
    // A character of unknown width is taken to be as wide as the font is high.
    let runs = Text::plain(text, 100).runs;
    runs.iter()
        .flat_map(|run| run.text.chars())
        .all(|character| advance(character) < 0.99)
}
