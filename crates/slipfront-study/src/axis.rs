//! An axis of a study: levels of one key, of several keys together, or of a set of named variants.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::ops::Bound;

use serde::Deserialize;
use toml::Value;

use crate::project_folder::plain_name;
use slipfront_base::number_format::{exact, si_prefix};
use slipfront_base::text::truncated;
use slipfront_case::case_file::{KeyKind, Override, exclude_each_other, key, names_a_file, partners_of};
use slipfront_case::key_rows;
use slipfront_case::quantity::WrittenQuantity;

/// An axis and its levels.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Names of the axis's columns in the tables: the keys, or the name of the variants.
    pub columns: Vec<String>,
    /// Levels of the axis, in order.
    pub levels: Vec<Level>,
    /// Spacing of the levels.
    pub spacing: Spacing,
    /// Unit of the axis's numbers if they are written with one: that of the first level. Empty if levels are
    /// named with their units; none if the numbers are in the unit of the key.
    pub unit: Option<String>,
}

/// One level of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Cells of the level in the columns of the axis.
    pub labels: Vec<String>,
    /// Number of the level on an axis of numbers; for a quantity, in the unit of the axis.
    pub number: Option<f64>,
    /// Keys of the case and their values.
    pub overrides: Vec<Override>,
}

impl Level {
    /// Name of the level in pictures: a pair of equal numbers, such as the blocks of a square slider, is
    /// named by one number.
    pub fn shown(&self) -> String {
        match (self.labels.as_slice(), self.number) {
            ([_], Some(number)) => exact(number),
            (labels, _) => labels.join(" "),
        }
    }
}

/// Spacing of the levels of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// Names or other unordered levels.
    Named,
    /// Numbers or quantities.
    Linear,
    /// Numbers or quantities in equal ratios.
    Logarithmic,
}

key_rows! {
    /// `[[axes]]` as written in the file.
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct AxisKeys {
        /// A key of the case as for `--set`, such as `"drive.v_star"` or `"texture.0.coverage"`.
        key: Option<String> = key("", KeyKind::Special("")),
        /// Values of the key, of any kind: numbers, quantities such as `"50 kPa"`, words, pairs, files.
        list: Option<Vec<Value>> = key("", KeyKind::Special("none twice")),
        /// `[from, to, count]`: values at equal distances, both ends included.
        linspace: Option<Vec<Value>> = key("", KeyKind::Special(
            "two numbers, or two quantities such as `\"50 kPa\"` and `\"1 MPa\"`; count 2 to 100 000")),
        /// `[from, to, count]`: values in equal ratios, both ends included.
        logspace: Option<Vec<Value>> = key("", KeyKind::Special("as `linspace`, with ends above 0")),
        /// A table of lists, equally long; keys with a dot stand in quotes.
        zip: Option<toml::Table> = key("", KeyKind::Special("")),
        /// Name of the axis, which is the name of its column in the tables.
        name: Option<String> = key("", KeyKind::Special("not the name of another column")),
        /// A table of sets of keys, in the order of the pictures. `{}` is the base as it is.
        variants: Option<toml::Table> = key("", KeyKind::Special("")),
    }
}

/// Largest number of levels of one axis.
const MAX_LEVELS: usize = 100_000;

/// Largest length of a key of an axis, in bytes: all keys of a case are shorter. Every level repeats the key,
/// so longer ones would take much memory.
const MAX_KEY: usize = 100;

/// Largest number of keys that a level sets: a case without textures has fewer. Every key is compared with
/// all others, which limits their number.
const MAX_KEYS: usize = 300;

impl Axis {
    pub(crate) fn new(keys: AxisKeys) -> Result<Self, String> {
        let all = keys.key.iter().chain(keys.zip.iter().flat_map(toml::Table::keys));
        if let Some(long) = all.into_iter().find(|key| key.len() > MAX_KEY) {
            return Err(format!(
                "the key `{}` of an axis has {} bytes, more than {MAX_KEY}: give a key of a case, such as drive.v_star",
                truncated(long),
                long.len()
            ));
        }
        let mut axis = Self::read(keys)?;
        axis.check()?;
        axis.set_spacing();
        Ok(axis)
    }

