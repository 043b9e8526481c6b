//! The keys of a case file: which there are, which exclude each other, and what a misspelt one was meant to be.
//!
//! The names come from the structs themselves, by asking serde for the fields of each.

use serde::de::value::Error as ProbeError;
use serde::de::{DeserializeOwned, Deserializer, Error as _, Visitor};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::CaseError;
use super::source::Source;
use super::{Cavity, Drive, Friction, Groove, Load, Mask, Output, Polygon, Slider, Time};

/// The longest name that is compared with the known ones, in bytes.
const MAX_NAME: usize = 100;

/// Keys of a table that set the same thing: one of the two, never both.
const PAIRS: [(&str, [&str; 2]); 6] = [
    ("slider", ["omega_star", "damping_rate"]),
    ("drive", ["v_star", "speed"]),
    ("friction", ["r_star", "mu_kinetic"]),
    ("time", ["duration_star", "duration"]),
    ("texture", ["coverage", "lambda"]),
    ("texture", ["coverage", "width"]),
];

/// The names of the tables, in the order of the design.
pub const TABLES: [&str; 7] = ["slider", "load", "drive", "friction", "texture", "time", "output"];

/// Those of a study file.
pub const STUDY_TABLES: [&str; 3] = ["base", "study", "axes"];

/// A table's header as it stands in the file.
pub(super) fn header(table: &str) -> String {
    header_below("", table)
}

/// The same in a table `above`, which ends in a dot.
pub fn header_below(above: &str, table: &str) -> String {
    if table == "texture" {
        format!("[[{above}{table}]]")
    } else {
        format!("[{above}{table}]")
    }
}

/// The header of a texture, for messages.
pub(super) fn texture_header(shape: &str) -> String {
    format!("[[texture]] of shape \"{shape}\"")
}

/// Every set of keys that stand together, under its header; those of a texture without `shape`.
fn known() -> [(String, &'static [&'static str]); 10] {
    [
        (header("slider"), keys_of::<Slider>()),
        (header("load"), keys_of::<Load>()),
        (header("drive"), keys_of::<Drive>()),
        (header("friction"), keys_of::<Friction>()),
        (header("time"), keys_of::<Time>()),
        (header("output"), keys_of::<Output>()),
        (texture_header("cavity"), keys_of::<Cavity>()),
        (texture_header("groove"), keys_of::<Groove>()),
        (texture_header("polygon"), keys_of::<Polygon>()),
        (texture_header("mask"), keys_of::<Mask>()),
    ]
}

/// The header of the first table that has the key.
fn home_of(key: &str) -> Option<String> {
    known()
        .into_iter()
        .find(|(_, keys)| keys.contains(&key))
        .map(|(header, _)| header)
}

/// The keys that exclude `key` in a table.
pub(super) fn partners<'k>(table: &'k str, key: &'k str) -> impl Iterator<Item = &'static str> + 'k {
    PAIRS
        .iter()
        .filter(move |(name, _)| *name == table)
        .filter_map(move |(_, pair)| match pair {
            [first, second] if *first == key => Some(*second),
            [first, second] if *second == key => Some(*first),
            _ => None,
        })
}

/// The keys that set the same thing as a key such as `drive.v_star`, which has `drive.speed`.
pub fn partners_of(key: &str) -> Vec<String> {
    let Some((table, leaf)) = key.rsplit_once('.') else {
        return Vec::new();
    };
    let root = table.split('.').next().unwrap_or(table);
    partners(root, leaf)
        .map(|partner| format!("{table}.{partner}"))
        .collect()
}

/// Whether two keys, such as `drive.v_star` and `drive.speed`, set the same thing.
pub fn exclude_each_other(one: &str, other: &str) -> bool {
    partners_of(one).iter().any(|partner| partner == other)
}

