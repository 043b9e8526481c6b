//! The folder of a study: kept files, damage, changes and foreign files.

use std::collections::BTreeSet;

use super::results::{Results, SMALL, SMALL_RUNS, field, filled, mask};
use crate::support::process::{stderr, stdout, wait_for};
use crate::support::workspace::Workspace;

#[test]
fn run_folders_are_kept_on_request() {
    for (keep, kept) in [("all", true), ("none", false), ("failed", false)] {
        // There are few runs, because each draws its pictures.
        let small = SMALL
            .replace("replicates = 3", &format!("replicates = 1\nkeep = '{keep}'"))
            .replace("[0.08, 0.1, 0.12, 0.14, 0.16, 0.18]", "[0.1]");
        let workspace = Workspace::with_study(&small);
        workspace.succeed("study study.toml -o out");
        let results = workspace.results("out");
        let folders = results.path.join("runs");
        assert_eq!(filled(&folders), kept, "{keep}");
        if !kept {
            continue;
        }
        let named: BTreeSet<String> = results
            .table("runs.csv")
            .iter()
            .map(|row| row["run"].clone())
            .collect();
        let found: BTreeSet<String> = std::fs::read_dir(folders)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        assert_eq!(found, named);
        for name in named {
            for file in [
                "manifest.json",
                "case.toml",
                "summary.json",
                "fields.nc",
                "friction.svg",
            ] {
                assert!(results.has(&format!("runs/{name}/{file}")), "{file}");
            }
        }
    }
}

#[test]
fn a_changed_study_adds_what_is_new_and_says_what_no_longer_belongs() {
    let workspace = Workspace::with_study(SMALL);
    let results = workspace.study("out");
    workspace.write(
        "study.toml",
        SMALL.replace("[0.08, 0.1, 0.12", "[0.2, 0.22, 0.24"),
    );
    let output = workspace.output("study study.toml -o out");
    assert!(output.status.success());
    let (said, warned) = (stdout(&output), stderr(&output));
    assert!(
        said.contains("18 recorded runs are not part of the present study"),
        "{said}"
    );
    assert!(warned.contains("the study was changed"), "{warned}");
    results.assert_each_run_once(SMALL_RUNS + SMALL_RUNS / 2);
    results.assert_same(&workspace.study("fresh"));
}

/// Damages the records, and asserts that a restart restores the results with `again` runs.
fn mends(damage: impl Fn(&mut Vec<u8>), again: usize) -> String {
    let workspace = Workspace::with_study(SMALL);
    let results = workspace.study("out");
    let answer = results.answer();
    let mut bytes = std::fs::read(results.records()).unwrap();
    damage(&mut bytes);
    std::fs::write(results.records(), &bytes).unwrap();
    let whole = results.recorded().len();
    let output = workspace.output("study study.toml -o out");
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(results.answer() == answer);
    assert_eq!(results.recorded().len(), whole + again);
    stderr(&output)
}

#[test]
fn a_damaged_line_is_run_again() {
    let said = mends(
        |bytes| {
            let middle = bytes.len() / 2;
            // The change is inside a number or a name: the line may still be JSON, but differs from the
            // written one.
            bytes[middle] ^= 1;
        },
        1,
    );
    assert!(said.contains("1 damaged line,"), "{said}");
}

#[test]
fn a_torn_last_line_is_run_again() {
    let said = mends(|bytes| bytes.truncate(bytes.len() - 100), 1);
    assert!(said.contains("1 damaged line,"), "{said}");
}

#[test]
fn a_folder_with_other_things_is_left_alone() {
    let workspace = Workspace::with_study(SMALL);
    workspace.write("out/thesis.tex", "years of work");
    workspace.write("notes/runs.jsonl", "my own records\nof something\n");
    for (out, sentence) in [
        ("out", "is not the folder of a study"),
        ("notes", "runs.jsonl is not a file of an earlier run"),
    ] {
        let output = workspace.output(&format!("study study.toml -o {out}"));
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(sentence), "{}", stderr(&output));
        assert_eq!(std::fs::read_dir(workspace.path(out)).unwrap().count(), 1);
    }
}

