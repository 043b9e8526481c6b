//! Designs: the results of the search, and their independence of how the search is run.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

#[path = "../../slipfront-case/tests/support/reference_page.rs"]
mod reference_page;

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use slipfront::device::Device;
use slipfront::testing::FusedDevice;
use slipfront_case::case::{Case, Ranks};
use slipfront_case::texture_file::textured_blocks;
use slipfront_design::{
    Bounds, DESIGNS, Design, DesignFile, DesignFolder, DesignKeys, DesignStage, Outcome, RunCache, RunCost,
};
use slipfront_study::StudyError;
use slipfront_study::project_folder::Extent;
use slipfront_study::verify::verify;

use crate::reference_page::{expect_page, with_keys};

/// A small slider; its named patterns cover less than the limits allow.
const BASE: &str = "[base]\nslider.blocks = [16, 16]\ndrive.v_star = 0.1\n[design]\n";

/// A base with equal surfaces for all seeds, so that a verdict uses one of them.
const SMOOTH: &str = "[base]\nslider.blocks = [16, 16]\ndrive.v_star = 0.1\n\
    friction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\n[design]\n";

fn file(keys: &str) -> DesignFile {
    file_of(BASE, keys)
}

fn file_of(base: &str, keys: &str) -> DesignFile {
    let text = format!("{base}{keys}\n");
    DesignFile::parse(&text, "design.toml", "design", Path::new("")).unwrap_or_else(|error| panic!("{error}"))
}

const LEAST: &str =
    "wish = { least = 'static_friction' }\ncoverage = [0, 15]\nfeature_blocks = 2\ngap_blocks = 2";

fn bounds(runs: usize, stop: &AtomicBool) -> Bounds<'_> {
    Bounds {
        runs,
        share_of_time: &|| 0.0,
        stop,
        cut: None,
    }
}

fn run(design: &Design, runs: usize) -> Outcome {
    design
        .run(
            &bounds(runs, &AtomicBool::new(false)),
            &mut RunCache::new(),
            &mut |_| Ok(()),
            &mut |_| {},
        )
        .unwrap()
}

fn found(keys: &str, runs: usize) -> Outcome {
    run(&file_of(SMOOTH, keys).design().unwrap(), runs)
}

/// The example of the book and the files of `cases/designs` can be run, and every key is explained.
#[test]
fn design_files_are_true() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut seen = 0;
    for page in ["docs/reference/design-file.md", "docs/guide/design.md"] {
        let text = fs::read_to_string(root.join(page)).unwrap();
        for rest in text.split("```toml design\n").skip(1) {
            let block = rest.split("```").next().unwrap();
            let file = DesignFile::parse(block, page, "design", &root.join("cases"))
                .unwrap_or_else(|error| panic!("{error}"));
            file.design()
                .unwrap_or_else(|error| panic!("{page}: {error}\n{block}"));
            seen += 1;
        }
    }
    assert!(seen >= 3, "only {seen} examples");
    for entry in fs::read_dir(root.join("cases/designs")).unwrap() {
        let file = DesignFile::load(&entry.unwrap().path()).unwrap_or_else(|error| panic!("{error}"));
        file.design()
            .unwrap_or_else(|error| panic!("{}: {error}", file.project.name));
    }
    let text = fs::read_to_string(root.join("docs/reference/design-file.md")).unwrap();
    for key in [
        "base",
        "wish",
        "least",
        "largest",
        "value",
        "of",
        "curve",
        "coverage",
        "feature",
        "feature_blocks",
        "gap",
        "gap_blocks",
        "mirror",
        "copies",
        "forbidden",
        "max_features",
        "writing",
        "line_spacing",
        "max_length",
        "cases",
        "judge_by",
        "runs",
        "start",
        "starts",
        "unknowns",
        "tolerance",
    ] {
        assert!(text.contains(&format!("`{key}`")), "`{key}` is not explained");
    }
}

/// Every key has a row in the table of its section, as its struct declares it.
#[test]
fn the_reference_has_the_keys_of_the_struct() {
    expect_page("design-file.md", |page| {
        with_keys(page, "`[design]`", DesignKeys::KEYS)
    });
}

/// The files of a folder without the journal, which has its lines in the order in which runs were begun.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| path.is_file())
        .map(|path| {
            (
                path.file_name().unwrap().to_string_lossy().into_owned(),
                fs::read(&path).unwrap(),
            )
        })
        .collect();
    files.sort();
    files
}

/// Compares a complete search on three threads with one on a single thread that is stopped repeatedly and
/// loses the end of its journal.
#[test]
fn a_search_that_was_stopped_leaves_the_same_bytes() {
    let file = file(LEAST);
    let folders = [0; 2].map(|_| tempfile::tempdir().unwrap());
    let in_one_go = folders[0].path();
    let on = |threads: usize| {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap()
    };
    let mut folder = DesignFolder::open(in_one_go, &file, false).unwrap();
    let never = AtomicBool::new(false);
    on(3).install(|| folder.find(&bounds(150, &never), &mut |_| {}).unwrap());

    let stopped = folders[1].path();
    let mut stages = Vec::new();
    for round in 0.. {
        let mut folder = DesignFolder::open(stopped, &file, false).unwrap();
        assert_eq!(folder.damaged, usize::from(round > 0));
        let stop = AtomicBool::new(false);
        let before = folder.n_kept();
        let found = on(1).install(|| {
            folder.find(&bounds(150, &stop), &mut |now| {
                let is_enough = match round {
                    0 => now.runs > 60,
                    1 => now.stage == DesignStage::Refining,
                    2 => now.stage == DesignStage::Judging,
                    3 => now.stage == DesignStage::Judging && now.runs > 200,
                    _ => false,
                };
                if is_enough {
                    stages.push(now.stage);
                    stop.store(true, Ordering::Relaxed);
                }
            })
        });
        match found {
            Ok(_) => break,
            Err(StudyError::Interrupted) => assert!(folder.n_kept() > before),
            Err(error) => panic!("{error}"),
        }
        assert!(round > 3 || stopped.join("mask.npy").exists(), "the best is kept");
        drop(folder);
        // A kill can leave an incomplete line.
        let journal = stopped.join("design.jsonl");
        let mut bytes = fs::read(&journal).unwrap();
        bytes.truncate(bytes.len() - 30);
        fs::write(&journal, bytes).unwrap();
    }
    assert!(
        stages.len() > 2 && stages.contains(&DesignStage::Judging),
        "{stages:?}"
    );
    assert!(files(in_one_go) == files(stopped), "the folders differ");
}

