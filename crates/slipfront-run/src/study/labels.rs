//! Titles of axes and legends for the keys of a case file and the quantities that are drawn.

use super::summary_values::REDUCTION;
use slipfront_case::case_file::title_of;
use slipfront_plot::QuantityLabel;

/// Titles of the quantities that are drawn: key, words, symbol, unit.
const QUANTITIES: [(&str, &str, &str, &str); 3] = [
    ("static_friction_star", "static friction", "\u{3bc}\u{209b}*", ""),
    (
        "kinetic_friction_star",
        "kinetic friction",
        "\u{3bc}\u{2096}*",
        "",
    ),
    (REDUCTION, "reduction of \u{3bc}\u{209b}*", "", "%"),
];

/// The title of an axis for a key of a case file or a quantity. Quantities that a case file writes with a unit are taken
/// to be in SI units. The second and further textures are numbered. A key without a title is shown as it is.
pub(super) fn title(key: &str) -> String {
    label(key).map_or_else(|| key.to_owned(), |label| label.title())
}

/// The title of a legend for a key.
pub(super) fn symbol(key: &str) -> String {
    label(key).map_or_else(|| key.to_owned(), |label| label.legend())
}

fn label(key: &str) -> Option<QuantityLabel<'_>> {
    let (words, symbol, unit, texture) = match title_of(key) {
        Some((title, texture)) => (title.words, title.symbol, title.unit, texture),
        None => {
            let &(_, words, symbol, unit) = QUANTITIES.iter().find(|row| row.0 == key)?;
            (words, symbol, unit, None)
        }
    };
    let further = texture.filter(|&index| index > 0);
    Some(QuantityLabel {
        words,
        symbol,
        unit,
        texture: further.map(|index| index.saturating_add(1)),
    })
}

#[cfg(test)]
mod tests {
    use slipfront_case::case_file::SECTIONS;
    use slipfront_plot::has_glyphs;

    use super::*;

    #[test]
    fn every_key_has_one_title_that_the_font_can_write() {
        for (index, row) in QUANTITIES.iter().enumerate() {
            assert!(
                QUANTITIES[..index].iter().all(|other| other.0 != row.0),
                "{}",
                row.0
            );
            assert!(has_glyphs(&title(row.0)), "{}", title(row.0));
        }
        for section in &SECTIONS {
            for (index, key) in section.keys.iter().enumerate() {
                assert!(section.keys[..index].iter().all(|other| other.name != key.name));
                let key = format!("{}.{}", section.table(), key.name);
                assert!(has_glyphs(&title(&key)), "{}", title(&key));
            }
        }
    }

    #[test]
    fn textures_after_the_first_are_numbered() {
        assert_eq!(title("drive.v_star"), "drive speed V*");
        assert_eq!(title("texture.0.coverage"), "texture coverage A* (%)");
        assert_eq!(title("my_own_axis"), "my_own_axis");
        assert_eq!(title("texture.0.w"), "cavity shape w");
        assert_eq!(
            title("texture.1.coverage"),
            "texture coverage A* of texture 2 (%)"
        );
        assert_eq!(symbol("texture.1.w"), "cavity shape w of texture 2");
        assert_eq!(title("texture.0.unknown"), "texture.0.unknown");
        assert_eq!(
            title("texture.18446744073709551615.w"),
            "cavity shape w of texture 18446744073709551615"
        );
    }

    #[test]
    fn a_legend_shows_the_symbol() {
        assert_eq!(symbol("friction.sigma_static_star"), "\u{3c3}\u{209b}*");
        assert_eq!(symbol("slider.blocks"), "blocks along a side");
        assert_eq!(symbol("slider.omega_star"), "\u{3a9}*");
        assert_eq!(symbol("texture.0.coverage"), "A* (%)");
        assert_eq!(symbol("shape"), "shape");
    }
}