/// Numbers of the previous study must not remain next to those of the present one if that is stopped.
#[test]
fn a_changed_study_leaves_no_tables_of_what_it_was() {
    let workspace = Workspace::with_study(SMALL);
    let results = workspace.study("out");
    workspace.write("study.toml", SMALL.replace("[6, 6]", "[300, 300]"));
    let mut child = workspace.start("study study.toml --quiet --out out");
    let changed =
        || std::fs::read_to_string(workspace.path("out/study.toml")).is_ok_and(|text| text.contains("300"));
    wait_for("changed study in the folder", changed);
    child.kill().unwrap();
    child.wait().unwrap();
    for name in ["runs.csv", "points.csv", "static_friction_star.svg"] {
        assert!(!results.has(name), "{name}");
    }
    // They can be computed from the records at any time.
    workspace.write("study.toml", SMALL);
    workspace.study("out").assert_same(&workspace.study("fresh"));
}

/// The study in a results folder has the name of this folder, and continues there.
#[test]
fn a_recorded_study_goes_on_in_its_folder() {
    let workspace = Workspace::with_study(SMALL);
    workspace.study("results/out");
    let before = workspace.files("results");
    workspace.succeed("study results/out/study.toml");
    assert!(workspace.files("results") == before);
    // The records there are not replaced without request.
    let changed = "study results/out/study.toml --quiet --set friction.mu_static=0.7";
    let refused = workspace.fail(changed, 2);
    assert!(
        refused.contains("would replace results/out/study.toml"),
        "{refused}"
    );
    assert!(workspace.files("results") == before);
    workspace.succeed(&format!("{changed} -o results/other"));
}

/// The results folder contains the study with its base written out, which must not replace the only file that
/// refers to the base.
#[test]
fn a_study_file_that_names_its_base_is_not_replaced() {
    let workspace = Workspace::with_study(SMALL);
    workspace.study("out");
    workspace.write("case.toml", "slider.blocks = [6, 6]\n");
    let based = "# mine\nbase = '../case.toml'\n";
    workspace.write("out/study.toml", based);
    let output = workspace.output("study out/study.toml -o out");
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("would replace out/study.toml"),
        "{}",
        stderr(&output)
    );
    assert_eq!(
        std::fs::read_to_string(workspace.path("out/study.toml")).unwrap(),
        based
    );
}

/// Pictures of others stay, whatever their names: only pictures drawn by a study belong to it.
#[test]
fn pictures_of_others_stay() {
    let workspace = Workspace::with_study(SMALL);
    let results = workspace.study("out");
    let mine = [
        "static_friction_star_vs_experiment.png",
        "static_friction_star-mine.svg",
    ];
    for name in mine {
        workspace.write(&format!("out/{name}"), "mine");
    }
    workspace.study("out");
    workspace.write(
        "study.toml",
        SMALL.replace("[0.08, 0.1, 0.12", "[0.2, 0.22, 0.24"),
    );
    workspace.study("out");
    for name in mine {
        assert!(results.has(name), "{name}");
    }
}

#[test]
fn output_that_cannot_be_written_is_bad_input() {
    let workspace = Workspace::with_study(SMALL);
    workspace.write("file", "");
    for out in ["file/below", "file"] {
        let output = workspace.output(&format!("study study.toml -o {out}"));
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(
            stderr(&output).contains("cannot write to the folder"),
            "{}",
            stderr(&output)
        );
    }
}

#[test]
fn what_a_kill_left_half_written_is_removed() {
    let workspace = Workspace::with_study(SMALL);
    let results = workspace.study("out");
    workspace.write("out/.slipfront-0123456789abcdef-AbCdEf", "half a pict");
    workspace.study("out");
    assert!(!results.has(".slipfront-0123456789abcdef-AbCdEf"));
}

