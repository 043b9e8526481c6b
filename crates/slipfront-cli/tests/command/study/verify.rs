//! `slipfront verify` of a study: its tables and pictures must follow from its records.

use std::path::Path;

use super::results::{SMALL, SMALL_RUNS};
use crate::support::process::stderr;
use crate::support::workspace::Workspace;
use crate::verify::verified;

/// Every file of a folder, without those in subfolders.
fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap().map(Result::unwrap);
    let files = entries.filter(|entry| entry.file_type().unwrap().is_file());
    let mut names: Vec<String> = files
        .map(|entry| entry.file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_study_is_what_its_records_give() {
    let workspace = Workspace::with_study(SMALL);
    let results = workspace.study("out");
    let (status, said, problems) = verified(&workspace, "out");
    assert_eq!((status, problems.as_str()), (0, ""), "{said}");
    assert!(
        said.contains(&format!(
            "out: tables and pictures as its {SMALL_RUNS} recorded runs give them"
        )),
        "{said}"
    );
    for name in names(&results.path) {
        let path = results.path.join(&name);
        let bytes = std::fs::read(&path).unwrap();
        let mut changed = bytes.clone();
        changed[bytes.len() / 2] ^= 1;
        std::fs::write(&path, changed).unwrap();
        let (status, said, problems) = verified(&workspace, "out");
        assert_eq!(status, 1, "{name}: {said}{problems}");
        let start = format!("out/{name} ");
        assert!(
            said.lines().any(|line| line.starts_with(&start)),
            "{name}: {said}"
        );
        std::fs::write(&path, bytes).unwrap();
    }
    std::fs::remove_file(results.path.join("points.csv")).unwrap();
    workspace.write("out/notes.txt", "mine");
    let (status, said, _) = verified(&workspace, "out");
    assert_eq!(
        (status, said.as_str()),
        (
            1,
            "out/points.csv is missing\nnote: out/notes.txt is not slipfront's\n"
        )
    );
}

#[test]
fn run_folders_of_a_study_are_verified_too() {
    let workspace = Workspace::with_study(
        "base.slider.blocks = [4, 4]\nbase.drive.v_star = 0.2\n[study]\nreplicates = 2\nkeep = 'all'",
    );
    let results = workspace.study("out");
    assert!(
        verified(&workspace, "out")
            .1
            .contains("2 run folders as they were written")
    );
    let run = std::fs::read_dir(results.path.join("runs"))
        .unwrap()
        .next()
        .unwrap()
        .unwrap();
    std::fs::write(run.path().join("series.csv"), "changed").unwrap();
    let (status, said, _) = verified(&workspace, "out");
    assert!(
        status == 1 && said.contains("series.csv differs: it has 7 bytes"),
        "{said}"
    );
    std::fs::remove_file(run.path().join("manifest.json")).unwrap();
    let (status, said, _) = verified(&workspace, "out");
    assert!(status == 1 && said.contains("has no manifest.json"), "{said}");
    // A user may have removed the run folders.
    std::fs::remove_dir_all(results.path.join("runs")).unwrap();
    let (status, said, _) = verified(&workspace, "out");
    assert!(status == 0 && said.contains(", 0 run folders"), "{said}");
    assert!(
        said.contains("note: 2 of 2 run folders are not in out/runs"),
        "{said}"
    );
}

/// Records of another study are reported as such, for example after an update of the program that changes its
/// runs.
#[test]
fn records_of_something_else_are_called_so() {
    let workspace = Workspace::with_study(SMALL);
    workspace.study("out");
    workspace.write("other.toml", format!("{SMALL}\n[base.friction]\nseed = 77\n"));
    workspace.succeed("study other.toml -o other");
    workspace.write("other/runs.jsonl", workspace.read("out/runs.jsonl"));
    let (status, _, problems) = verified(&workspace, "other");
    assert_eq!(status, 2);
    assert!(
        problems.contains("lacks 36 runs, and 36 recorded runs are from another program than slipfront "),
        "{problems}"
    );
}

#[test]
fn records_that_were_damaged_and_mended_are_whole() {
    let workspace = Workspace::with_study(SMALL);
    let results = workspace.study("out");
    let mut bytes = std::fs::read(results.records()).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(results.records(), bytes).unwrap();
    let (status, said, _) = verified(&workspace, "out");
    assert!(
        status == 1 && said.contains("differs: it has 1 damaged line\n"),
        "{said}"
    );
    workspace.study("out");
    let (status, said, _) = verified(&workspace, "out");
    assert!(
        status == 0 && said.contains("note: out/runs.jsonl has 1 damaged line, whose"),
        "{said}"
    );
}

#[test]
fn a_part_of_a_study_is_not_the_whole() {
    let workspace = Workspace::with_study(SMALL);
    workspace.succeed("study study.toml --shard 1/2 -o part");
    let (status, _, problems) = verified(&workspace, "part");
    assert_eq!(status, 2);
    assert!(
        problems.contains("the study in part lacks 18 runs: finish it first, or merge it"),
        "{problems}"
    );
}

#[test]
fn single_runs_are_repeated_and_studies_are_not() {
    let workspace = Workspace::with_study(SMALL);
    workspace.study("out");
    let output = workspace.output("verify --rerun out");
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("--rerun repeats only single runs"),
        "{}",
        stderr(&output)
    );
}

/// TOML writes lists of tables last in a table; the columns still have the order of the original study file.
#[test]
fn the_study_in_the_folder_has_its_axes_in_order() {
    let workspace = Workspace::with_study(
        "base.slider.blocks = [4, 4]\nbase.time.stop = 'after_onset'\n[study]\nreplicates = 2\n\
         [[axes]]\nzip = { 'texture.0' = [{ shape = 'groove', coverage = 25 }, { shape = 'cavity', coverage = 25 }], \
         'drive.v_star' = [0.1, 0.2] }",
    );
    let results = workspace.study("out");
    let points = std::fs::read_to_string(results.path.join("points.csv")).unwrap();
    assert!(points.starts_with("point,texture.0,drive.v_star,"), "{points}");
    let (status, said, problems) = verified(&workspace, "out");
    assert_eq!(status, 0, "{said}{problems}");
}
