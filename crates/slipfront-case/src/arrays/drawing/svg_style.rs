//! How an element of an SVG is painted: attributes, declarations, and rules for classes.

use roxmltree::{Document, Node};
use slipfront::surface::FillRule;
use svgtypes::Color;

/// Largest number of rules of a file: drawing programs write one for each colour.
const MAX_RULES: usize = 256;

/// Paint of an element, as far as it matters to its outline.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Paint {
    Nothing,
    White,
    Dark,
}

/// Paint, fill rule and visibility that an element of an SVG inherits.
#[derive(Clone, Copy)]
pub(super) struct Style {
    pub(super) fill: Paint,
    pub(super) stroke: Paint,
    pub(super) rule: FillRule,
    pub(super) is_visible: bool,
}

impl Style {
    /// The style of the whole page.
    pub(super) const INITIAL: Self = Self {
        fill: Paint::Dark,
        stroke: Paint::Nothing,
        rule: FillRule::NonZero,
        is_visible: true,
    };
}

/// The rules of a file: for each class, its declarations.
pub(super) struct Rules<'x>(Vec<(&'x str, &'x str)>);

impl<'x> Rules<'x> {
    /// Reads the style sheets.
    pub(super) fn of(document: &'x Document) -> Result<Self, String> {
        let mut rules = Vec::new();
        let sheets = document
            .descendants()
            .filter(|node| node.tag_name().name() == "style");
        for sheet in sheets
            .flat_map(|sheet| sheet.children())
            .filter_map(|node| node.text())
        {
            for rule in sheet.split('}').filter(|rule| !rule.trim().is_empty()) {
                let (selectors, declarations) = rule.split_once('{').unwrap_or((rule, ""));
                for selector in selectors.split(',').map(str::trim) {
                    let class = selector
                        .strip_prefix('.')
                        .filter(|class| !class.contains([' ', '.', ':', '>', '[']));
                    let Some(class) = class else {
                        return Err(format!(
                            "has a style sheet with `{selector}`, and only rules for classes, such as `.cut`, are read: export it \
                             with presentation attributes or inline styles"
                        ));
                    };
                    rules.push((class, declarations));
                }
            }
        }
        if rules.len() > MAX_RULES {
            return Err(format!(
                "has {} rules in style sheets, and at most {MAX_RULES} are read: export it with presentation attributes",
                rules.len()
            ));
        }
        Ok(Self(rules))
    }

    /// A property of an element: of its style, of the last rule for one of its classes, or its attribute.
    pub(super) fn property(&self, node: Node<'x, 'x>, name: &str) -> Option<&'x str> {
        let declared = |text: &'x str| {
            let declarations = text
                .split(';')
                .filter_map(|declaration| declaration.split_once(':'));
            let mut own = declarations.filter(|(key, _)| key.trim() == name);
            own.next_back()
                .map(|(_, value)| value.trim().trim_end_matches("!important").trim())
        };
        let classes = node.attribute("class").unwrap_or_default();
        let rules = self.0.iter().rev();
        let mut of_classes =
            rules.filter(|(class, _)| classes.split_ascii_whitespace().any(|own| own == *class));
        let of_style = node.attribute("style").and_then(declared);
        of_style
            .or_else(|| of_classes.find_map(|(_, declarations)| declared(declarations)))
            .or_else(|| node.attribute(name).map(str::trim))
    }

    /// The style of an element within one of this style.
    pub(super) fn style(&self, node: Node<'x, 'x>, outer: Style) -> Style {
        let property = |name| self.property(node, name).filter(|value| *value != "inherit");
        let paint = |name, opacity, outer| match property(name) {
            _ if property(opacity).is_some_and(is_zero) => Paint::Nothing,
            None => outer,
            Some("none" | "transparent") => Paint::Nothing,
            Some(color) => match color.parse::<Color>() {
                Ok(Color { alpha: 0, .. }) => Paint::Nothing,
                Ok(Color {
                    red: 255,
                    green: 255,
                    blue: 255,
                    ..
                }) => Paint::White,
                _ => Paint::Dark,
            },
        };
        Style {
            fill: paint("fill", "fill-opacity", outer.fill),
            stroke: paint("stroke", "stroke-opacity", outer.stroke),
            rule: match property("fill-rule") {
                None => outer.rule,
                Some("evenodd") => FillRule::EvenOdd,
                Some(_) => FillRule::NonZero,
            },
            is_visible: property("visibility").map_or(outer.is_visible, |value| value == "visible"),
        }
    }

    /// Whether an element and all within it are not drawn.
    pub(super) fn is_hidden(&self, node: Node<'x, 'x>) -> bool {
        self.property(node, "display") == Some("none") || self.property(node, "opacity").is_some_and(is_zero)
    }
}

fn is_zero(opacity: &str) -> bool {
    opacity.trim_end_matches('%').parse() == Ok(0.0)
}
