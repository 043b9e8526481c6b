//! Titles of axes and legends for the keys of a case file and the quantities that are drawn.

use crate::axis::{Axis, Spacing};
use crate::meshed_coverage::MeshedCoverage;
use crate::plan::Plan;
use crate::summary_values::REDUCTION;
use slipfront_case::case_file::title_of;
use slipfront_plot::QuantityLabel;
use slipfront_run::summary::TITLES;

/// The title of a quantity; its name if it has none.
pub fn title(quantity: &str) -> String {
    label(quantity).map_or_else(|| quantity.to_owned(), |label| label.title())
}

/// The symbol of a quantity; empty if it has none.
pub(crate) fn quantity_symbol(quantity: &str) -> &'static str {
    label(quantity).map_or("", |label| label.symbol)
}

/// The title of an axis, with the unit of its numbers. The second and further textures are numbered. A key
/// without a title is shown unchanged.
pub(crate) fn axis_title(axis: &Axis) -> String {
    in_its_unit(axis, |label| label.title())
}

/// The title of a legend for the levels of an axis.
pub(crate) fn axis_symbol(axis: &Axis) -> String {
    in_its_unit(axis, |label| label.legend())
}

/// The title of an axis, which says if its coverages are meshed ones.
pub(crate) fn titled(title: String, is_meshed: bool) -> String {
    match is_meshed {
        true => format!("meshed {title}"),
        false => title,
    }
}

/// Labels of an axis in pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisLabels {
    /// Title of the axis as the study asks for it.
    pub title: String,
    /// Title of the axis as it is drawn.
    pub drawn_title: String,
    /// Title of a legend for the axis as it is drawn.
    pub drawn_symbol: String,
    /// Whether pictures show meshed coverages in place of the levels.
    pub is_meshed: bool,
    /// Labels of levels where several axes are named: symbol, value and unit.
    pub levels: Vec<String>,
}

/// Labels of the axes of a study in pictures.
pub fn axis_labels(plan: &Plan) -> Vec<AxisLabels> {
    let meshed = MeshedCoverage::from_plan(plan).map(|meshed| meshed.axis);
    let labels = plan.axes.iter().enumerate().map(|(position, axis)| {
        let is_meshed = meshed == Some(position);
        let levels = axis.levels.iter();
        AxisLabels {
            title: axis_title(axis),
            drawn_title: titled(axis_title(axis), is_meshed),
            drawn_symbol: titled(axis_symbol(axis), is_meshed),
            is_meshed,
            levels: levels
                .map(|level| level_with_symbol(axis, level.shown()))
                .collect(),
        }
    });
    labels.collect()
}

/// Label of a level where several axes are named: its symbol, value and unit; only the name if the axis has
/// names.
pub(crate) fn level_with_symbol(axis: &Axis, shown: String) -> String {
    if axis.spacing == Spacing::Named {
        return shown;
    }
    in_its_unit(axis, |label| {
        let symbol = QuantityLabel { unit: "", ..label }.legend();
        format!("{symbol} = {shown} {}", label.unit).trim_end().to_owned()
    })
}

fn in_its_unit(axis: &Axis, write: impl Fn(QuantityLabel) -> String) -> String {
    let key = axis.title();
    let unit = axis.unit.as_deref().map(printed);
    let label = label(key).unwrap_or(QuantityLabel {
        words: key,
        ..QuantityLabel::default()
    });
    write(QuantityLabel {
        unit: unit.as_deref().unwrap_or(label.unit),
        ..label
    })
}

/// A unit as pictures print it: with a micro sign and raised powers.
fn printed(unit: &str) -> String {
    let symbol = |symbol: &str| match symbol.strip_prefix('u') {
        Some(rest) if rest.starts_with(char::is_alphabetic) => format!("\u{b5}{rest}"),
        _ => symbol.to_owned(),
    };
    let symbols: String = unit.split_inclusive(['/', '*', ' ']).map(symbol).collect();
    let raised = symbols.replace("^2", "\u{b2}").replace("^3", "\u{b3}");
    raised.replace('*', "\u{b7}")
}

