use std::fs;
use std::ops::Bound::{Excluded, Included, Unbounded};
use std::path::Path;

use slipfront_base::number_format::exact;
use slipfront_case::case_file::{Bounds, CaseFile, KeyKind, SECTIONS};

/// The TOML blocks of the reference are cases that can be read, and every key of the default is explained there.
#[test]
fn the_reference_is_true() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/reference/case-file.md");
    let text = fs::read_to_string(path).unwrap();
    let blocks: Vec<&str> = text
        .split("```toml\n")
        .skip(1)
        .map(|rest| rest.split("```").next().unwrap())
        .collect();
    assert!(blocks.len() >= 4, "only {} examples", blocks.len());
    for block in blocks {
        CaseFile::parse(block, "case-file.md", &[]).unwrap_or_else(|error| panic!("{error}"));
    }
    let textures =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/good/textures.toml")).unwrap();
    let printed = CaseFile::parse(&textures, "textures", &[])
        .unwrap()
        .to_toml()
        .unwrap();
    for key in printed
        .lines()
        .filter_map(|line| line.split_once(" = "))
        .map(|(key, _)| key)
    {
        assert!(text.contains(&format!("`{key}`")), "`{key}` is not explained");
    }
    for key in [
        "speed",
        "damping_rate",
        "mu_kinetic",
        "mu_static_field",
        "mu_kinetic_field",
        "duration",
        "every",
    ] {
        assert!(text.contains(&format!("`{key}`")), "`{key}` is not explained");
    }
}

/// Every key has a row in the table of its section, with its default, bounds and meaning.
#[test]
fn the_reference_tells_every_key_as_it_is() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/reference/case-file.md");
    let text = fs::read_to_string(path).unwrap();
    let parts: Vec<&str> = text.split("\n##").collect();
    for section in &SECTIONS {
        let title = if section.is_shape {
            format!("# `shape = \"{}\"`", section.name)
        } else {
            format!(" `[{}]`", section.name)
        };
        let part = parts.iter().find(|part| part.starts_with(&title)).unwrap();
        let rows: Vec<Vec<&str>> = part
            .lines()
            .filter(|line| line.starts_with('|'))
            .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
            .collect();
        let column = |name: &str| rows[0].iter().position(|&cell| cell == name).unwrap();
        assert_eq!(rows.len(), section.keys.len() + 2, "{}", section.name);
        for key in section.keys {
            let name = format!("`{}`", key.name);
            let row = rows.iter().find(|row| row[0] == name).unwrap();
            let default = row[column("default")];
            assert_eq!(default.trim_matches('`'), key.default, "{}", key.name);
            for part in bounds(&key.kind) {
                assert!(row[column("bounds")].contains(&part), "{}: {part}", key.name);
            }
            assert!(row[column("meaning")].starts_with(key.doc), "{}", key.name);
        }
    }
}

/// Texts that the cell of the bounds must hold.
fn bounds(kind: &KeyKind) -> Vec<String> {
    let quoted = |words: &[&str]| {
        words
            .iter()
            .map(|word| format!("`\"{word}\"`"))
            .collect::<Vec<_>>()
    };
    match kind {
        KeyKind::Number { bounds, words, .. } => [quoted(words), vec![range(bounds)]].concat(),
        KeyKind::Quantity { unit, bounds } => vec![range(bounds), (*unit).to_owned()],
        KeyKind::Whole { most, .. } if *most == i64::MAX as u64 => vec!["0 to 2^63 - 1".to_owned()],
        KeyKind::Whole {
            least, most: 100_000, ..
        } => vec![format!("{least} to 100 000")],
        KeyKind::Whole { least, most, .. } => vec![format!("{least} to {most}")],
        KeyKind::Words(words) => quoted(words()),
        KeyKind::Switch => Vec::new(),
        KeyKind::File(formats) => formats.iter().map(|format| format!("`.{format}`")).collect(),
        KeyKind::Special(words) => vec![(*words).to_owned()],
    }
}

fn range(bounds: &Bounds) -> String {
    let [low, high] = [bounds.0, bounds.1].map(|bound| bound.map(exact));
    match (low, high) {
        (Included(low), Included(high)) => format!("{low} to {high}"),
        (Excluded(low), Included(high)) => format!("more than {low}, at most {high}"),
        (Excluded(low), Excluded(high)) => format!("more than {low}, less than {high}"),
        (Included(low), Unbounded) => format!("{low} and more"),
        other => panic!("no words for {other:?}"),
    }
}
