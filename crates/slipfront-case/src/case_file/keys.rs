//! The keys of a case file, those that exclude each other, and suggestions for misspelt keys.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::CaseError;
use super::key_table::{SECTIONS, TEXTURE, partners};
use super::source::Source;
use super::synonyms::advice_on;
use crate::nearest::nearest;

/// The names of the tables, in the order of the design.
pub const TABLES: [&str; 8] = [
    "slider", "load", "drive", "friction", "texture", "initial", "time", "output",
];

/// The names of the tables of a study file.
pub const STUDY_TABLES: [&str; 3] = ["base", "study", "axes"];

/// The table that only a design file has.
pub(super) const DESIGN: &str = "design";

/// Header of a table as in the file.
pub(super) fn header(table: &str) -> String {
    header_below("", table)
}

/// Header of a table within a table. `above` is the name of the outer table, which ends in a dot.
pub fn header_below(above: &str, table: &str) -> String {
    if table == TEXTURE {
        format!("[[{above}{table}]]")
    } else {
        format!("[{above}{table}]")
    }
}

/// Header of a texture, for messages.
pub(super) fn texture_header(shape: &str) -> String {
    format!("[[texture]] of shape \"{shape}\"")
}

/// Header of the first table that has the key.
fn home_of(key: &str) -> Option<String> {
    let home = SECTIONS.iter().find(|section| section.key(key).is_some())?;
    let header = if home.is_shape { texture_header } else { header };
    Some(header(home.name))
}

/// Keys for the same quantity as a key such as `drive.v_star`, here `drive.speed`.
pub fn partners_of(key: &str) -> Vec<String> {
    let Some((table, leaf)) = key.rsplit_once('.') else {
        return Vec::new();
    };
    let root = table.split('.').next().unwrap_or(table);
    partners(root, leaf)
        .map(|partner| format!("{table}.{partner}"))
        .collect()
}

/// Whether two keys, such as `drive.v_star` and `drive.speed`, set the same quantity.
pub fn exclude_each_other(one: &str, other: &str) -> bool {
    partners_of(one).iter().any(|partner| partner == other)
}

/// Refuses a table with two keys that exclude each other.
pub(super) fn refuse_both(root: &DeTable<'_>, source: &Source) -> Result<(), CaseError> {
    for section in &SECTIONS {
        let tables: Vec<&DeTable<'_>> = match root.get(section.table()).map(Spanned::get_ref) {
            Some(DeValue::Table(keys)) => vec![keys],
            Some(DeValue::Array(values)) => values
                .iter()
                .filter_map(|value| value.get_ref().as_table())
                .collect(),
            _ => continue,
        };
        let pairs = section
            .keys
            .iter()
            .flat_map(|key| key.partners().map(move |partner| (key.name, partner)));
        for (first, second) in pairs {
            let spans = |keys: &&DeTable<'_>| {
                let span = |name| keys.get_key_value(name).map(|(key, _)| key.span());
                span(first).zip(span(second))
            };
            if let Some((one, other)) = tables.iter().find_map(spans) {
                let later = if one.start > other.start { one } else { other };
                let sentence = format!(
                    "`{first}` and `{second}` in {} set the same thing: keep one of them",
                    header(section.table())
                );
                return Err(source.error_at(later, sentence));
            }
        }
    }
    Ok(())
}

/// Sentence about a key that the table under `header` does not have.
pub fn unknown(key: &str, header: &str, known: &[&str]) -> String {
    let list = known.join(", ");
    let advice = match (advice_on(key), home_of(key), nearest(key, known)) {
        (Some(advice), ..) => format!(": {advice}."),
        (None, Some(home), _) => format!(": it belongs in {home}."),
        (None, None, Some(near)) => format!(": did you mean `{near}`?"),
        (None, None, None) => ".".to_owned(),
    };
    format!("unknown key `{key}` in {header}{advice} Known keys: {list}")
}

/// Sentence about a key or table that does not belong to the file at top level.
pub fn unknown_table(key: &str) -> String {
    if let Some(home) = home_of(key) {
        return format!("`{key}` is outside its table: it belongs in {home}");
    }
    if STUDY_TABLES.contains(&key) {
        return format!(
            "`{key}` belongs in a study file, which `slipfront study` runs: this is read as a case file"
        );
    }
    if key == DESIGN {
        return format!(
            "`{key}` belongs in a design file, which `slipfront design` runs: this is read as a case file"
        );
    }
    let list = TABLES.map(header).join(", ");
    match (advice_on(key), nearest(key, &TABLES)) {
        (Some(advice), _) => format!("unknown table `{key}`: {advice}. The tables are {list}"),
        (None, Some(near)) => format!(
            "unknown table `{key}`: did you mean {}? The tables are {list}",
            header(near)
        ),
        (None, None) => format!("unknown table `{key}`: the tables are {list}"),
    }
}

/// Sentence about a texture with a `shape` that is missing, not a string, or unknown.
pub(super) fn unknown_shape(shape: Option<&str>) -> String {
    let shapes = SECTIONS.iter().filter(|section| section.is_shape);
    let shapes: Vec<&str> = shapes.map(|section| section.name).collect();
    let quoted: Vec<String> = shapes.iter().map(|shape| format!("{shape:?}")).collect();
    let choice = match quoted.split_last() {
        Some((last, others)) => format!("it can be {} or {last}", others.join(", ")),
        None => String::new(),
    };
    let Some(shape) = shape else {
        return format!("a texture needs `shape`: {choice}");
    };
    match (advice_on(shape), nearest(shape, &shapes)) {
        (Some(advice), _) => format!("unknown shape {shape:?}: {advice}. In full, {choice}"),
        (None, Some(near)) => format!("unknown shape {shape:?}: did you mean \"{near}\"? In full, {choice}"),
        (None, None) => format!("unknown shape {shape:?}: {choice}"),
    }
}