/// The label of a key of a case file or of a quantity; none if its name is used instead.
fn label(name: &str) -> Option<QuantityLabel<'static>> {
    if let Some((title, texture)) = title_of(name) {
        return Some(QuantityLabel {
            words: title.words,
            symbol: title.symbol,
            unit: title.unit,
            texture: texture
                .filter(|&index| index > 0)
                .map(|index| index.saturating_add(1)),
        });
    }
    if name == REDUCTION {
        return Some(QuantityLabel {
            words: "reduction of \u{3bc}\u{209b}*",
            unit: "%",
            ..QuantityLabel::default()
        });
    }
    let (_, words, symbol) = TITLES.iter().find(|(titled, ..)| *titled == name)?;
    Some(QuantityLabel {
        words,
        symbol,
        ..QuantityLabel::default()
    })
}

#[cfg(test)]
mod tests {
    use slipfront_case::case_file::SECTIONS;
    use slipfront_plot::has_glyphs;

    use super::*;
    use crate::axis::Level;

    fn axis(key: &str, unit: Option<&str>) -> Axis {
        Axis {
            columns: vec![key.to_owned()],
            levels: Vec::new(),
            spacing: Spacing::Linear,
            unit: unit.map(str::to_owned),
        }
    }

    fn title_of_key(key: &str) -> String {
        axis_title(&axis(key, None))
    }

    fn symbol(key: &str) -> String {
        axis_symbol(&axis(key, None))
    }

    #[test]
    fn an_axis_has_the_unit_of_its_numbers() {
        for (key, unit, expected) in [
            ("load.pressure", Some("kPa"), "pressure P (kPa)"),
            ("load.pressure", Some(""), "pressure P"),
            ("slider.block_size", Some("um"), "block size l (\u{b5}m)"),
            ("slider.density", Some("g/cm^3"), "density \u{3c1} (g/cm\u{b3})"),
            ("load.pressure", Some("N*um^-2"), "pressure P (N\u{b7}\u{b5}m^-2)"),
            ("my_own_axis", Some("kPa"), "my_own_axis (kPa)"),
        ] {
            assert_eq!(axis_title(&axis(key, unit)), expected);
        }
        assert_eq!(axis_symbol(&axis("load.pressure", Some("MPa"))), "P (MPa)");
    }

    #[test]
    fn a_level_beside_others_has_its_symbol_and_unit() {
        let of = |key: &str, unit, label: &str, number: Option<f64>| {
            let level = Level {
                labels: vec![label.to_owned()],
                number,
                overrides: Vec::new(),
            };
            let spacing = number.map_or(Spacing::Named, |_| Spacing::Linear);
            let axis = Axis {
                levels: vec![level],
                spacing,
                ..axis(key, unit)
            };
            let shown = axis.levels[0].shown();
            level_with_symbol(&axis, shown)
        };
        let pressure = of("load.pressure", Some("kPa"), "0.05 MPa", Some(50.0));
        assert_eq!(pressure, "P = 50 kPa");
        assert_eq!(of("drive.v_star", None, "0.1", Some(0.1)), "V* = 0.1");
        assert_eq!(of("texture.0.coverage", None, "10", Some(10.0)), "A* = 10 %");
        assert_eq!(
            of("slider.blocks", None, "[50, 50]", Some(50.0)),
            "blocks along a side = 50"
        );
        assert_eq!(of("shape", None, "circle", None), "circle");
    }

    #[test]
    fn every_key_has_one_title_that_the_font_can_write() {
        let names = [TITLES.map(|(name, ..)| name).as_slice(), &[REDUCTION]].concat();
        for (index, name) in names.iter().enumerate() {
            assert!(!names[..index].contains(name), "{name}");
            assert!(has_glyphs(&title(name)), "{}", title(name));
        }
        for section in &SECTIONS {
            for (index, key) in section.keys.iter().enumerate() {
                assert!(section.keys[..index].iter().all(|other| other.name != key.name));
                let key = format!("{}.{}", section.table(), key.name);
                assert!(has_glyphs(&title_of_key(&key)), "{}", title_of_key(&key));
            }
        }
    }

    #[test]
    fn textures_after_the_first_are_numbered() {
        assert_eq!(title_of_key("drive.v_star"), "drive speed V*");
        assert_eq!(title_of_key("texture.0.coverage"), "texture coverage A* (%)");
        assert_eq!(title_of_key("my_own_axis"), "my_own_axis");
        assert_eq!(title_of_key("texture.0.w"), "cavity shape w");
        assert_eq!(
            title_of_key("texture.1.coverage"),
            "texture coverage A* of texture 2 (%)"
        );
        assert_eq!(symbol("texture.1.w"), "cavity shape w of texture 2");
        assert_eq!(title_of_key("texture.0.unknown"), "texture.0.unknown");
        assert_eq!(
            title_of_key("texture.18446744073709551615.w"),
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
