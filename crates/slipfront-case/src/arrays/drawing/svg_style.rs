//! How an element of an SVG is painted: attributes, declarations, and rules for classes.

use std::collections::HashMap;

use roxmltree::{Document, Node};
use slipfront::surface::FillRule;
use slipfront_base::text::single_line;
use svgtypes::Color;

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

/// The properties that rules give to a class, each with the number of its rule.
type Declared<'x> = HashMap<&'x str, (usize, &'x str)>;

/// The rules of a file, by class.
pub(super) struct Rules<'x>(HashMap<&'x str, Declared<'x>>);

impl<'x> Rules<'x> {
    /// Reads the style sheets.
    pub(super) fn read(document: &'x Document) -> Result<Self, String> {
        let mut rules: HashMap<&str, Declared> = HashMap::new();
        let elements = document.descendants();
        let sheets = elements.filter(|node| node.tag_name().name() == "style");
        let texts = sheets
            .flat_map(|sheet| sheet.children())
            .filter_map(|node| node.text());
        let all = texts.flat_map(|sheet| sheet.split('}'));
        let all = all.filter(|rule| !rule.trim().is_empty());
        for (number, rule) in all.enumerate() {
            let (selectors, text) = rule.split_once('{').unwrap_or((rule, ""));
            for selector in selectors.split(',').map(str::trim) {
                let class = selector.strip_prefix('.');
                let class = class.filter(|class| !class.contains([' ', '.', ':', '>', '[', '*']));
                let Some(class) = class else {
                    return Err(format!(
                        "has a style sheet with `{}`, and only rules for classes, such as `.cut`, are read: export it with \
                         presentation attributes or inline styles",
                        single_line(&selector.chars().take(40).collect::<String>())
                    ));
                };
                let known = rules.entry(class).or_default();
                known.extend(declarations(text).map(|(name, value)| (name, (number, value))));
            }
        }
        Ok(Self(rules))
    }

    /// A property of an element: of its style, of the last rule for one of its classes, or its attribute.
    pub(super) fn property(&self, node: Node<'x, 'x>, name: &str) -> Option<&'x str> {
        let mut own =
            declarations(node.attribute("style").unwrap_or_default()).filter(|(key, _)| *key == name);
        let classes = node
            .attribute("class")
            .unwrap_or_default()
            .split_ascii_whitespace();
        let of_classes = classes.filter_map(|class| self.0.get(class)?.get(name));
        let own = own.next_back().map(|(_, value)| value);
        own.or_else(|| of_classes.max().map(|(_, value)| *value))
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

/// Names and values of a list of declarations.
fn declarations(text: &str) -> impl DoubleEndedIterator<Item = (&str, &str)> {
    let pairs = text
        .split(';')
        .filter_map(|declaration| declaration.split_once(':'));
    pairs.map(|(name, value)| (name.trim(), value.trim().trim_end_matches("!important").trim()))
}

fn is_zero(opacity: &str) -> bool {
    opacity.trim_end_matches('%').parse() == Ok(0.0)
}