    /// The axis of one of the three forms.
    fn read(keys: AxisKeys) -> Result<Self, String> {
        let AxisKeys {
            key,
            list,
            linspace,
            logspace,
            zip,
            name,
            variants,
        } = keys;
        let has_values = list.is_some() || linspace.is_some() || logspace.is_some();
        match (key, zip, name, variants) {
            (Some(key), None, None, None) => {
                let (values, spacing) = values_of(&key, list, linspace, logspace)?;
                Ok(Self::of_lists(&[(key, values)], spacing))
            }
            (None, Some(zip), None, None) if !has_values => {
                Ok(Self::of_lists(&zipped_lists(zip)?, Spacing::Linear))
            }
            (None, None, Some(name), Some(variants)) if !has_values => Ok(Self {
                columns: vec![name],
                levels: variants.into_iter().map(variant).collect::<Result<_, _>>()?,
                spacing: Spacing::Named,
                unit: None,
            }),
            _ => Err(
                "an axis has `key` with `list`, `linspace` or `logspace`; or `zip`; or `name` with `variants`: no other \
                 combination"
                    .to_owned(),
            ),
        }
    }

    /// The axis of keys that change together, each with the list of its values. All lists have the same
    /// length.
    fn of_lists(lists: &[(String, Vec<Value>)], spacing: Spacing) -> Self {
        let texts = lists.first().filter(|(key, _)| !names_a_file(key));
        let mut quantities = texts.iter().flat_map(|(_, values)| values).filter_map(quantity);
        let first = quantities.next();
        let prefixed = first.as_ref().and_then(|first| with_prefix(first, &lists[0].1));
        let first = prefixed.as_ref().and_then(quantity).or(first);
        let number = |value| match &first {
            Some(first) => quantity(value)?.in_unit_of(first),
            None => number(value),
        };
        let level = |k: usize| Level {
            labels: lists.iter().map(|(key, values)| label(key, &values[k])).collect(),
            number: lists.first().and_then(|(_, values)| number(&values[k])),
            overrides: lists
                .iter()
                .map(|(key, values)| Override::new(key, &values[k]))
                .collect(),
        };
        let count = lists.first().map_or(0, |(_, values)| values.len());
        Self {
            columns: lists.iter().map(|(key, _)| key.clone()).collect(),
            levels: (0..count).map(level).collect(),
            spacing,
            unit: first.as_ref().map(WrittenQuantity::unit),
        }
    }

    fn check(&self) -> Result<(), String> {
        let columns = self.columns.join("`, `");
        if self.levels.is_empty() {
            return Err(format!(
                "the axis of `{columns}` is empty: give it at least one level"
            ));
        }
        for key in self.keys() {
            if key.contains(char::is_whitespace) {
                return Err(format!("the key `{key}` of an axis contains a blank: remove it"));
            }
            if key == "output" || key.starts_with("output.") {
                return Err(format!(
                    "`{key}` changes only the output, not the results of a run: set it in the base, not on an axis"
                ));
            }
        }
        for level in &self.levels {
            let count = level.overrides.len();
            if count > MAX_KEYS {
                return Err(format!(
                    "the level {} sets {count} keys, more than {MAX_KEYS}: move the keys that all levels share to the base",
                    truncated(&level.labels.join(", "))
                ));
            }
            let mut earlier = BTreeSet::new();
            for key in level.overrides.iter().map(Override::key) {
                if let Some(other) = conflict(key, &earlier) {
                    return Err(format!(
                        "the level {} sets `{key}` and `{other}`, and one overwrites the other: keep one of them",
                        truncated(&level.labels.join(", "))
                    ));
                }
                earlier.insert(key);
            }
        }
        let mut seen = HashMap::new();
        let values = |level: &Level| -> BTreeMap<String, String> {
            let sets = level.overrides.iter();
            sets.map(|set| (set.key().to_owned(), meaning(set.key(), &set.value())))
                .collect()
        };
        for level in &self.levels {
            let labels = level.labels.join(", ");
            if let Some(first) = seen.insert(values(level), &level.labels) {
                let first = first.join(", ");
                let also = if first == labels {
                    String::new()
                } else {
                    format!(", also as {first}")
                };
                return Err(format!(
                    "the level {labels} is twice on the axis of `{columns}`{also}: keep one"
                ));
            }
        }
        Ok(())
    }

