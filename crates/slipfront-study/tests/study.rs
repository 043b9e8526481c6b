//! Tests of the study files in the documentation and in `cases/studies`, and of a study file that is nested
//! too deeply.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

#[path = "../../slipfront-case/tests/support/reference_page.rs"]
mod reference_page;

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use slipfront_study::{
    self as study, AxisKeys, Plan, RunJournal, RunQuantity, Settings, StoppingRule, StudyFile, StudyResults,
    anisotropies,
};

use crate::reference_page::{expect_page, with_keys};

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

/// Every key has a row in the table of its section, as its struct declares it.
#[test]
fn the_reference_has_the_keys_of_the_structs() {
    expect_page("study-file.md", |page| {
        let page = with_keys(page, "`[study]`", Settings::KEYS);
        let page = with_keys(&page, "`until`", StoppingRule::KEYS);
        with_keys(&page, "`[[axes]]`", AxisKeys::KEYS)
    });
}

/// A few grooves reduce static friction as much as one does; with many grooves, the effect is weaker. The
/// expected values come from an earlier build and are rounded as in the figures.
#[test]
fn many_grooves_weaken_the_effect() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/studies/grooves.toml");
    let study = StudyFile::load(&file).unwrap();
    let plan = Plan::new(&study, None).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let records = RunJournal::open(folder.path()).unwrap();
    let never = AtomicBool::new(false);
    let results = study::execute(&plan, &records, folder.path(), &never, &mut |_| {}).unwrap();
    let reductions = [37.4, 38.5, 38.4, 39.3, 32.0, 15.1];
    assert_eq!(results.points.len(), reductions.len());
    for (point, expected) in reductions.into_iter().enumerate() {
        let found = results.value(point, 0, RunQuantity::Reduction).unwrap();
        assert!((found - expected).abs() <= 0.05, "{found}, expected {expected}");
    }
}

/// The plan of a study and its results.
fn results(text: &str) -> (Plan, StudyResults) {
    let study = StudyFile::parse(text, "study.toml", "study", Path::new("")).unwrap();
    let plan = Plan::new(&study, None).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let records = RunJournal::open(folder.path()).unwrap();
    let never = AtomicBool::new(false);
    let results = study::execute(&plan, &records, folder.path(), &never, &mut |_| {}).unwrap();
    (plan, results)
}

/// Bits of static and kinetic friction at a point, along and across the drive. A mirror image changes the
/// sign across the drive.
fn friction_at(results: &StudyResults, point: usize, handed: f64) -> [u64; 4] {
    let value = |name: &str| {
        let value = results.value(point, 0, RunQuantity::named(name).unwrap());
        value.unwrap_or_else(|| panic!("no {name} at point {point}"))
    };
    // Adding 0.0 turns -0 into 0.
    let across = |name: &str| (handed * value(name) + 0.0).to_bits();
    [
        value("static_friction_star").to_bits(),
        value("kinetic_friction_star").to_bits(),
        across("static_lateral_friction_star"),
        across("kinetic_lateral_friction_star"),
    ]
}

/// All replicates are the same run; three of them are enough for the test of isotropy.
const SMOOTH: &str = "study.replicates = 3\nbase.friction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\nbase.drive.v_star = 0.1\n";

