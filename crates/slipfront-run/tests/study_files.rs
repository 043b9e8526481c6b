//! Study files: those of the documentation and of `cases/studies`, and one that is nested too deeply.

// Helpers of tests are not tests by themselves to clippy.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use slipfront_run::study::{self, Plan, Quantity, Records, StudyFile};

/// The studies of the documentation and of `cases/studies` can be run, and every key of a study is explained.
#[test]
fn studies_are_true() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut seen = 0;
    for page in [
        "docs/reference/study-file.md",
        "docs/guide/studies.md",
        "docs/guide/experiment.md",
    ] {
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

/// A few grooves lower static friction as one does, many weaken the effect. Measured before by another build; the digits given are
/// those of the figures.
#[test]
fn many_grooves_weaken_the_effect() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/studies/grooves.toml");
    let study = StudyFile::load(&file).unwrap();
    let plan = Plan::new(&study, None).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let records = Records::open(folder.path()).unwrap();
    let never = AtomicBool::new(false);
    let results = study::execute(&plan, &records, folder.path(), &never, &mut |_| {}).unwrap();
    let reductions = [37.4, 38.5, 38.4, 39.3, 32.0, 15.1];
    assert_eq!(results.points.len(), reductions.len());
    for (point, expected) in reductions.into_iter().enumerate() {
        let found = results.value(point, 0, Quantity::Reduction).unwrap();
        assert!((found - expected).abs() <= 0.05, "{found}, expected {expected}");
    }
}

#[test]
fn deep_nesting_is_refused_without_overflow() {
    // Brackets that close nothing must not count against those that open.
    for piece in ["{ [], a = ", "{ b = 1 [x], a = ", "[ }, ", "{ a = ], b = "] {
        let nested = piece.repeat(100_000);
        let study = StudyFile::parse(&format!("a = {nested}"), "study.toml", "study", Path::new(""));
        assert!(study.unwrap_err().to_string().contains("this is not valid TOML"));
    }
}