/// A device that makes the runs leaves the bytes of the cores, and another number of drafts at once is
/// another search.
#[test]
fn a_search_on_a_device_leaves_the_same_bytes() {
    let searched = |keys: &str, device: Option<Arc<dyn Device>>| {
        let folder = tempfile::tempdir().unwrap();
        let opened = DesignFolder::open(folder.path(), &file(keys), false).unwrap();
        let never = AtomicBool::new(false);
        let mut opened = opened.on_device(device);
        opened.find(&bounds(90, &never), &mut |_| {}).unwrap();
        files(folder.path())
    };
    let device = || -> Option<Arc<dyn Device>> { Some(Arc::new(FusedDevice)) };
    assert!(searched(LEAST, None) == searched(LEAST, device()));
    let many = &format!("{LEAST}\ndrafts_at_once = 40");
    let drafts = |files: &[(String, Vec<u8>)]| {
        let table = files.iter().find(|(name, _)| name == "evaluations.csv");
        table.map(|(_, bytes)| bytes.clone())
    };
    let on_device = searched(many, device());
    assert!(searched(many, None) == on_device);
    assert!(drafts(&on_device) != drafts(&searched(LEAST, None)));
}

/// The design is at least as good as every named pattern, and the gains come from paired runs.
#[test]
fn the_design_is_not_worse_than_named_patterns() {
    let outcome = run(&file(LEAST).design().unwrap(), 300);
    let verdict = &outcome.verdict;
    assert!(verdict.design.loss < 0.9, "{verdict:?}");
    for other in verdict.others.iter().skip(1) {
        let better = other.design_is_better_by.unwrap();
        // The mean of differences is the difference of means, up to rounding.
        assert!((better.mean - (other.loss - verdict.design.loss)).abs() < 1e-12);
        assert!(better.mean >= 0.0, "{other:?}");
    }
    // Without a search, the design is the best named pattern.
    let named = found(LEAST, 1);
    assert!(named.verdict.is_named, "{:?}", named.verdict);
    assert!(named.verdict.design.loss >= found(LEAST, 300).verdict.design.loss);
    assert!(named.verdict.optimism.abs() < 0.05);
}

/// A search without a verdict finds the same texture as a complete run, and on fresh surfaces the texture has
/// the values of the verdict.
#[test]
fn a_search_alone_finds_what_is_judged() {
    let design = file_of(SMOOTH, LEAST).design().unwrap();
    let stop = AtomicBool::new(false);
    let mut tried = 0;
    let best = design
        .search(&bounds(150, &stop), &mut |now| tried = now.textures)
        .unwrap();
    // Every texture takes a run, and so does the slider without texture.
    assert!((50..150).contains(&tried), "{tried}");
    let outcome = run(&design, 150);
    let fresh = |design: &Design, texture: &Arc<Vec<bool>>| {
        let losses = design.losses_on_fresh(std::slice::from_ref(texture), 3, &stop);
        losses.unwrap().remove(0)
    };
    // Surfaces do not differ: there is one.
    assert_eq!(fresh(&design, &outcome.texture), [outcome.verdict.design.loss]);
    assert!(best.iter().all(|texture| design.check(texture).is_ok()));
    // A block is pulled by a drive spring of 3/8, and carries more load if 15 % of the blocks carry none. The
    // runs of a search are 1.2/1.07 times as long as the time to slip, in a whole number of steps of 0.4.
    let steps = design.block_steps_per_texture().unwrap() / 256.0;
    let expected = 1.2 / 1.07 / (0.85 * 0.375 * 0.1) / 0.4;
    assert!(
        (steps - expected).abs() < 0.01 * expected + 1.0,
        "{steps} {expected}"
    );
    // If surfaces differ, each has its own loss.
    let losses = fresh(&file(LEAST).design().unwrap(), &best[0]);
    assert!(losses.len() == 3 && losses[0] != losses[1], "{losses:?}");
    stop.store(true, Ordering::Relaxed);
    let stopped = design.search(&bounds(150, &stop), &mut |_| {});
    assert!(matches!(stopped, Err(StudyError::Interrupted)));
}

#[test]
fn a_value_is_found_or_told_as_out_of_reach() {
    let value = |value: f64| {
        let keys = format!(
            "wish = {{ value = {value}, of = 'static_friction_star' }}\ncoverage = [0, 15]\nfeature_blocks = 2"
        );
        let outcome = found(&keys, 300);
        (
            outcome.verdict.design.cases[0].static_friction_star.mean,
            outcome.verdict,
        )
    };
    let (least, _) = value(0.05);
    let (reached, verdict) = value(0.78);
    // A value between the smallest and the largest possible one is met within 0.5 %, the limit of the report.
    assert!(
        least > 0.5 && (reached / 0.78 - 1.0).abs() < 0.005,
        "{least} {verdict:?}"
    );
    assert!(verdict.design.loss < 0.005);
}

