//! An axis of a study: the levels that one key, several keys together, or a set of named variants take.

use serde::Deserialize;
use toml::Value;

/// An axis and its levels.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Names of its columns in the tables: the keys, or the name of the variants.
    pub columns: Vec<String>,
    /// Its levels, in order.
    pub levels: Vec<Level>,
    /// How its levels are spaced.
    pub spacing: Spacing,
}

/// One level of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// What stands in its columns.
    pub labels: Vec<String>,
    /// Its number, if it is one.
    pub number: Option<f64>,
    /// Keys of the case and their values, as for `--set`.
    pub overrides: Vec<String>,
}

/// How the levels of an axis are spaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// Names or other things without order.
    Named,
    /// Numbers.
    Linear,
    /// Numbers in equal ratios.
    Logarithmic,
}

/// `[[axes]]` as it stands in the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AxisKeys {
    key: Option<String>,
    list: Option<Vec<Value>>,
    linspace: Option<(f64, f64, usize)>,
    logspace: Option<(f64, f64, usize)>,
    zip: Option<toml::Table>,
    name: Option<String>,
    variants: Option<toml::Table>,
}

/// Most levels of one axis.
const MAX_LEVELS: usize = 100_000;

impl Axis {
    pub(super) fn new(keys: AxisKeys) -> Result<Self, String> {
        let axis = match keys {
            AxisKeys {
                key: Some(key),
                zip: None,
                name: None,
                variants: None,
                list,
                linspace,
                logspace,
            } => {
                let (values, spacing) = match (list, linspace, logspace) {
                    (Some(list), None, None) => (list, Spacing::Linear),
                    (None, Some((from, to, count)), None) => {
                        (spaced(from, to, count, linear)?, Spacing::Linear)
                    }
                    (None, None, Some((from, to, count))) => {
                        if !(from > 0.0 && to > 0.0) {
                            return Err(format!("`logspace` from {from} to {to} must lie above 0"));
                        }
                        (spaced(from, to, count, logarithmic)?, Spacing::Logarithmic)
                    }
                    _ => {
                        return Err(format!(
                            "the axis of `{key}` needs one of `list`, `linspace` and `logspace`"
                        ));
                    }
                };
                let levels = values.iter().map(|value| level(&[&key], &[value])).collect();
                Self {
                    columns: vec![key],
                    levels,
                    spacing,
                }
            }
            AxisKeys {
                zip: Some(zip),
                key: None,
                name: None,
                variants: None,
                list: None,
                linspace: None,
                logspace: None,
            } => zipped(&zip)?,
            AxisKeys {
                name: Some(name),
                variants: Some(variants),
                key: None,
                zip: None,
                list: None,
                linspace: None,
                logspace: None,
            } => named(name, &variants)?,
            _ => {
                return Err(
                    "an axis has `key` with `list`, `linspace` or `logspace`; or `zip`; or `name` with \
                            `variants`: nothing else together"
                        .to_owned(),
                );
            }
        };
        if axis.levels.is_empty() {
            return Err(format!(
                "the axis of `{}` is empty: give it at least one level",
                axis.columns.join("`, `")
            ));
        }
        Ok(axis.with_numbers_or_names())
    }

    /// An axis is one of numbers only if all its levels are.
    fn with_numbers_or_names(mut self) -> Self {
        if self.levels.iter().any(|level| level.number.is_none()) {
            self.spacing = Spacing::Named;
        }
        self
    }

    /// The name under which pictures show it.
    pub fn title(&self) -> &str {
        &self.columns[0]
    }
}

/// Values of several keys that change together.
fn zipped(zip: &toml::Table) -> Result<Axis, String> {
    let mut lists = Vec::new();
    for (key, values) in zip {
        let Value::Array(values) = values else {
            return Err(format!(
                "`{key}` in `zip` must be a list; keys with a dot stand in quotes: \"drive.v_star\""
            ));
        };
        lists.push((key.as_str(), values));
    }
    let count = lists.first().map_or(0, |(_, values)| values.len());
    if let Some((key, values)) = lists.iter().find(|(_, values)| values.len() != count) {
        return Err(format!(
            "the lists of `zip` must be equally long: `{key}` has {}, not {count}",
            values.len()
        ));
    }
    let keys: Vec<&str> = lists.iter().map(|(key, _)| *key).collect();
    let levels = (0..count)
        .map(|k| {
            level(
                &keys,
                &lists.iter().map(|(_, values)| &values[k]).collect::<Vec<_>>(),
            )
        })
        .collect();
    Ok(Axis {
        columns: keys.into_iter().map(str::to_owned).collect(),
        levels,
        spacing: Spacing::Linear,
    })
}