    /// Sets the spacing. An axis is numeric only if all its levels are different numbers: with zipped keys,
    /// the numbers of the first key may repeat.
    fn set_spacing(&mut self) {
        let mut seen = HashSet::new();
        let mut differs = |level: &Level| level.number.is_some_and(|number| seen.insert(number.to_bits()));
        if !self.levels.iter().all(&mut differs) {
            self.spacing = Spacing::Named;
            // Show all names in the same form: with units, and pairs in full.
            self.levels.iter_mut().for_each(|level| level.number = None);
            self.unit = self.unit.take().map(|_| String::new());
        } else if self.spacing == Spacing::Linear && self.is_nearer_to_ratios() {
            self.spacing = Spacing::Logarithmic;
        }
    }

    /// Whether the numbers of a list, such as 0.01, 0.03, 0.1, fit a logarithmic axis better: they span a
    /// decade, and their median is closer to the geometric mean of the ends than to the arithmetic mean.
    fn is_nearer_to_ratios(&self) -> bool {
        let mut numbers: Vec<f64> = self.levels.iter().filter_map(|level| level.number).collect();
        numbers.sort_by(f64::total_cmp);
        let (Some(&least), Some(&most)) = (numbers.first(), numbers.last()) else {
            return false;
        };
        let median = 0.5 * (numbers[(numbers.len() - 1) / 2] + numbers[numbers.len() / 2]);
        let ratio = |mean: f64| libm::log(median / mean).abs();
        least > 0.0 && most >= 10.0 * least && ratio((least * most).sqrt()) < ratio(0.5 * (least + most))
    }

    /// Keys of the case that the levels set.
    pub(crate) fn keys(&self) -> BTreeSet<&str> {
        let overrides = self.levels.iter().flat_map(|level| &level.overrides);
        overrides.map(Override::key).collect()
    }

    /// Name of the axis in pictures.
    pub fn title(&self) -> &str {
        &self.columns[0]
    }
}

/// The values of an axis of one key, and how they are spaced.
fn values_of(
    key: &str,
    list: Option<Vec<Value>>,
    linspace: Option<Vec<Value>>,
    logspace: Option<Vec<Value>>,
) -> Result<(Vec<Value>, Spacing), String> {
    match (list, linspace, logspace) {
        (Some(list), None, None) => Ok((list, Spacing::Linear)),
        (None, Some(range), None) => {
            let range = SpacingRange::read("linspace", &range)?;
            let (from, to) = (range.from, range.to);
            // Symmetric, so that values from -1 to 1 include exactly 0.
            let value = |share: f64| from * (1.0 - share) + to * share;
            Ok((range.spaced(value)?, Spacing::Linear))
        }
        (None, None, Some(range)) => {
            let range = SpacingRange::read("logspace", &range)?;
            let (from, to) = (range.from, range.to);
            if !(from > 0.0 && to > 0.0) {
                return Err(format!("`logspace` from {from} to {to} must lie above 0"));
            }
            let value = |share: f64| from * libm::pow(to / from, share);
            Ok((range.spaced(value)?, Spacing::Logarithmic))
        }
        _ => Err(format!(
            "the axis of `{key}` needs one of `list`, `linspace` and `logspace`"
        )),
    }
}

/// The keys of `zip` and the lists of their values.
fn zipped_lists(zip: toml::Table) -> Result<Vec<(String, Vec<Value>)>, String> {
    let list = |(key, values)| match values {
        Value::Array(values) => Ok((key, values)),
        _ => Err(format!(
            "`{key}` in `zip` must be a list; write keys with a dot in quotes: \"drive.v_star\""
        )),
    };
    let lists = zip.into_iter().map(list).collect::<Result<Vec<_>, _>>()?;
    let count = lists.first().map_or(0, |(_, values)| values.len());
    match lists.iter().find(|(_, values)| values.len() != count) {
        Some((key, values)) => Err(format!(
            "the lists of `zip` must be equally long: `{key}` has {}, not {count}",
            values.len()
        )),
        None => Ok(lists),
    }
}

/// The level of a named variant and its keys.
fn variant((variant, keys): (String, Value)) -> Result<Level, String> {
    match keys {
        Value::Table(keys) => Ok(Level {
            labels: vec![variant],
            number: None,
            overrides: overrides(&keys),
        }),
        _ => Err(format!(
            "the variant `{variant}` must be a set of keys, such as {{ drive.v_star = 0.05 }}"
        )),
    }
}