/// On a texture with all symmetries of the square, every quarter turn and mirror image of the drive direction
/// gives the same bits.
#[test]
fn a_symmetric_texture_has_the_friction_of_its_symmetry() {
    for texture in [
        "{ shape = 'cavity', coverage = 15 }",
        "{ shape = 'cavity', s = 3, w = 0.2, coverage = 15 }",
        "{ shape = 'cavity', coverage = 15, array = [2, 2] }",
    ] {
        // 30 degrees and its images: first by quarter turns, then by mirrors.
        let (plan, results) = results(&format!(
            "{SMOOTH}base.slider.blocks = [14, 14]\nbase.texture = [{texture}]\n[[axes]]\nkey = 'drive.direction'\n\
             list = [30, 120, 210, 300, 60, 150, 240, 330, -30, 0, 90, 180, 270, 45, 135, 225, 315]"
        ));
        let of = |points: std::ops::Range<usize>, handed| points.map(move |point| (point, handed));
        let oblique = of(0..4, 1.0).chain(of(4..9, -1.0)).collect::<Vec<_>>();
        let straight = of(9..13, 1.0).collect::<Vec<_>>();
        let diagonal = of(13..17, 1.0).collect::<Vec<_>>();
        for images in [&oblique, &straight, &diagonal] {
            let first = friction_at(&results, images[0].0, 1.0);
            for &(point, handed) in images {
                let found = friction_at(&results, point, handed);
                assert_eq!(found, first, "{texture}: {}", plan.describe(&plan.points[point]));
            }
        }
        // Along an axis of symmetry, friction across the drive is zero. Between the axes it must not be, or
        // the test of signs above would be empty.
        assert_eq!(friction_at(&results, 9, 1.0)[2..], [0, 0], "{texture}");
        assert!(
            friction_at(&results, 0, 1.0)[2..].iter().all(|bits| *bits != 0),
            "{texture}"
        );
        // Friction with fourfold symmetry has no principal axes.
        for found in anisotropies(&plan, &results) {
            let numbers = found.found.as_ref().unwrap();
            assert!(numbers.principal.is_none(), "{texture}: {found:?}");
            // -30 and 330 degrees are the same direction.
            assert_eq!((found.directions, found.replicates), (16, 3));
            let [largest, smallest] = [numbers.largest_direction, numbers.smallest_direction];
            assert!(
                largest != smallest && numbers.anisotropy.mean > 0.0,
                "{texture}: {found:?}"
            );
        }
    }
}

/// A groove across x is a groove along x after a rotation. Friction rotates with it, and its principal axes
/// are along and across the groove.
#[test]
fn grooves_turn_their_friction_with_them() {
    let (plan, results) = results(&format!(
        "{SMOOTH}base.slider.blocks = [15, 15]\nbase.texture = [{{ shape = 'groove', coverage = 20 }}]\n\
         [[axes]]\nkey = 'texture.0.orientation'\nlist = ['across', 'along']\n\
         [[axes]]\nkey = 'drive.direction'\nlinspace = [0, 330, 12]"
    ));
    for step in 0..12 {
        let across = friction_at(&results, step, 1.0);
        let along = friction_at(&results, 12 + (step + 3) % 12, 1.0);
        let mirrored = friction_at(&results, (12 - step) % 12, -1.0);
        assert_eq!(across, along, "{} degrees", 30 * step);
        assert_eq!(across, mirrored, "{} degrees", 30 * step);
    }
    let all = anisotropies(&plan, &results);
    let directions: Vec<f64> = all
        .iter()
        .filter(|found| found.quantity == "static_friction_star")
        .map(|found| found.found.as_ref().unwrap().principal.unwrap().direction)
        .collect();
    // Friction is larger along a groove than across it. The tolerance allows for rounding in the fit.
    let [across, along] = directions[..] else {
        panic!("{all:?}")
    };
    assert!((across - 90.0).abs() < 1e-9, "{across}");
    assert!(along.min(180.0 - along) < 1e-9, "{along}");
    let found = &all[0];
    assert_eq!(
        found.levels,
        [("texture.0.orientation".to_owned(), "across".to_owned())]
    );
    let numbers = found.found.as_ref().unwrap();
    // By its definition, from the values, which are equal for all replicates.
    let values: Vec<f64> = (0..12)
        .map(|point| f64::from_bits(friction_at(&results, point, 1.0)[0]))
        .collect();
    let mean = values.iter().sum::<f64>() / 12.0;
    let spread = values.iter().copied().fold(0.0, f64::max) - values.iter().copied().fold(1.0, f64::min);
    assert!(
        (numbers.anisotropy.mean - spread / mean).abs() < 1e-14,
        "{found:?}"
    );
    let (at, lateral) = numbers.lateral.unwrap();
    let point = (at / 30.0).round() as usize;
    assert_eq!(lateral.min.to_bits(), friction_at(&results, point, 1.0)[2]);
}

#[test]
fn deep_nesting_is_refused_without_overflow() {
    // Unmatched closing brackets must not cancel opening ones.
    for piece in ["{ [], a = ", "{ b = 1 [x], a = ", "[ }, ", "{ a = ], b = "] {
        let nested = piece.repeat(100_000);
        let study = StudyFile::parse(&format!("a = {nested}"), "study.toml", "study", Path::new(""));
        let refused = study.unwrap_err().to_string();
        assert!(refused.contains("more than 64 levels deep here"), "{refused}");
    }
}