/// The number of parts within a tolerance equals an independent count in the unit of the wish, here a force;
/// the mean and the scatter agree, too.
#[test]
fn parts_within_a_tolerance_are_counted() {
    // mu_s is 0.5, and the load 100 kPa on (16 um)^2, 25.6 uN.
    let base = BASE.replace("[design]", "friction.mu_static = 0.5\n[design]");
    let tolerance = 0.04;
    let design = |keys: &str| file_of(&base, keys).design().unwrap();
    let keys = format!(
        "wish = {{ value = '9 uN', of = 'static_friction' }}\ntolerance = '{tolerance} uN'\ncoverage = [0, 15]\nfeature_blocks = 2"
    );
    let in_mu_s = 25.6 * 0.5;
    let searched = design(&keys);
    let outcome = run(&searched, 60);
    let verdict = &outcome.verdict;
    // Distance of every part from a wish without tolerance: the magnitude of its deviation.
    let alone = keys.replace(&format!("\ntolerance = '{tolerance} uN'"), "");
    let distances =
        design(&alone).losses_on_fresh(&[Arc::clone(&outcome.texture)], 16 + 64, &AtomicBool::new(false));
    let distances = distances.unwrap().remove(0).split_off(16);
    let within = distances
        .iter()
        .filter(|distance| **distance * 9.0 <= tolerance)
        .count();
    let found = verdict.design.within_tolerance.unwrap();
    assert_eq!((found.within, found.parts), (within, 64));
    assert!(
        (1..61).contains(&within),
        "{within}: a tolerance that tells nothing"
    );
    assert!(!found.passes());
    let squares: f64 = distances.iter().map(|distance| distance * distance).sum();
    assert!((verdict.design.loss - (squares / 64.0).sqrt()).abs() < 1e-12);
    let wished = verdict.design.cases[0].wished_star.unwrap();
    assert_eq!(wished, verdict.design.cases[0].static_friction_star);
    // The same value in three units.
    let folder = tempfile::tempdir().unwrap();
    let file = file_of(&base, &keys);
    let mut opened = DesignFolder::open(folder.path(), &file, false).unwrap();
    let told = opened
        .find(&bounds(60, &AtomicBool::new(false)), &mut |_| {})
        .unwrap();
    let words = told.split_whitespace().collect::<Vec<_>>().join(" ");
    for expected in [
        "target static friction of 9 uN: result ".to_owned(),
        format!(
            "{within} of 64 parts lie within \u{b1} {tolerance} uN: the design fails, because at least 95 % must"
        ),
    ] {
        assert!(words.contains(&expected), "{expected}\n{told}");
    }
    let of_changes = told.split("Under changes:").nth(1).unwrap();
    assert!(
        of_changes
            .lines()
            .nth(1)
            .unwrap()
            .contains("   within \u{b1} 0.04 uN   "),
        "{told}"
    );
    let scatter = words
        .split("parts scatter by ")
        .nth(1)
        .unwrap()
        .split(" uN (1 s.d.)")
        .next()
        .unwrap();
    let exact = wished.deviation.unwrap() * in_mu_s;
    // To two digits.
    assert!(
        (scatter.parse::<f64>().unwrap() / exact - 1.0).abs() < 0.05,
        "{scatter} {exact}"
    );
    let third = of_changes
        .lines()
        .find(|line| line.contains("a third of the speed"))
        .unwrap();
    assert!(third.contains(" of 8, fails   "), "{third}");
}

/// With a tolerance, the loss includes the scatter of parts in addition to their mean.
#[test]
fn a_tolerance_weighs_scatter() {
    let keys = "wish = { value = 0.8, of = 'static_friction_star' }\ncoverage = [0, 15]\nfeature_blocks = 2";
    let plain = file(keys).design().unwrap();
    let tolerant = file(&format!("{keys}\ntolerance = 0.01")).design().unwrap();
    let groove: Vec<bool> = (0..256).map(|block| (7..9).contains(&(block % 16))).collect();
    let losses = |design: &Design, surfaces: u64| {
        let losses = design.losses(
            vec![groove.clone()],
            surfaces,
            false,
            &mut RunCache::new(),
            &AtomicBool::new(false),
        );
        losses.unwrap().remove(0).unwrap()
    };
    // For one part, both losses are its distance; for several, the one with a tolerance includes the scatter.
    assert_eq!(losses(&plain, 1), losses(&tolerant, 1));
    let [mean, both] = [losses(&plain, 8), losses(&tolerant, 8)];
    let parts: Vec<f64> = tolerant
        .losses_on_fresh(&[groove.clone().into()], 2, &AtomicBool::new(false))
        .unwrap()
        .remove(0);
    assert!(both > mean && parts[0] != parts[1], "{mean} {both} {parts:?}");
}

/// A base with a disc of unknown size, on surfaces that do not differ.
const DISC: &str = "[base]\nslider.blocks = [16, 16]\ndrive.v_star = 0.1\n\
    friction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\n\
    texture = [{ shape = 'cavity', lambda = '2 um' }]\n[design]\n";

/// A search for the size of a disc finds the best size of a scan that includes every possible texture. The
/// case in the folder has the disc, and the outline is a circle.
#[test]
fn the_number_of_a_shape_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let keys = "wish = { value = 0.7, of = 'static_friction' }\ncoverage = [0, 40]\n\
                unknowns = { 'texture.0.lambda' = ['1 um', '6 um'] }";
    let file = file_of(DISC, keys);
    let design = file.design().unwrap();
    let disc = |lambda: f64| {
        let text =
            format!("slider.blocks = [16, 16]\ntexture = [{{ shape = 'cavity', lambda = '{lambda} um' }}]");
        textured_blocks(&Case::parse(&text, "case", "", &[]).unwrap())
    };
    let mut discs: Vec<Arc<Vec<bool>>> = (0..=500)
        .map(|k| disc(1.0 + 0.01 * f64::from(k)).into())
        .collect();
    discs.dedup();
    discs.retain(|disc| design.check(disc).is_ok());
    let never = AtomicBool::new(false);
    let losses = design.losses_on_fresh(&discs, 1, &never).unwrap();
    let least = losses.into_iter().map(|losses| losses[0]).fold(1.0, f64::min);
    let mut opened = DesignFolder::open(&out, &file, false).unwrap();
    let told = opened.find(&bounds(150, &never), &mut |_| {}).unwrap();
    let found: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("design.json")).unwrap()).unwrap();
    assert_eq!(found["design"]["loss"], least, "{told}");
    assert!(discs.len() > 10 && least > 0.0, "{} {least}", discs.len());
    let [unknown] = found["unknowns"].as_array().unwrap().as_slice() else {
        panic!("{found}")
    };
    assert_eq!(
        (&unknown["key"], &unknown["unit"]),
        (&"texture.0.lambda".into(), &"um".into())
    );
    let value = unknown["value"].as_f64().unwrap();
    let words = told.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        words.contains(&format!("texture.0.lambda {value} um 1 um to 6 um")),
        "{told}"
    );
    let case = Case::load(&out.join("case.toml"), &[], &mut |_| true, Ranks::ALONE).unwrap();
    assert_eq!(textured_blocks(&case), disc(value));
    let drawn = fs::read_to_string(out.join("mask.svg")).unwrap();
    let radius = drawn.split(" r=\"").nth(1).unwrap().split('"').next().unwrap();
    // In mm. The tolerance is for rounding: no laser places an outline within a millionth of its radius.
    let off = radius.parse::<f64>().unwrap() / (value * 1e-3) - 1.0;
    assert!(off.abs() < 1e-6, "{drawn}");
    let tried = fs::read_to_string(out.join("evaluations.csv")).unwrap();
    assert!(
        tried
            .lines()
            .next()
            .unwrap()
            .ends_with(",lost,texture.0.lambda (um)"),
        "{tried}"
    );
}

