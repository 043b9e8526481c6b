use std::fs;
use std::path::Path;

use slipfront_case::case_file::CaseFile;
use slipfront_run::study::{Plan, StudyFile};

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

/// The studies of the documentation and of `cases/studies` can be run, and every key of a study is explained.
#[test]
fn studies_are_true() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut seen = 0;
    for page in ["docs/reference/study-file.md", "docs/guide/studies.md"] {
        let text = fs::read_to_string(root.join(page)).unwrap();
        for rest in text.split("```toml study\n").skip(1) {
            let block = rest.split("```").next().unwrap();
            let study = StudyFile::parse(block, page, "study", &root.join("cases"))
                .unwrap_or_else(|error| panic!("{error}"));
            Plan::new(&study, None).unwrap_or_else(|error| panic!("{page}: {error}\n{block}"));
            seen += 1;
        }
    }
    assert!(seen >= 7, "only {seen} examples");
    let mut files = 0;
    for entry in fs::read_dir(root.join("cases/studies")).unwrap() {
        let study = StudyFile::load(&entry.unwrap().path()).unwrap_or_else(|error| panic!("{error}"));
        Plan::new(&study, None).unwrap_or_else(|error| panic!("{}: {error}", study.name));
        files += 1;
    }
    assert!(files >= 2, "only {files} studies");

    let text = fs::read_to_string(root.join("docs/reference/study-file.md")).unwrap();
    for key in [
        "base",
        "replicates",
        "reference",
        "keep",
        "until",
        "key",
        "half_width",
        "confidence",
        "min",
        "max",
        "list",
        "linspace",
        "logspace",
        "zip",
        "name",
        "variants",
    ] {
        assert!(text.contains(&format!("`{key}`")), "`{key}` is not explained");
    }
}
