use std::fs;
use std::path::Path;

use slipfront_case::case_file::{CaseFile, SECTIONS};

use crate::reference_page::{expect_page, with_keys};

/// The TOML blocks of the reference are readable cases, and it explains every key of the default case.
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

/// Every key has a row in the table of its section, as its struct declares it.
#[test]
fn the_reference_has_the_keys_of_the_structs() {
    expect_page("case-file.md", |page| {
        SECTIONS.iter().fold(page.to_owned(), |page, section| {
            let heading = if section.is_shape {
                format!("`shape = \"{}\"`", section.name)
            } else {
                format!("`[{}]`", section.name)
            };
            with_keys(&page, &heading, section.keys)
        })
    });
}