/// Counts are whole numbers, and limits hold, also for every design of a front, which has its own numbers. A
/// search that was stopped continues to the same bytes.
#[test]
fn numbers_keep_the_limits_and_survive_stops() {
    let keys = "wish = { least = 'static_friction' }\ncoverage = [0, 30]\ngap_blocks = 2\nfront = [12]\n\
                [design.unknowns]\n'texture.0.array.0' = [1, 3]\n'texture.0.lambda' = { from = '1 um', to = '4 um', scale = 'log' }";
    let base = DISC.replace("lambda = '2 um'", "lambda = '2 um', array = [1, 1]");
    let file = file_of(&base, keys);
    let folders = [0; 2].map(|_| tempfile::tempdir().unwrap());
    let never = AtomicBool::new(false);
    let mut in_one_go = DesignFolder::open(folders[0].path(), &file, false).unwrap();
    let told = in_one_go.find(&bounds(80, &never), &mut |_| {}).unwrap();
    assert!(told.contains("texture.0.array.0 = "), "{told}");
    let front = fs::read_to_string(folders[0].path().join("front.csv")).unwrap();
    let rows: Vec<Vec<&str>> = front.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(
        rows[0][6..],
        ["design", "texture.0.array.0", "texture.0.lambda (um)"]
    );
    let numbers: Vec<f64> = [1, 2, 7, 8]
        .map(|column| rows[1][column].parse().unwrap())
        .to_vec();
    let [covered, loss, columns, radius] = numbers[..] else {
        panic!("{front}")
    };
    assert!(covered <= 12.0 && loss < 1.0 && columns.fract() == 0.0, "{front}");
    assert!(
        (1.0..=3.0).contains(&columns) && (1.0..=4.0).contains(&radius),
        "{front}"
    );
    let mask = textured_blocks(
        &Case::load(
            &folders[0].path().join("case.toml"),
            &[],
            &mut |_| true,
            Ranks::ALONE,
        )
        .unwrap(),
    );
    assert_eq!(file.design().unwrap().check(&mask), Ok(()));
    let mut rounds = 0;
    loop {
        let mut stopped = DesignFolder::open(folders[1].path(), &file, false).unwrap();
        let stop = AtomicBool::new(false);
        let before = stopped.n_kept();
        let found = stopped.find(&bounds(80, &stop), &mut |now| {
            if now.runs > 8 && stopped_at(rounds, now.stage) {
                stop.store(true, Ordering::Relaxed);
            }
        });
        match found {
            Ok(_) => break,
            Err(StudyError::Interrupted) => assert!(stopped.n_kept() >= before),
            Err(error) => panic!("{error}"),
        }
        let case = fs::read_to_string(folders[1].path().join("case.toml")).unwrap();
        assert!(case.contains("shape = \"cavity\""), "{case}");
        rounds += 1;
    }
    assert_eq!(rounds, 3);
    assert!(
        files(folders[0].path()) == files(folders[1].path()),
        "the folders differ"
    );
}

/// Whether a search is stopped in a stage of this round.
fn stopped_at(round: usize, stage: DesignStage) -> bool {
    match round {
        0 => stage == DesignStage::Exploring,
        1 => stage == DesignStage::Refining,
        2 => stage == DesignStage::Judging,
        _ => false,
    }
}

/// A texture reproduces the curve of a texture.
#[test]
fn a_curve_is_followed() {
    let folder = tempfile::tempdir().unwrap();
    let case = Case::parse(
        "slider.blocks = [16, 16]\ndrive.v_star = 0.1\nfriction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\ntexture = [{ shape = 'groove', coverage = 12.5 }]",
        "case",
        "",
        &[],
    )
    .unwrap();
    let record = slipfront_run::running::run(&std::sync::Arc::new(case), 1).unwrap();
    let mut table = "X (nm),mu (1)\n".to_owned();
    for row in record.rows.iter().filter(|row| row.time_star < 30.0) {
        let path = 0.1 * row.time_star * record.summary.si.as_ref().unwrap().displacement_unit_m * 1e9;
        table += &format!(
            "{path},{}\n",
            row.point.mu_star * record.summary.static_friction / record.summary.static_friction_star
        );
    }
    fs::write(folder.path().join("wanted.csv"), table).unwrap();
    let text = format!(
        "{SMOOTH}wish = {{ curve = {{ file = 'wanted.csv', x = 'X', y = 'mu' }} }}\ncoverage = [0, 15]\nfeature_blocks = 2\n"
    );
    let file = DesignFile::parse(&text, "design.toml", "design", folder.path()).unwrap();
    let outcome = run(&file.design().unwrap(), 200);
    // The search begins with the groove itself, among others; its curve is rounded in the table.
    assert!(outcome.verdict.design.loss < 1e-9, "{:?}", outcome.verdict);
}