fn named(name: String, variants: &toml::Table) -> Result<Axis, String> {
    let level = |(variant, keys): (&String, &Value)| match keys {
        Value::Table(keys) => Ok(Level {
            labels: vec![variant.clone()],
            number: None,
            overrides: overrides(keys),
        }),
        _ => Err(format!(
            "the variant `{variant}` must be a set of keys, such as {{ drive.v_star = 0.05 }}"
        )),
    };
    let levels = variants.iter().map(level).collect::<Result<_, _>>()?;
    Ok(Axis {
        columns: vec![name],
        levels,
        spacing: Spacing::Named,
    })
}

fn level(keys: &[&str], values: &[&Value]) -> Level {
    Level {
        labels: values.iter().map(|value| label(value)).collect(),
        number: values.first().and_then(|value| number(value)),
        overrides: keys
            .iter()
            .zip(values)
            .map(|(key, value)| format!("{key}={value}"))
            .collect(),
    }
}

/// The number of a level. A pair of equal ones counts as one: the blocks along each side of a square.
fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Integer(number) => Some(*number as f64),
        Value::Float(number) => Some(*number),
        Value::Array(pair) => match pair.as_slice() {
            [one, other] if one == other => number(one),
            _ => None,
        },
        _ => None,
    }
}

fn label(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Keys of a table, `{ drive.v_star = 0.05 }` or `{ "drive.v_star" = 0.05 }`, as for `--set`.
pub(super) fn overrides(keys: &toml::Table) -> Vec<String> {
    let mut list = Vec::new();
    for (key, value) in keys {
        match value {
            // A table of the case, not a value that is written as one.
            Value::Table(inner) if !key.contains('.') => {
                list.extend(inner.iter().map(|(name, value)| format!("{key}.{name}={value}")));
            }
            _ => list.push(format!("{key}={value}")),
        }
    }
    list
}

/// `count` values from `from` to `to`, both exactly.
fn spaced(from: f64, to: f64, count: usize, between: fn(f64, f64, f64) -> f64) -> Result<Vec<Value>, String> {
    if !(2..=MAX_LEVELS).contains(&count) {
        return Err(format!(
            "a spacing of {count} values cannot be: give 2 to {MAX_LEVELS}"
        ));
    }
    if !(from.is_finite() && to.is_finite()) {
        return Err(format!("a spacing from {from} to {to} must have finite ends"));
    }
    let value = |k: usize| match k {
        0 => from,
        k if k == count - 1 => to,
        k => between(from, to, k as f64 / (count - 1) as f64),
    };
    Ok((0..count).map(value).map(Value::Float).collect())
}

fn linear(from: f64, to: f64, share: f64) -> f64 {
    from + (to - from) * share
}

/// Equal ratios, to twelve digits: the same on every machine, and legible in the tables.
fn logarithmic(from: f64, to: f64, share: f64) -> f64 {
    let value = from * libm::pow(to / from, share);
    format!("{value:.11e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn variants_keep_their_order_and_flatten_their_keys() {
        let text = "name = 'shape'\n[variants]\nzebra = { texture = [{ shape = 'groove', coverage = 10 }] }\n\
                    apple = { drive.v_star = 0.1, 'load.redistribute' = false }";
        let axis = axis(text).unwrap();
        assert_eq!(axis.levels[0].labels, ["zebra"]);
        assert_eq!(
            axis.levels[0].overrides,
            ["texture=[{ shape = \"groove\", coverage = 10 }]"]
        );
        assert_eq!(
            axis.levels[1].overrides,
            ["drive.v_star=0.1", "load.redistribute=false"]
        );
    }

    #[test]
    fn zipped_keys_change_together() {
        let axis =
            axis("zip = { 'slider.blocks' = [[25, 25], [50, 50]], 'friction.seed' = [1, 2] }").unwrap();
        assert_eq!(axis.columns, ["slider.blocks", "friction.seed"]);
        assert_eq!(
            axis.levels[1].overrides,
            ["slider.blocks=[50, 50]", "friction.seed=2"]
        );
        assert_eq!(axis.levels[1].number, Some(50.0));
        assert!(super::Axis::new(toml::from_str("zip = { a = [1], b = [1, 2] }").unwrap()).is_err());
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
    }
}
