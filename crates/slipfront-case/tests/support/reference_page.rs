//! Pages of `docs/reference/` with the tables of keys that structs declare. Tests of several crates include
//! this file.

use std::ops::Bound::{Excluded, Included, Unbounded};
use std::path::Path;

use slipfront_base::number_format::exact;
use slipfront_case::case_file::{Bounds, Key, KeyKind};

/// Compares a page of `docs/reference/` with its expected text, or writes the page again if `UPDATE` is set.
pub(crate) fn expect_page(name: &str, made: impl FnOnce(&str) -> String) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../docs/reference")
        .join(name);
    let page = std::fs::read_to_string(&path).unwrap_or_default();
    let made = made(&page);
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, made).unwrap();
    } else if page != made {
        let differs = page.lines().zip(made.lines()).find(|(is, to_be)| is != to_be);
        panic!(
            "{name} is not what the program says; UPDATE=1 before this test writes it anew. It first differs at {differs:#?}"
        );
    }
}

/// The page with these keys in place of the first table of keys below the heading that begins with these
/// words.
pub(crate) fn with_keys(page: &str, heading: &str, keys: &[Key]) -> String {
    let lines: Vec<&str> = page.lines().collect();
    let is_heading = |line: &&str| {
        line.trim_start_matches('#')
            .strip_prefix(' ')
            .is_some_and(|title| title.starts_with(heading))
    };
    let heading = lines
        .iter()
        .position(is_heading)
        .unwrap_or_else(|| panic!("there is no heading {heading}"));
    let is_row = |line: &&str| line.starts_with('|');
    let start = lines
        .iter()
        .skip(heading)
        .position(|line| line.starts_with("| key |"));
    let start =
        heading + start.unwrap_or_else(|| panic!("there is no table of keys below {}", lines[heading]));
    let end = start + lines[start..].iter().take_while(|line| is_row(line)).count();
    let table = table(keys);
    let lines = lines[..start]
        .iter()
        .copied()
        .chain(table.lines())
        .chain(lines[end..].iter().copied());
    lines.map(|line| format!("{line}\n")).collect()
}

/// The rows of some keys, without columns that are empty for all keys.
fn table(keys: &[Key]) -> String {
    let titles = ["key", "paper", "default", "bounds", "meaning"].map(str::to_owned);
    let rows: Vec<[String; 5]> = keys.iter().map(row).collect();
    let used: Vec<usize> = (0..titles.len())
        .filter(|&column| rows.iter().any(|row| !row[column].is_empty()))
        .collect();
    let line = |cells: &[String; 5]| {
        let cells = used.iter().map(|&column| match cells[column].as_str() {
            "" => " |".to_owned(),
            cell => format!(" {cell} |"),
        });
        format!("|{}\n", cells.collect::<String>())
    };
    let rows: String = rows.iter().map(line).collect();
    format!("{}|{}\n{rows}", line(&titles), "---|".repeat(used.len()))
}

fn row(key: &Key) -> [String; 5] {
    let code = |text: &str| {
        if text.is_empty() {
            String::new()
        } else {
            format!("`{text}`")
        }
    };
    let default = match key.without {
        "" => code(key.default),
        words => words.to_owned(),
    };
    let meaning = [key.doc, key.note].join(" ").trim_end().to_owned();
    [
        code(key.name),
        key.paper.to_owned(),
        default,
        bounds(&key.kind) + key.further_bounds,
        meaning,
    ]
}

/// The values that a key accepts.
fn bounds(kind: &KeyKind) -> String {
    let quoted = |words: &[&str]| {
        words
            .iter()
            .map(|word| format!("`\"{word}\"`"))
            .collect::<Vec<_>>()
    };
    match kind {
        KeyKind::Number {
            bounds, words: [], ..
        } => range(bounds),
        KeyKind::Number { bounds, words, .. } => {
            format!("{}, or {}", quoted(words).join(", "), range(bounds))
        }
        KeyKind::Quantity { unit, bounds } => format!("{} {unit}", range(bounds)),
        KeyKind::Whole {
            least, most, noun, ..
        } => {
            let whole = if noun.is_empty() { "" } else { "whole, " };
            format!("{whole}{} to {}", in_groups(*least), in_groups(*most))
        }
        KeyKind::Words(words) => quoted(words()).join(", "),
        KeyKind::Switch => String::new(),
        KeyKind::File(formats) => {
            let formats: Vec<String> = formats.iter().map(|format| format!("`.{format}`")).collect();
            let (last, others) = formats.split_last().unwrap();
            let others = match others.join(", ") {
                others if others.is_empty() => others,
                others => format!("{others} or "),
            };
            format!("a {others}{last} file")
        }
        // Its keys have their own table.
        KeyKind::Table("", _) => String::new(),
        KeyKind::Table(example, keys) => {
            let of_keys = keys.iter().map(|key| (key.name, bounds(&key.kind)));
            let of_keys: String = of_keys
                .map(|(name, bounds)| format!("; `{name}` {bounds}"))
                .collect();
            format!("`{example}`{of_keys}")
        }
        KeyKind::Special(words) => (*words).to_owned(),
    }
}

/// A whole number with spaces between thousands.
fn in_groups(number: u64) -> String {
    if number == i64::MAX as u64 {
        return "2^63 - 1".to_owned();
    }
    let digits = number.to_string();
    let groups: Vec<&[u8]> = digits.as_bytes().rchunks(3).rev().collect();
    match groups.as_slice() {
        // Four digits need no grouping.
        [[_], _] => digits,
        groups => String::from_utf8(groups.join(&b' ')).unwrap(),
    }
}

fn range(bounds: &Bounds) -> String {
    let [low, high] = [bounds.0, bounds.1].map(|bound| bound.map(exact));
    match (low, high) {
        (Included(low), Included(high)) => format!("{low} to {high}"),
        (Excluded(low), Included(high)) => format!("more than {low}, at most {high}"),
        (Excluded(low), Excluded(high)) => format!("more than {low}, less than {high}"),
        (Excluded(low), Unbounded) => format!("more than {low}"),
        (Included(low), Unbounded) => format!("{low} and more"),
        other => panic!("no words for {other:?}"),
    }
}