/// A base that names files gives the same result from its own folder and from copies. A design keeps the
/// content of files that change later.
#[test]
fn a_base_may_name_files() {
    let folder = tempfile::tempdir().unwrap();
    let field = |value: f64| vec![vec![value.to_string(); 8].join(","); 8].join("\n");
    fs::write(folder.path().join("mu.csv"), field(0.9)).unwrap();
    let text = "[base]\nslider.blocks = [8, 8]\ndrive.v_star = 0.1\nfriction.mu_static_field = 'mu.csv'\n\
                [design]\nwish = { least = 'static_friction' }\ncoverage = [0, 25]\nfeature_blocks = 2";
    let file = DesignFile::parse(text, "design.toml", "design", folder.path()).unwrap();
    let found = run(&file.design().unwrap(), 20);
    let out = folder.path().join("out");
    let mut opened = DesignFolder::open(&out, &file, false).unwrap();
    opened
        .find(&bounds(20, &AtomicBool::new(false)), &mut |_| {})
        .unwrap();
    let written: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("design.json")).unwrap()).unwrap();
    assert_eq!(written["design"]["loss"], found.verdict.design.loss);
    // The field has no coefficients for finer blocks.
    let [left_out] = found.verdict.sensitivity.left_out.as_slice() else {
        panic!("{:?}", found.verdict.sensitivity);
    };
    assert_eq!(left_out.change, "blocks of half the size");
    assert!(
        left_out.why.starts_with("`friction.mu_static_field`"),
        "{left_out:?}"
    );
    let told = fs::read_to_string(out.join("design.txt")).unwrap();
    assert!(
        told.contains("note: nothing is known of blocks of half the size: `friction.mu_static_field`"),
        "{told}"
    );
    drop(opened);
    let design = file.design().unwrap();
    fs::write(folder.path().join("mu.csv"), field(0.5)).unwrap();
    let again = run(&design, 20).verdict;
    assert_eq!(again.design, found.verdict.design, "it keeps what it was made of");
}

/// The verdict names the changes that are impossible with a program of speeds.
#[test]
fn a_program_of_speeds_has_no_other_speed() {
    let base = "[base]\nslider.blocks = [8, 8]\ndrive.program = [{ v_star = 0.1, until_star = 40 }, { v_star = 0.05 }]\n\
                time.duration_star = 80\n[design]\n";
    let file = file_of(base, "wish = { least = 'static_friction' }\ncoverage = [0, 25]");
    let sensitivity = run(&file.design().unwrap(), 10).verdict.sensitivity;
    let left_out: Vec<[&str; 2]> = sensitivity
        .left_out
        .iter()
        .map(|left_out| [left_out.change.as_str(), &left_out.why])
        .collect();
    let why = "the drive has a program of speeds";
    assert_eq!(
        left_out,
        [["a third of the speed", why], ["three times the speed", why]]
    );
    assert_eq!(sensitivity.changed.len(), 5);
}

/// A texture that leaves only blocks with almost no friction in contact never comes to rest while the drive
/// is held. It is lost, and the table, the verdict and its text report the reason, also in a repeated call. A
/// slider with only such blocks has no value to compare with.
#[test]
fn what_never_comes_to_rest_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let base = "[base]\nslider = { blocks = [2, 1], omega_star = 0 }\ndrive = { v_star = 0.1, loading = 'held' }\n\
                friction = { mu_kinetic_field = 'mu_k.csv', sigma_static_star = 0, sigma_kinetic_star = 0, \
                slip_weakening = { length_star = 0.1 } }\n[design]\n\
                wish = { least = 'static_friction' }\ncoverage = [0, 50]\n\
                starts = [[{ shape = 'groove', width = '1 um', offset = '-0.5 um' }]]";
    let of = |row: &str| {
        fs::write(folder.path().join("mu_k.csv"), row).unwrap();
        DesignFile::parse(base, "design.toml", "design", folder.path()).unwrap()
    };
    // Once weakened, the second block alone oscillates longer than a held drive waits for it. If the first
    // block is in contact, it dissipates the energy.
    let file = of("0.5,1e-4");
    let out = folder.path().join("out");
    let find = || {
        let mut opened = DesignFolder::open(&out, &file, false).unwrap();
        let text = opened
            .find(&bounds(40, &AtomicBool::new(false)), &mut |_| {})
            .unwrap();
        assert_eq!(opened.damaged, 0);
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let text = find();
    let remedy = "increase kinetic friction or damping, or use constant loading";
    let told = "note: on new surfaces the start 1 of the file fails: ";
    let after = text.split(told).nth(1).unwrap_or_else(|| panic!("{text}"));
    assert!(after.contains(remedy), "{text}");
    assert!(
        text.contains("failed (evaluations.csv has the reasons)"),
        "{text}"
    );
    assert!(!text.contains("inf") && !text.contains("NaN"), "{text}");
    let mut table = csv::Reader::from_path(out.join("evaluations.csv")).unwrap();
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    let lost: Vec<&csv::StringRecord> = rows.iter().filter(|row| &row[4] == "inf").collect();
    assert!(!lost.is_empty() && lost.len() < rows.len());
    assert!(
        text.contains("note: the design fails at one block towards -x: "),
        "{text}"
    );
    assert!(lost.iter().all(|row| row[6].contains(remedy)));
    assert!(rows.iter().all(|row| (&row[4] == "inf") != row[6].is_empty()));
    assert_eq!(find(), text, "what is lost is kept in the journal");

    let smooth = of("1e-9,1e-9");
    let error = smooth.design().unwrap().run(
        &bounds(40, &AtomicBool::new(false)),
        &mut RunCache::new(),
        &mut |_| Ok(()),
        &mut |_| {},
    );
    let said = error.unwrap_err().to_string();
    assert!(
        said.starts_with("a comparison with the untextured slider is not possible") && said.contains(remedy),
        "{said}"
    );
}

/// Each case has the wish in its own units: under another load, a force is another share of mu_s, and a share
/// of mu_s is another force.
#[test]
fn every_case_has_the_wish_in_its_own_units() {
    let least = |of: &str| {
        let keys = format!(
            "wish = {{ value = {of} }}\ncoverage = [0, 15]\njudge_by = 'worst'\n\
             cases = [{{ load.pressure = '1 MPa' }}, {{ load.pressure = '2 MPa' }}]"
        );
        let outcome = found(&keys, 1);
        let stars = outcome.verdict.design.cases.iter();
        let stars: Vec<f64> = stars.map(|given| given.static_friction_star.mean).collect();
        (outcome.verdict.design.loss, stars)
    };
    // In dimensionless form, the two loads are the same case. With mu_s = 1, 256 um^2 under 1 MPa resist 256
    // uN.
    let newtons = 256.0 * 0.8;
    let (loss, stars) = least(&format!("'{newtons} uN', of = 'static_friction'"));
    let distance = |star: f64, wanted: f64| (star / wanted - 1.0).abs();
    let expected = distance(stars[0], 0.8).max(distance(stars[1], 0.4));
    assert!((loss - expected).abs() < 1e-9, "{loss} {expected} {stars:?}");
    let (loss, stars) = least("0.8, of = 'static_friction_star'");
    let expected = distance(stars[0], 0.8).max(distance(stars[1], 0.8));
    assert!((loss - expected).abs() < 1e-9, "{loss} {expected} {stars:?}");
}