#[test]
fn the_folder_repeats_the_study_without_the_files_it_came_from() {
    let workspace = Workspace::new();
    workspace.write(
        "cases/fields/mu.csv",
        field(6, 6, |i, j| 0.9 + 0.01 * ((i * 7 + j * 3) % 11) as f64),
    );
    workspace.write("masks/bar.npy", mask(6, 6, |i, _| i == 2));
    workspace.write("cases/dot.npy", mask(6, 6, |i, j| i == 3 && j == 3));
    workspace.write(
        "cases/base.toml",
        "[slider]\nblocks = [6, 6]\n[time]\nstop = 'after_onset'\n[drive]\nv_star = 0.1\n[friction]\n\
         mu_static_field = 'fields/mu.csv'\n[[texture]]\nshape = 'mask'\nfile = 'dot.npy'",
    );
    workspace.write(
        "study.toml",
        r#"
        base = "cases/base.toml"
        study = { replicates = 2, reference = { texture = [] } }
        [[axes]]
        key = "texture.0.file"
        list = ["dot.npy", "../masks/bar.npy"]
        [[axes]]
        name = "surface"
        variants = { given = { friction.sigma_kinetic_star = 0.1 }, drawn = { friction.mu_static_field = "fields/mu.csv", friction.r_star = 0.4 } }
        "#,
    );
    let first = workspace.study("first");
    assert_eq!(first.table("runs.csv").len(), 16);
    assert_eq!(first.table("runs.csv")[8]["texture.0.file"], "bar.npy");
    for folder in ["cases", "masks"] {
        std::fs::remove_dir_all(workspace.path(folder)).unwrap();
    }
    workspace.succeed("study first/study.toml -o second");
    let second: Results = workspace.results("second");
    second.assert_same(&first);
    second.assert_each_run_once(first.recorded().len());
    // A copy can be made of the copy.
    std::fs::rename(workspace.path("first"), workspace.path("gone")).unwrap();
    workspace.succeed("study second/study.toml -o third");
    workspace.results("third").assert_same(&second);
}

#[test]
fn a_file_with_new_contents_is_a_new_case() {
    let workspace = Workspace::new();
    workspace.write("mask.npy", mask(4, 4, |i, _| i == 1));
    workspace.write(
        "study.toml",
        "base.slider.blocks = [4, 4]\nbase.time.stop = 'after_onset'\nbase.texture = [{ shape = 'mask', file = 'mask.npy' }]\n\
         [[axes]]\nkey = 'drive.v_star'\nlist = [0.1, 0.12]",
    );
    let results = workspace.study("out");
    results.assert_each_run_once(2);
    workspace.write("mask.npy", mask(4, 4, |i, _| i == 2));
    workspace.study("out").assert_each_run_once(4);
    results.assert_same(&workspace.study("fresh"));
    assert_eq!(
        std::fs::read(workspace.path("out/inputs/mask.npy")).unwrap(),
        std::fs::read(workspace.path("mask.npy")).unwrap()
    );
}

/// A point with diverging runs next to a point without: the command tests use the same case.
#[test]
fn a_run_that_diverges_is_recorded_and_kept_and_stops_nothing_else() {
    let workspace = Workspace::with_study(
        "[base]\nslider = { blocks = [6, 6], omega_star = 0 }\ndrive = { v_star = 10 }\n\
         friction = { r_star = 0, sigma_static_star = 1 }\ntime = { step = 0.9, duration_star = 2000 }\n\
         [study]\nkeep = 'failed'\n\
         [[axes]]\nkey = 'load.pressure'\nlist = ['50 GPa', '100 kPa']\n",
    );
    for _ in 0..2 {
        let output = workspace.output("study study.toml -o out");
        assert_eq!(output.status.code(), Some(1));
        assert!(
            stderr(&output).contains("1 of 2 runs failed"),
            "{}",
            stderr(&output)
        );
    }
    let results = workspace.results("out");
    let runs = results.table("runs.csv");
    let of = |pressure: &str| {
        runs.iter()
            .filter(|row| row["load.pressure"] == pressure)
            .collect::<Vec<_>>()
    };
    for row in of("50 GPa") {
        assert_eq!(row["status"], "failed");
        assert!(row["reason"].contains("diverged"), "{}", row["reason"]);
        assert!(results.has(&format!("runs/{}/case.toml", row["run"])));
        assert!(!results.has(&format!("runs/{}/manifest.json", row["run"])));
    }
    assert!(
        of("100 kPa")
            .iter()
            .all(|row| row["status"] == "done" && !row["static_friction_star"].is_empty())
    );
    assert_eq!((of("50 GPa").len(), of("100 kPa").len()), (1, 1));
}