/// Magnitudes of numbers that an axis shows without a power of ten.
const PLAIN_NUMBERS: std::ops::Range<f64> = 1e-4..1e6;

/// The quantity 1 in the unit of the first of these values with an SI prefix, if the values would need a
/// power of ten without the prefix.
fn with_prefix(first: &WrittenQuantity, values: &[Value]) -> Option<Value> {
    let numbers = values
        .iter()
        .filter_map(|value| quantity(value)?.in_unit_of(first));
    let largest = numbers.fold(0.0, |largest: f64, number| largest.max(number.abs()));
    if largest == 0.0 || PLAIN_NUMBERS.contains(&largest) {
        return None;
    }
    let (_, prefix) = si_prefix(largest);
    let one = Value::String(format!("1 {prefix}{}", first.unit()));
    // A unit with a prefix cannot have another one.
    quantity(&one)?.in_unit_of(first)?;
    Some(one)
}

/// The value of a level, or one value of a pair of equal ones, such as the blocks along the sides of a
/// square.
fn one_of_pair(value: &Value) -> &Value {
    match value.as_array().map(Vec::as_slice) {
        Some([one, other]) if one == other => one_of_pair(one),
        _ => value,
    }
}

/// The quantity of a level, if its value has a unit; for a pair of equal quantities, one of them.
fn quantity(value: &Value) -> Option<WrittenQuantity<'_>> {
    WrittenQuantity::read(one_of_pair(value).as_str()?)
}

/// The number of a level. A pair of equal numbers counts as one number.
fn number(value: &Value) -> Option<f64> {
    match one_of_pair(value) {
        Value::Integer(number) => Some(*number as f64),
        Value::Float(number) => Some(*number),
        _ => None,
    }
}

/// A text that is equal for values that mean the same: 5 and 5.0, -0.0 and 0, `"1 mm/s"` and `"1000 um/s"`,
/// tables with the same keys in another order.
fn meaning(key: &str, value: &Value) -> String {
    match value {
        Value::Integer(number) => number.to_string(),
        // Integers up to this one are the only numbers with their digits.
        Value::Float(number) if number.fract() == 0.0 && number.abs() < 9e15 => (*number as i64).to_string(),
        Value::String(text) if !names_a_file(key) => match WrittenQuantity::read(text) {
            Some(quantity) => quantity.in_base_units(),
            None => value.to_string(),
        },
        Value::Array(values) => {
            let values: Vec<String> = values.iter().map(|value| meaning(key, value)).collect();
            format!("[{}]", values.join(", "))
        }
        Value::Table(keys) => {
            let values = keys.iter().map(|(key, value)| (key, meaning(key, value)));
            format!("{:?}", values.collect::<BTreeMap<_, _>>())
        }
        other => other.to_string(),
    }
}

fn label(key: &str, value: &Value) -> String {
    match value.as_str() {
        // Independent of the location of the file: next to its case, or copied into a results folder.
        Some(text) if names_a_file(key) => plain_name(text),
        Some(text) => text.to_owned(),
        None => value.to_string(),
    }
}

/// The overrides in a table such as `{ drive.v_star = 0.05 }` or `{ "drive.v_star" = 0.05 }`.
pub fn overrides(keys: &toml::Table) -> Vec<Override> {
    let mut list = Vec::new();
    for (key, value) in keys {
        flatten(key, value, &mut list);
    }
    list
}

fn flatten(key: &str, value: &Value, list: &mut Vec<Override>) {
    // Tables of the case (`drive`) and elements of its lists (`texture.0`) contain keys. Anything else is a
    // value, also a texture with a key `shape`.
    let is_number = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    let leads_on = !key.contains('.') || key.rsplit('.').next().is_some_and(is_number);
    // A key that is too long for any case stays whole, so it is refused once and not for every key in it.
    let leads_on = leads_on && key.len() <= MAX_KEY;
    match value {
        Value::Table(inner) if leads_on && !inner.contains_key("shape") => {
            for (name, value) in inner {
                flatten(&format!("{key}.{name}"), value, list);
            }
        }
        _ => list.push(Override::new(key, value)),
    }
}

/// Whether setting `key` replaces a setting of `earlier`: the keys are equal or partners, or one is a table
/// or list that contains the other.
pub(crate) fn replaces_key(key: &str, earlier: &str) -> bool {
    let rest = earlier.strip_prefix(key);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.')) || exclude_each_other(key, earlier)
}