/// The written cases are those of the verdict, not the base. A front that is stopped leaves the design
/// unchanged.
#[test]
fn the_folder_has_the_cases_of_the_verdict() {
    let file = file_of(
        SMOOTH,
        "wish = { least = 'static_friction' }\ncoverage = [0, 15]\nfront = [0.1, 10]\n\
         cases = [{ drive.v_star = 0.2 }, { drive.v_star = 0.3, load.pressure = '2 MPa' }]",
    );
    let folder = tempfile::tempdir().unwrap();
    let mut opened = DesignFolder::open(folder.path(), &file, false).unwrap();
    let stop = AtomicBool::new(false);
    let (mut is_judged, mut work) = (false, Vec::new());
    let stopped = opened.find(&bounds(60, &stop), &mut |now| {
        work.push((now.stage, now.work));
        is_judged |= now.stage == DesignStage::Judging;
        // No texture covers at most a thousandth of 256 blocks, so the next search is the one up to 10 %.
        stop.store(is_judged && now.best_texture.is_some(), Ordering::Relaxed);
    });
    assert!(matches!(stopped, Err(StudyError::Interrupted)), "{stopped:?}");
    for (name, v_star) in [("case.toml", 0.2), ("case_2.toml", 0.3)] {
        let case = slipfront_case::case::Case::load(
            &folder.path().join(name),
            &[],
            &mut |_| true,
            slipfront_case::case::Ranks::ALONE,
        )
        .unwrap();
        assert_eq!(case.groups.v_star, v_star);
        assert!(
            case.model.surface.texture_percent() > 10.0,
            "the design of the largest coverage"
        );
    }
    assert!(!folder.path().join("case_3.toml").exists());
    let text = fs::read_to_string(folder.path().join("design.txt")).unwrap();
    let line = text.lines().find(|line| line.contains("case_2.toml")).unwrap();
    assert!(line.contains("drive.v_star=0.3, load.pressure="), "{text}");
    let judged = work.iter().filter(|(stage, _)| *stage == DesignStage::Judging);
    let judged: Vec<RunCost> = judged.map(|(_, work)| *work).collect();
    let falls = |pair: &[RunCost]| pair[0].here <= pair[1].here && pair[0].left >= pair[1].left;
    assert!(judged.len() > 5 && judged.windows(2).all(falls), "{judged:?}");
    // The remaining cost includes the second design of the front.
    assert!(judged.iter().all(|work| work.left > 0.0));
    let text = opened
        .find(&bounds(60, &AtomicBool::new(false)), &mut |_| {})
        .unwrap();
    assert!(text.contains("no texture satisfies the limits"), "{text}");
}

/// A note warns of a slider that is too thick for a sheet, compared with the features of the design.
#[test]
fn a_thick_slider_is_told() {
    for (thickness, is_told) in [("0.6 um", false), ("4 um", true)] {
        let base = SMOOTH.replace("[design]", &format!("slider.thickness = '{thickness}'\n[design]"));
        let folder = tempfile::tempdir().unwrap();
        let mut opened = DesignFolder::open(folder.path(), &file_of(&base, LEAST), false).unwrap();
        let text = opened
            .find(&bounds(30, &AtomicBool::new(false)), &mut |_| {})
            .unwrap();
        assert_eq!(
            text.contains("note: `slider.thickness` is 4 um, more"),
            is_told,
            "{text}"
        );
        assert!(!text.contains("note: `slider.thickness` is 0.6 um"), "{text}");
    }
}

/// Textures that the search begins with are judged, and a note names those that break a limit.
#[test]
fn drawings_are_judged() {
    let groove = |percent: f64, offset: i32| {
        format!(
            "[{{ shape = 'groove', orientation = 'along', coverage = {percent}, offset = '{offset} um' }}]"
        )
    };
    let folder = tempfile::tempdir().unwrap();
    let file = file_of(
        SMOOTH,
        &format!(
            "wish = {{ least = 'static_friction' }}\ncoverage = [0, 15]\nfeature_blocks = 2\nstarts = [{}, {}, {}]",
            groove(12.5, -4),
            groove(25.0, 4),
            groove(6.25, 4)
        ),
    );
    let mut opened = DesignFolder::open(folder.path(), &file, false).unwrap();
    let text = opened
        .find(&bounds(1, &AtomicBool::new(false)), &mut |_| {})
        .unwrap();
    let told = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        !told.contains("not used by the search"),
        "there is one surface: {text}"
    );
    let found: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path().join("design.json")).unwrap()).unwrap();
    let others = found["others"].as_array().unwrap();
    for (name, percent) in [("start 1 of the file", 12.5), ("start 2 of the file", 12.5)] {
        let other = others.iter().find(|other| other["name"] == name).unwrap();
        assert_eq!(other["coverage_percent"], percent, "{text}");
        assert!(
            other["design_is_better_by"]["mean"].as_f64().unwrap() > 0.0,
            "{text}"
        );
    }
    assert!(
        told.contains("note: the start 2 of the file violates a limit: the texture covers 25.00 % of the slider; 0 to 15 % are allowed"),
        "{text}"
    );
    assert!(
        told.contains("note: the start 3 of the file violates a limit: a feature is 1 block wide; the minimum is 2; no part is within the limits"),
        "{text}"
    );
}