/// Refuses a table that holds both keys of a pair.
pub(super) fn refuse_both(root: &DeTable<'_>, source: &Source) -> Result<(), CaseError> {
    for (table, pair) in PAIRS {
        let tables: Vec<&DeTable<'_>> = match root.get(table).map(Spanned::get_ref) {
            Some(DeValue::Table(keys)) => vec![keys],
            Some(DeValue::Array(values)) => values
                .iter()
                .filter_map(|value| value.get_ref().as_table())
                .collect(),
            _ => continue,
        };
        for keys in tables {
            let spans: Vec<_> = pair
                .iter()
                .filter_map(|key| keys.get_key_value(*key))
                .map(|(key, _)| key.span())
                .collect();
            if let [first, second] = spans.as_slice() {
                let later = if first.start > second.start { first } else { second };
                let [first, second] = pair;
                let sentence = format!(
                    "`{first}` and `{second}` in {} set the same thing: keep one of them",
                    header(table)
                );
                return Err(source.error_at(later.clone(), sentence));
            }
        }
    }
    Ok(())
}

/// The sentence about a key that the table under `header` does not have.
pub fn unknown(key: &str, header: &str, known: &[&str]) -> String {
    let list = known.join(", ");
    let advice = match (home_of(key), nearest(key, known)) {
        (Some(home), _) => format!(": it belongs in {home}"),
        (None, Some(near)) => format!(": did you mean `{near}`?"),
        (None, None) => ".".to_owned(),
    };
    let end = if advice.ends_with(['?', '.']) { "" } else { "." };
    format!("unknown key `{key}` in {header}{advice}{end} Known keys: {list}")
}

/// The sentence about a key or table that the file as a whole does not have.
pub(super) fn unknown_table(key: &str) -> String {
    if let Some(home) = home_of(key) {
        return format!("`{key}` stands outside its table: it belongs in {home}");
    }
    if STUDY_TABLES.contains(&key) {
        return format!(
            "`{key}` belongs in a study file, which `slipfront study` runs: this is read as a case file"
        );
    }
    let list = TABLES.map(header).join(", ");
    match nearest(key, &TABLES) {
        Some(near) => format!(
            "unknown table `{key}`: did you mean {}? The tables are {list}",
            header(near)
        ),
        None => format!("unknown table `{key}`: the tables are {list}"),
    }
}

/// The sentence about a texture whose `shape` is missing, not a string, or not known.
pub(super) fn unknown_shape(shape: Option<&str>) -> String {
    const SHAPES: [&str; 4] = ["cavity", "groove", "polygon", "mask"];
    let choice = "it can be \"cavity\", \"groove\", \"polygon\" or \"mask\"";
    match shape.map(|shape| (shape, nearest(shape, &SHAPES))) {
        None => format!("a texture needs `shape`: {choice}"),
        Some((shape, Some(near))) => {
            format!("unknown shape {shape:?}: did you mean \"{near}\"? In full, {choice}")
        }
        Some((shape, None)) => format!("unknown shape {shape:?}: {choice}"),
    }
}

/// The one of `known` that `word` was probably meant to be.
pub(super) fn nearest<'k>(word: &str, known: &[&'k str]) -> Option<&'k str> {
    // The distance takes time and memory in proportion to the word, which may be as long as the file.
    if word.len() > MAX_NAME {
        return None;
    }
    let distances = known
        .iter()
        .map(|key| (strsim::damerau_levenshtein(word, key), *key));
    distances
        .min()
        .filter(|(distance, key)| *distance <= (key.len() / 3).max(1))
        .map(|(_, key)| key)
}

/// The fields that `T` reads, in their order.
pub fn keys_of<T: DeserializeOwned>() -> &'static [&'static str] {
    let mut fields: &'static [&'static str] = &[];
    // The probe gives nothing to read, so this always ends in an error: after the fields were noted.
    let _ = T::deserialize(Probe(&mut fields));
    fields
}

/// A deserializer that notes the fields a struct asks for.
struct Probe<'a>(&'a mut &'static [&'static str]);

impl<'de> Deserializer<'de> for Probe<'_> {
    type Error = ProbeError;

    fn deserialize_any<V: Visitor<'de>>(self, _visitor: V) -> Result<V::Value, ProbeError> {
        Err(ProbeError::custom("a probe holds no value"))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ProbeError> {
        *self.0 = fields;
        self.deserialize_any(visitor)
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}
