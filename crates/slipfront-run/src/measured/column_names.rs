//! Names of columns, with the units in them or in the line below.

use slipfront_case::table::TableLayout;

use super::measure::Measure;

/// The name of a column, with its unit if it has one.
pub(super) struct ColumnName<'t> {
    pub(super) whole: &'t str,
    pub(super) bare: &'t str,
    pub(super) unit: Option<String>,
}

impl<'t> ColumnName<'t> {
    /// The names of all columns of a table; none if it has no line of names.
    pub(super) fn all(layout: &'t TableLayout) -> Vec<Self> {
        let names = layout.names.iter().flat_map(|names| &names.texts);
        names.map(|name| Self::parse(name)).collect()
    }

    /// The parts of a name such as `Force (N)`, `force [N]`, `F / N`, `t/s`, `Time, s`, `Zeit in s`,
    /// `force_n`.
    pub(super) fn parse(whole: &'t str) -> Self {
        let in_brackets = [('(', ')'), ('[', ']')].into_iter().find_map(|(open, close)| {
            let (bare, rest) = whole.split_once(open)?;
            Some((bare.trim(), rest.strip_suffix(close)?.trim()))
        });
        // Without brackets, the last part is a unit only if it is known: `F_max` and `Fx/Fz` have no unit.
        let behind = || {
            [" / ", "/", ", ", " in ", "_"].into_iter().find_map(|sign| {
                let (bare, unit) = whole.rsplit_once(sign)?;
                let (bare, unit) = (bare.trim(), unit.trim());
                (!bare.is_empty() && (is_known(unit) || sign == " / ")).then_some((bare, unit))
            })
        };
        let (bare, unit) = match in_brackets.or_else(behind) {
            Some((bare, unit)) => (bare, Some(unit.to_owned())),
            None => (whole, None),
        };
        Self { whole, bare, unit }
    }
}

/// Units of the columns of a table: the one in the name, or else the one in the line of units.
pub(super) fn units_of(layout: &TableLayout, names: &[ColumnName]) -> Vec<Option<String>> {
    let below = |place: usize| {
        let unit = layout.units.as_ref()?.texts.get(place);
        let unit = unit.map_or("", |text| without_brackets(text));
        // In such a line, an empty unit of a coefficient means the unit 1.
        let is_bare = names.get(place).is_some_and(|name| is_coefficient(name.bare));
        (!unit.is_empty() || is_bare).then(|| unit.to_owned())
    };
    let in_name = |place: usize| names.get(place)?.unit.clone();
    (0..layout.columns)
        .map(|place| in_name(place).or_else(|| below(place)))
        .collect()
}

/// A unit without the brackets around it.
fn without_brackets(text: &str) -> &str {
    text.trim_matches(['(', ')', '[', ']']).trim()
}

/// Whether a unit belongs to a quantity that a column can have, also in lower case as in names.
fn is_known(unit: &str) -> bool {
    let measures = [
        Measure::Time,
        Measure::Displacement,
        Measure::Force,
        Measure::Coefficient,
    ];
    !unit.is_empty()
        && (measures.into_iter().any(|measure| measure.has_unit(unit)) || ["n", "kn", "mn"].contains(&unit))
}

/// Whether a name is usual for a friction coefficient.
pub(super) fn is_coefficient(name: &str) -> bool {
    const NAMES: [&str; 7] = [
        "mu",
        "\u{3bc}",
        "\u{b5}",
        "cof",
        "coefficient",
        "friction coefficient",
        "coefficient of friction",
    ];
    NAMES.contains(&name.trim().to_lowercase().as_str())
}