/// A folder with changed files belongs to another design. A longer search that is stopped leaves the results
/// of the shorter one.
#[test]
fn results_belong_to_one_search() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let forbid = |column: usize| {
        let clamped: Vec<bool> = (0..64).map(|block| block % 8 == column).collect();
        let mask = slipfront_case::arrays::npy_of_mask(8, &clamped);
        fs::write(folder.path().join("clamp.npy"), mask).unwrap();
    };
    forbid(0);
    let text = "[base]\nslider.blocks = [8, 8]\ndrive.v_star = 0.1\nfriction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\n\
                [design]\nwish = { least = 'static_friction' }\ncoverage = [0, 25]\n\
                forbidden = [{ shape = 'mask', file = 'clamp.npy' }]";
    let file = DesignFile::parse(text, "design.toml", "design", folder.path()).unwrap();
    let mut opened = DesignFolder::open(&out, &file, false).unwrap();
    opened
        .find(&bounds(20, &AtomicBool::new(false)), &mut |_| {})
        .unwrap();
    let before = fs::read(out.join("mask.npy")).unwrap();
    let stop = AtomicBool::new(false);
    let stopped = opened.find(&bounds(400, &stop), &mut |now| {
        stop.store(now.runs > 100, Ordering::Relaxed);
    });
    assert!(matches!(stopped, Err(StudyError::Interrupted)));
    assert_eq!(fs::read(out.join("mask.npy")).unwrap(), before);
    // Results follow from a part of the runs.
    let verdict = verify(&out, &[DESIGNS], Extent::Derived, &AtomicBool::new(false));
    assert!(matches!(verdict, Err(StudyError::Unfinished { .. })));
    drop(opened);
    forbid(7);
    let file = DesignFile::parse(text, "design.toml", "design", folder.path()).unwrap();
    assert!(matches!(
        DesignFolder::open(&out, &file, false),
        Err(StudyError::Changed { .. })
    ));
}

#[test]
fn limits_are_kept_and_cases_are_all_looked_at() {
    let keys = "wish = { largest = 'static_friction' }\ncoverage = [5, 12]\nfeature = '2 um'\ngap = '2 um'\nmirror = 'both'\n\
                max_features = 2\nforbidden = [{ shape = 'cavity', coverage = 20 }]\njudge_by = 'worst'\n\
                cases = [{ drive.v_star = 0.1 }, { drive.v_star = 0.2 }]\n\
                starts = [[{ shape = 'groove', orientation = 'along', coverage = 12.5 }]]";
    let outcome = found(keys, 250);
    let blocks = outcome.texture.iter().filter(|&&textured| textured).count();
    assert!((13..=30).contains(&blocks), "{blocks}");
    for (block, &textured) in outcome.texture.iter().enumerate() {
        let [x, y] = [block % 16, block / 16];
        assert_eq!(textured, outcome.texture[y * 16 + 15 - x]);
        assert_eq!(textured, outcome.texture[(15 - y) * 16 + x]);
        // The forbidden cavity reaches 4.04 blocks from the middle.
        let from_middle = (x as f64 - 7.5).hypot(y as f64 - 7.5);
        assert!(!textured || from_middle > 4.0);
    }
    assert_eq!(outcome.verdict.design.cases.len(), 2);
}

#[test]
fn what_cannot_be_is_told_with_its_place() {
    let said = |keys: &str| {
        let text = format!("{BASE}{keys}\n");
        let file = DesignFile::parse(&text, "design.toml", "design", Path::new(""));
        match file.and_then(|file| file.design()) {
            Ok(_) => panic!("{keys} is accepted"),
            Err(error) => error.to_string(),
        }
    };
    let wish = "wish = { least = 'static_friction' }";
    for (keys, expected) in [
        ("coverage = [0, 10]", "wish"),
        ("wish = { least = 'friction' }\ncoverage = [0, 10]", "friction"),
        (
            "wish = { least = 'static_friction', value = 0.3 }\ncoverage = [0, 10]",
            "`wish` is one of",
        ),
        ("wish = { value = 0.3 }\ncoverage = [0, 10]", "`wish` is one of"),
        (
            "wish = { value = '3 m', of = 'static_friction' }\ncoverage = [0, 10]",
            "3 m",
        ),
        (
            "wish = { value = -1, of = 'static_friction' }\ncoverage = [0, 10]",
            "a number of more than 0",
        ),
        (
            "wish = { value = 1, of = 'work' }\ncoverage = [0, 10]",
            "`of` must be",
        ),
        (&format!("{wish}\ncoverage = [10, 0]"), "`coverage` = [10, 0]"),
        (&format!("{wish}\ncoverage = [0, 10]\nfeatures = 2"), "feature"),
        (
            &format!("{wish}\ncoverage = [0, 10]\nfeature = '1 um'\nfeature_blocks = 1"),
            "exclude each other",
        ),
        (
            &format!("{wish}\ncoverage = [0, 10]\nfeature = '30 um'"),
            "30 blocks, more than the slider's 16",
        ),
        (
            &format!("{wish}\ncoverage = [0, 10]\ngap_blocks = 0"),
            "must be at least 1",
        ),
        (
            &format!("{wish}\ncoverage = [0, 10]\ncopies = [3, 1]"),
            "which 3 does not divide",
        ),
        (
            &format!("{wish}\ncoverage = [0, 10]\nfront = [5, 12]"),
            "at most 10, the largest `coverage`",
        ),
        (&format!("{wish}\ncoverage = [0, 10]\nruns = 0"), "`runs` = 0"),
        (
            &format!("{wish}\ncoverage = [0, 10]\ndrafts_at_once = 0"),
            "`drafts_at_once` = 0 must lie between 1 and 100000",
        ),
        (
            &format!("{wish}\ncoverage = [0, 10]\nmax_features = 0"),
            "at least 1",
        ),
        (
            &format!("{wish}\ncoverage = [0, 10]\nforbidden = 3"),
            "must be a list of textures",
        ),
        (
            &format!("{wish}\ncoverage = [0, 10]\nstarts = [[{{ shape = 'star' }}]]"),
            "star",
        ),
        (
            &format!("{wish}\ncoverage = [0, 10]\ncases = [{{ slider.blocks = [8, 8] }}]"),
            "the blocks of the base",
        ),
        (
            &format!("{wish}\ncoverage = [0, 10]\ncases = [{{ texture = [] }}]"),
            "into `starts`",
        ),
        (
            "wish = { value = '1 mN', of = 'static_friction_star' }\ncoverage = [0, 10]",
            "leave out _star",
        ),
        (
            &format!("{wish}\ncoverage = [0, 10]\n[study]\nreplicates = 3"),
            "study",
        ),
        (
            &format!("{wish}\ncoverage = [0, 10]\nunknowns = {{ 'drive.v_star' = [0.1, 0.2] }}"),
            "the unknown `drive.v_star` is not a key of a texture",
        ),
        (
            &format!("{wish}\ncoverage = [0, 10]\ntolerance = 0.01"),
            "`tolerance` belongs to a target value",
        ),
        (
            "wish = { value = 0.3, of = 'static_friction' }\ncoverage = [0, 10]\ntolerance = '1 uN'",
            "`tolerance` is in the unit of `value`",
        ),
        (
            "wish = { value = 0.3, of = 'static_friction' }\ncoverage = [0, 10]\ntolerance = 0",
            "`tolerance` must be a number of more than 0",
        ),
        (
            &format!("{wish}\ncoverage = [0, 10]\nunknowns = {{ 'texture.0.lambda' = ['6 um', '2 um'] }}"),
            "the range of `texture.0.lambda` is 6 to 2",
        ),
        (
            &format!("{wish}\ncoverage = [0, 10]\nunknowns = {{ 'texture.0.lambda' = ['2 um', '6 um'] }}"),
            "The case has no such texture",
        ),
    ] {
        let said = said(keys);
        assert!(
            said.contains(expected) && said.contains("design.toml"),
            "{keys}\n{said}"
        );
    }
    // Limits that no texture satisfies.
    let file = file("wish = { least = 'static_friction' }\ncoverage = [1, 3]\nfeature_blocks = 4");
    let never = AtomicBool::new(false);
    let error = file.design().unwrap().run(
        &bounds(10, &never),
        &mut RunCache::new(),
        &mut |_| Ok(()),
        &mut |_| {},
    );
    assert!(matches!(error, Err(StudyError::NoDesign { .. })));
}