/// The first of the `other` keys that `key` replaces, or that replaces it.
fn conflict<'k>(key: &str, other: &BTreeSet<&'k str>) -> Option<&'k str> {
    let mut around = other.iter().copied().filter(|other| replaces_key(other, key));
    replaced_key(key, other).or_else(|| around.next())
}

/// The first of the `earlier` keys that setting `key` replaces.
pub(crate) fn replaced_key<'k>(key: &str, earlier: &BTreeSet<&'k str>) -> Option<&'k str> {
    let below = format!("{key}.");
    let partners = partners_of(key);
    let same = earlier
        .get(key)
        .or_else(|| partners.iter().find_map(|partner| earlier.get(partner.as_str())));
    let inside = || {
        earlier
            .range::<str, _>((Bound::Included(below.as_str()), Bound::Unbounded))
            .next()
            .filter(|found| found.starts_with(&below))
    };
    same.or_else(inside).copied()
}

/// The ends of a range, in the unit of the first if they have one, and the number of values.
struct SpacingRange {
    from: f64,
    to: f64,
    unit: Option<String>,
    count: usize,
}

impl SpacingRange {
    fn read(name: &str, range: &[Value]) -> Result<Self, String> {
        let wrong = |what: &str| {
            let given: Vec<String> = range.iter().map(Value::to_string).collect();
            format!("`{name}` is [{}]: {what}", truncated(&given.join(", ")))
        };
        let count = |value| number(value).filter(|count| *count >= 0.0 && count.fract() == 0.0);
        let parts = match range {
            [from, to, last] if !range.iter().any(Value::is_array) => {
                count(last).map(|count| (from, to, count as usize))
            }
            _ => None,
        };
        let Some((from, to, count)) = parts else {
            return Err(wrong(
                "it must be [from, to, count], with two ends and the number of values, such as [0.01, 0.2, 6]",
            ));
        };
        let (ends, unit) = match (quantity(from), quantity(to)) {
            (Some(one), Some(other)) => {
                let ends = one.in_unit_of(&one).zip(other.in_unit_of(&one));
                (ends, Some(one.unit()))
            }
            _ => (number(from).zip(number(to)), None),
        };
        let (from, to) = ends.ok_or_else(|| {
            wrong("its ends must be two numbers, or two quantities of one kind with their units, such as [\"50 kPa\", \"1 MPa\", 5]")
        })?;
        Ok(Self {
            from,
            to,
            unit,
            count,
        })
    }

    /// The values between the ends, both of which are exact. `between` returns the number at a share of the
    /// range.
    fn spaced(&self, between: impl Fn(f64) -> f64) -> Result<Vec<Value>, String> {
        let &Self {
            from,
            to,
            ref unit,
            count,
        } = self;
        if !(2..=MAX_LEVELS).contains(&count) {
            return Err(format!(
                "a spacing of {count} values is not possible: give 2 to {MAX_LEVELS}"
            ));
        }
        if !(from.is_finite() && to.is_finite()) {
            return Err(format!("a spacing from {from} to {to} must have finite ends"));
        }
        let number = |k: usize| match k {
            0 => from,
            k if k == count - 1 => to,
            k => twelve_digits(between(k as f64 / (count - 1) as f64)),
        };
        let value = |number: f64| match unit {
            Some(unit) => Value::String(format!("{} {unit}", exact(number))),
            None => whole_or_not(number),
        };
        Ok((0..count).map(number).map(value).collect())
    }
}