/// A texture whose load no block can bear does not end a search: a pattern is left out, and a draft is lost
/// with its reason.
#[test]
fn what_a_case_refuses_is_left_out() {
    let base = "[base]\nslider.blocks = [16, 16]\ndrive.v_star = 0.1\nload.redistribute = { within = '2 um' }\n\
        friction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\n[design]\n";
    let keys = "wish = { least = 'static_friction' }\ncoverage = [0, 50]";
    let file = |within: &str| file_of(&base.replace("2 um", within), keys);
    let [of_all, legal] = ["20 um", "2 um"].map(|within| file(within).plan(40, 1).unwrap().patterns.len());
    assert!(legal < of_all, "{legal} of {of_all}");
    let folder = tempfile::tempdir().unwrap();
    let mut opened = DesignFolder::open(folder.path(), &file("2 um"), false).unwrap();
    let never = AtomicBool::new(false);
    let told = opened.find(&bounds(40, &never), &mut |_| {}).unwrap();
    assert!(told.contains("tested by the search failed"), "{told}");
    let drafts = fs::read_to_string(folder.path().join("evaluations.csv")).unwrap();
    let why = "no block in contact is within 2.0 blocks of the textured block";
    assert!(drafts.contains(why), "{drafts}");
    opened.expect_verdict().unwrap();
}

/// A disc 6 blocks across has features of 6 blocks, although no square of 5 blocks lies in it. Drafts that
/// break a limit are counted.
#[test]
fn a_shape_is_as_wide_as_it_is_drawn() {
    let base = SMOOTH.replace(
        "[design]",
        "texture = [{ shape = 'cavity', lambda = '3 um' }]\n[design]",
    );
    let told = |feature: &str| {
        let keys = format!(
            "wish = {{ value = 0.7, of = 'static_friction' }}\ncoverage = [0, 40]\nfeature = '{feature}'\n\
             unknowns = {{ 'texture.0.lambda' = ['2 um', '3.2 um'] }}"
        );
        let folder = tempfile::tempdir().unwrap();
        let mut opened = DesignFolder::open(folder.path(), &file_of(&base, &keys), false).unwrap();
        let never = AtomicBool::new(false);
        let told = opened.find(&bounds(40, &never), &mut |_| {});
        let told = told.map(|told| told.split_whitespace().collect::<Vec<_>>().join(" "));
        let numbers = fs::read(folder.path().join("design.json")).unwrap_or_default();
        (told, serde_json::from_slice(&numbers).unwrap_or_default())
    };
    let (text, numbers): (_, serde_json::Value) = told("5.5 um");
    let text = text.unwrap();
    let width = numbers["as_meshed"]["feature_m"].as_f64().unwrap();
    assert!((5.5e-6..=6.4e-6).contains(&width), "{text}");
    let rejected = &numbers["rejected"];
    assert!(rejected["drafts"].as_u64() > Some(0), "{rejected}");
    let expected = format!(
        "; {} drafts rejected before a run; the last: ",
        rejected["drafts"]
    );
    assert!(text.contains(&expected) && !text.contains("violates"), "{text}");
    let said = told("6.5 um").0.unwrap_err().to_string();
    assert!(
        said.contains("rejected before a run; the last: a feature is"),
        "{said}"
    );
}

/// Textures of a search have no pitch, within which a bulk body would redistribute the load, so the base must
/// give a distance.
#[test]
fn a_bulk_body_says_how_near_load_is_borne() {
    let base = "[base]\nslider = { blocks = [16, 16], body = 'bulk' }\ndrive.v_star = 0.1\n\
        texture = [{ shape = 'cavity', lambda = '2 um', pitch = '8 um' }]\n";
    let refused = file_of(&format!("{base}[design]\n"), LEAST)
        .design()
        .err()
        .unwrap()
        .to_string();
    assert!(
        refused.contains("give `load.redistribute` = { within = \"...\" } in the base"),
        "{refused}"
    );
    let near = "load.redistribute = { within = '4 um' }\n[design]\n";
    file_of(&format!("{base}{near}"), LEAST).design().unwrap();
}