/// A value rounded to twelve digits: short in the tables, and independent of rounding errors of the machine.
fn twelve_digits(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

/// An integer if the value is a whole number: keys such as a seed accept only integers, and all others accept
/// them, too.
fn whole_or_not(value: f64) -> Value {
    const LARGEST: f64 = 9e15;
    if value.fract() == 0.0 && value.abs() < LARGEST {
        Value::Integer(value as i64)
    } else {
        Value::Float(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(overrides: &[Override]) -> Vec<String> {
        overrides.iter().map(Override::to_string).collect()
    }

    fn axis(text: &str) -> Result<Axis, String> {
        Axis::new(toml::from_str(text).unwrap())
    }

    #[test]
    fn spacings_end_exactly_where_they_should() {
        let axis = axis("key = 'drive.v_star'\nlogspace = [0.01, 0.2, 6]").unwrap();
        let numbers: Vec<f64> = axis.levels.iter().filter_map(|level| level.number).collect();
        assert_eq!((numbers[0], numbers[5], numbers.len()), (0.01, 0.2, 6));
        assert!((numbers[1] / numbers[0] - 20f64.powf(0.2)).abs() < 1e-10);
        assert_eq!(axis.spacing, Spacing::Logarithmic);
    }

    #[test]
    fn spacings_are_legible_and_count_where_they_can() {
        let labels = |text: &str| -> Vec<String> {
            let levels = axis(text).unwrap().levels;
            levels.into_iter().flat_map(|level| level.labels).collect()
        };
        assert_eq!(
            labels("key = 'a.b'\nlinspace = [0, 1, 11]").join(" "),
            "0 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 1"
        );
        assert_eq!(
            labels("key = 'a.b'\nlinspace = [-0.3, 0.3, 5]").join(" "),
            "-0.3 -0.15 0 0.15 0.3"
        );
        assert_eq!(
            labels("key = 'a.b'\nlogspace = [1, 100, 3]").join(" "),
            "1 10 100"
        );
    }

    #[test]
    fn lists_are_spaced_as_they_look() {
        for (list, spacing) in [
            ("[0.005, 0.01, 0.03, 0.05, 0.1]", Spacing::Logarithmic),
            ("[1, 10]", Spacing::Linear),
            ("[1, 10, 100]", Spacing::Logarithmic),
            ("[1, 2, 5, 10, 20, 30, 40, 50]", Spacing::Linear),
            ("[0, 1, 10]", Spacing::Linear),
            ("[1, 2, 4]", Spacing::Linear),
            ("[[25, 25], [50, 50]]", Spacing::Linear),
            ("[1, 'two']", Spacing::Named),
        ] {
            let axis = axis(&format!("key = 'a.b'\nlist = {list}")).unwrap();
            assert_eq!(axis.spacing, spacing, "{list}");
        }
        let shown = |list: &str| -> Vec<String> {
            let axis = axis(&format!("key = 'slider.blocks'\nlist = {list}")).unwrap();
            axis.levels.iter().map(Level::shown).collect()
        };
        assert_eq!(shown("[[25, 25]]"), ["25"]);
        assert_eq!(shown("[[10, 10], [20, 10]]"), ["[10, 10]", "[20, 10]"]);
    }

    /// Quantities are numbers in the unit of the first of them, exactly as they were written.
    #[test]
    fn quantities_are_numbers_in_one_unit() {
        let of = |keys: &str| {
            let axis = axis(&format!("key = 'load.pressure'\n{keys}")).unwrap();
            let numbers: Vec<_> = axis.levels.iter().filter_map(|level| level.number).collect();
            let labels: Vec<_> = axis.levels.iter().map(|level| level.labels.join(" ")).collect();
            (
                numbers,
                labels.join(", "),
                axis.spacing,
                axis.unit.unwrap_or_default(),
            )
        };
        let (numbers, labels, spacing, unit) = of("linspace = ['50 kPa', '1 MPa', 5]");
        assert_eq!(numbers, [50.0, 287.5, 525.0, 762.5, 1000.0]);
        assert_eq!(labels, "50 kPa, 287.5 kPa, 525 kPa, 762.5 kPa, 1000 kPa");
        assert_eq!((spacing, unit.as_str()), (Spacing::Linear, "kPa"));
        let (numbers, labels, spacing, unit) = of("logspace = ['0.1 um', '1e-2 mm', 3]");
        assert_eq!(
            (numbers, labels.as_str()),
            (vec![0.1, 1.0, 10.0], "0.1 um, 1 um, 10 um")
        );
        assert_eq!((spacing, unit.as_str()), (Spacing::Logarithmic, "um"));
        // Listed values are kept as written, and 0.3 MPa equals 300 kPa to the last bit.
        let (numbers, labels, spacing, _) = of("list = ['0.7 kPa', '0.3 MPa', '100 Pa']");
        assert_eq!(
            (numbers, labels.as_str()),
            (vec![0.7, 300.0, 0.1], "0.7 kPa, 0.3 MPa, 100 Pa")
        );
        assert_eq!(spacing, Spacing::Logarithmic);
        let (numbers, ..) = of("list = [['1 um', '1 um'], ['2 um', '2 um']]");
        assert_eq!(numbers, [1.0, 2.0]);
        // If numbers in the unit of the first value would need powers of ten, the unit gets a prefix, if
        // possible.
        let (numbers, _, _, unit) = of("list = ['1e-6 m', '3e-6 m', '7e-6 m']");
        assert_eq!((numbers, unit.as_str()), (vec![1.0, 3.0, 7.0], "um"));
        let (numbers, _, _, unit) = of("list = ['2e9 Pa', '1e8 Pa']");
        assert_eq!((numbers, unit.as_str()), (vec![2.0, 0.1], "GPa"));
        let (numbers, _, _, unit) = of("list = ['1e-6 mm', '2e-6 mm']");
        assert_eq!((numbers, unit.as_str()), (vec![1e-6, 2e-6], "mm"));
        // Values of several kinds are names, with their units.
        let (numbers, _, spacing, unit) = of("list = ['1 um', 'auto', '2 um']");
        assert_eq!((numbers.len(), spacing, unit.as_str()), (0, Spacing::Named, ""));
        let zipped =
            axis("zip = { 'load.pressure' = ['1 kPa', '1 MPa'], 'friction.seed' = [1, 2] }").unwrap();
        assert_eq!(
            (zipped.spacing, zipped.unit.as_deref()),
            (Spacing::Linear, Some("kPa"))
        );
        // A name of a file is a name, even if it looks like a quantity.
        let files = axis("key = 'friction.mu_static_field'\nlist = ['1 m', '2 m']").unwrap();
        assert_eq!(files.spacing, Spacing::Named);
    }

    #[test]
    fn ends_of_two_kinds_are_refused() {
        for range in [
            "['50 kPa', 1, 5]",
            "['50 kPa', '1 mm', 5]",
            "['50', '60', 5]",
            "['1 psi', '2 psi', 5]",
        ] {
            let said = axis(&format!("key = 'load.pressure'\nlinspace = {range}")).unwrap_err();
            assert!(
                said.contains("its ends must be two numbers, or two quantities of one kind"),
                "{said}"
            );
        }
    }

    #[test]
    fn a_level_twice_is_refused_and_repeated_numbers_are_names() {
        for list in [
            "[1, 2, 1]",
            "[5, 5.0, 10]",
            "[0.0, 1.0, -0.0]",
            "['1 mm/s', '1000 um/s']",
            "['-0 m', '0 um']",
            "[['1 um', 2], ['1000 nm', 2.0]]",
            "[{ x = 1, y = '1 kPa' }, { y = '1000 Pa', x = 1.0 }]",
            "['auto', '1 s', 'auto']",
        ] {
            let said = axis(&format!("key = 'a.b'\nlist = {list}")).unwrap_err();
            assert!(said.contains("is twice on the axis of `a.b`"), "{said}");
        }
        let variants =
            "name = 'v'\nvariants = { a = { b.c = '1 m', b.d = 1 }, e = { b.d = 1.0, b.c = '1000 mm' } }";
        assert!(axis(variants).unwrap_err().contains("is twice"));
        for list in [
            "['1 m', '1 s']",
            "[9007199254740992, 9007199254740993]",
            "['1 m', '1.0000000000000002 m']",
        ] {
            axis(&format!("key = 'a.b'\nlist = {list}")).unwrap();
        }
        // A name of a file means no quantity.
        axis("key = 'texture.0.file'\nlist = ['1 m', '1000 mm']").unwrap();
        let zipped = axis("zip = { 'a.b' = [1, 1], 'c.d' = [1, 2] }").unwrap();
        assert_eq!(zipped.spacing, Spacing::Named);
    }

    #[test]
    fn elements_of_lists_are_ways_to_keys() {
        let keys: toml::Table = toml::from_str(
            "texture.0.coverage = 5\ntexture.1 = { shape = 'groove' }\noutput.snapshots = { every = 2.0 }",
        )
        .unwrap();
        assert_eq!(
            texts(&overrides(&keys)),
            [
                "texture.0.coverage=5",
                "texture.1={ shape = \"groove\" }",
                "output.snapshots={ every = 2.0 }"
            ]
        );
    }

    #[test]
    fn keys_replace_their_tables_and_partners() {
        assert!(replaces_key("texture", "texture.0.coverage"));
        assert!(replaces_key("drive.v_star", "drive.v_star"));
        assert!(replaces_key("drive.speed", "drive.v_star"));
        assert!(!replaces_key("texture.0.coverage", "texture"));
        assert!(!replaces_key("drive.v", "drive.v_star"));
        let earlier = ["drive.v_star", "slider.blocks", "texture.0.coverage", "texture0"].into();
        assert_eq!(replaced_key("texture", &earlier), Some("texture.0.coverage"));
        assert_eq!(replaced_key("drive.v_star", &earlier), Some("drive.v_star"));
        assert_eq!(replaced_key("drive.speed", &earlier), Some("drive.v_star"));
        assert_eq!(
            replaced_key("texture.0.lambda", &earlier),
            Some("texture.0.coverage")
        );
        for other in ["drive.v", "texture.0.coverage.x", "slider.omega_star", "tex"] {
            assert_eq!(replaced_key(other, &earlier), None);
        }
    }

    #[test]
    fn variants_keep_their_order_and_flatten_their_keys() {
        let text = "name = 'shape'\n[variants]\nzebra = { texture = [{ shape = 'groove', coverage = 10 }] }\n\
                    apple = { drive.v_star = 0.1, 'load.redistribute' = false }";
        let axis = axis(text).unwrap();
        assert_eq!(axis.levels[0].labels, ["zebra"]);
        assert_eq!(
            texts(&axis.levels[0].overrides),
            ["texture=[{ shape = \"groove\", coverage = 10 }]"]
        );
        assert_eq!(
            texts(&axis.levels[1].overrides),
            ["drive.v_star=0.1", "load.redistribute=false"]
        );
    }

    #[test]
    fn zipped_keys_change_together() {
        let axis =
            axis("zip = { 'slider.blocks' = [[25, 25], [50, 50]], 'friction.seed' = [1, 2] }").unwrap();
        assert_eq!(axis.columns, ["slider.blocks", "friction.seed"]);
        assert_eq!(
            texts(&axis.levels[1].overrides),
            ["slider.blocks=[50, 50]", "friction.seed=2"]
        );
        assert_eq!(axis.levels[1].number, Some(50.0));
        assert!(crate::Axis::new(toml::from_str("zip = { a = [1], b = [1, 2] }").unwrap()).is_err());
    }

    /// Every key is compared with all others, which would take minutes for a file of 300 kB.
    #[test]
    fn more_keys_than_a_case_has_are_refused() {
        let keys =
            |value: &str| -> String { (0..400).map(|k| format!("'friction.a{k}' = {value}, ")).collect() };
        for text in [
            format!("zip = {{ {} }}", keys("[1]")),
            format!("name = 'a'\nvariants = {{ b = {{ {} }} }}", keys("1")),
        ] {
            let said = axis(&text).unwrap_err();
            assert!(said.contains("sets 400 keys, more than 300"), "{said}");
        }
    }

    /// A few megabytes of text must not expand to terabytes.
    #[test]
    fn long_keys_are_not_repeated_in_every_level() {
        let long = "k".repeat(100_000);
        for text in [
            format!("key = '{long}'\nlinspace = [0, 1, 100000]"),
            format!("zip = {{ {long} = [1, 2, 3] }}"),
        ] {
            let said = axis(&text).unwrap_err();
            assert!(
                said.contains("has 100000 bytes, more than 100") && said.len() < 300,
                "{said}"
            );
        }
        let keys: String = (0..1000).map(|k| format!("k{k} = 1, ")).collect();
        let keys: toml::Table = format!("{long} = {{ {keys} }}").parse().unwrap();
        assert_eq!(overrides(&keys).len(), 1);
    }

    #[test]
    fn empty_and_ambiguous_axes_are_refused() {
        for text in [
            "key = 'a'\nlist = []",
            "key = 'a'",
            "key = 'a'\nlist = [1]\nlinspace = [0, 1, 2]",
            "name = 'x'",
        ] {
            assert!(axis(text).is_err(), "{text}");
        }
        for range in ["[0, 1]", "[0, 1, 2.5]", "[0, 1, 5, 7]", "[0, 1, -5]"] {
            let said = axis(&format!("key = 'a'\nlinspace = {range}")).unwrap_err();
            let expected = format!("`linspace` is {range}: it must be [from, to, count]");
            assert!(said.starts_with(&expected), "{said}");
        }
    }
}
