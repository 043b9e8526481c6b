//! `slipfront verify` of a study: its tables and pictures must follow from its records.

use std::path::{Path, PathBuf};

use super::results::{SMALL, SMALL_RUNS};
use crate::fixtures::list_as_written;
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
        said.contains(&format!("a study as its {SMALL_RUNS} recorded runs give it")),
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
    std::fs::remove_dir_all(results.path.join("runs")).unwrap();
    for line in ["out", "--checksums out"] {
        let (status, said, _) = verified(&workspace, line);
        assert!(
            status == 1 && said.contains("2 run folders are missing in out/runs: put back"),
            "{said}"
        );
    }
    // A user who needs them no longer says so.
    let study = String::from_utf8(workspace.read("out/study.toml")).unwrap();
    workspace.write("out/study.toml", study.replace("\"all\"", "\"none\""));
    workspace.succeed("study out/study.toml -o out -q");
    let (status, said, _) = verified(&workspace, "out");
    assert!(status == 0 && said.contains(", 0 run folders"), "{said}");
}

/// Seen without the recorded runs as with them, and by `export`.
fn refused(workspace: &Workspace, folder: &str, sentence: &str) {
    for line in [folder.to_owned(), format!("--checksums {folder}")] {
        let (status, said, problems) = verified(workspace, &line);
        assert!(status == 1 && said.contains(sentence), "{line}: {said}{problems}");
    }
    let exported = workspace.output(&format!("export {folder} --ro-crate -o crate"));
    let said = stderr(&exported);
    assert!(
        exported.status.code() == Some(1) && said.contains(sentence),
        "{said}"
    );
    assert!(!workspace.path("crate").exists());
}

#[test]
fn a_run_folder_is_the_one_that_the_journal_names() {
    let study = "base.slider.blocks = [4, 4]\nbase.drive.v_star = 0.2\n[study]\nreplicates = 2\nkeep = 'all'";
    let workspace = Workspace::with_study(study);
    workspace.write("other.toml", study.replace("0.2", "0.25"));
    workspace.study("out");
    workspace.succeed("study other.toml -q -o other");
    let runs = |folder: &str| -> Vec<PathBuf> {
        let entries = std::fs::read_dir(workspace.path(folder).join("runs")).unwrap();
        entries.map(|entry| entry.unwrap().path()).collect()
    };
    let (own, others) = (runs("out"), runs("other"));
    let exchange = |one: &Path, other: &Path| {
        let between = workspace.path("between");
        std::fs::rename(one, &between).unwrap();
        std::fs::rename(other, one).unwrap();
        std::fs::rename(&between, other).unwrap();
    };
    for other in [&own[1], &others[0]] {
        exchange(&own[0], other);
        refused(
            &workspace,
            "out",
            "is not the folder of the run that the journal names there",
        );
        exchange(&own[0], other);
    }
    std::fs::rename(&own[0], workspace.path("away")).unwrap();
    refused(&workspace, "out", "1 run folder is missing in out/runs");
    std::fs::rename(workspace.path("away"), &own[0]).unwrap();
    assert_eq!(verified(&workspace, "out").0, 0);
    std::fs::rename(&others[0], workspace.path("out/runs/0123456789ab")).unwrap();
    let (status, said, _) = verified(&workspace, "out");
    assert!(
        status == 0 && said.contains("0123456789ab is of no run in the journal"),
        "{said}"
    );
}

/// The journal of complete results is sealed with them; lines that were appended since are work in progress.
#[test]
fn a_journal_that_was_changed_is_seen_and_one_that_grew_is_not_finished() {
    let workspace = Workspace::with_study(SMALL);
    workspace.study("out");
    let whole = workspace.read("out/runs.jsonl");
    let lines: Vec<&[u8]> = whole.split_inclusive(|byte| *byte == b'\n').collect();
    let without_last = lines[..lines.len() - 1].concat();
    let in_another_order = [lines[1], lines[0], &lines[2..].concat()].concat();
    for changed in [Vec::new(), without_last, in_another_order] {
        workspace.write("out/runs.jsonl", changed);
        refused(&workspace, "out", "out/runs.jsonl differs: ");
    }
    let grown = [&whole[..], lines[0]].concat();
    workspace.write("out/runs.jsonl", grown);
    for line in ["out", "--checksums out"] {
        let (status, _, problems) = verified(&workspace, line);
        assert!(
            status == 2 && problems.contains("the study in out is not finished"),
            "{problems}"
        );
    }
    workspace.study("out");
    assert_eq!(verified(&workspace, "out").0, 0);
}

#[test]
fn a_list_is_as_it_was_written_to_the_byte() {
    let workspace = Workspace::with_study(SMALL);
    workspace.study("out");
    let whole = String::from_utf8(workspace.read("out/checksums.json")).unwrap();
    let end = whole.rfind("\n}").unwrap();
    for changed in [
        format!("{whole} "),
        whole.replacen('{', "{ ", 1),
        format!("{}, \"more\": 1\n}}\n", &whole[..end]),
        format!("{}, \"of\": \"design\"\n}}\n", &whole[..end]),
        whole.replacen("\n}\n", "}\n", 1),
    ] {
        workspace.write("out/checksums.json", changed);
        refused(&workspace, "out", "out/checksums.json is damaged: ");
    }
}

/// A folder of an earlier version, whose list says nothing of the journal and whose lines name no folders.
#[test]
fn a_folder_without_a_sealed_journal_is_verified_by_what_it_has() {
    let workspace = Workspace::with_study(SMALL);
    workspace.study("out");
    list_as_written(&workspace, "out", "runs.csv");
    let list = String::from_utf8(workspace.read("out/checksums.json")).unwrap();
    assert!(!list.contains("\"sources\""), "{list}");
    let (status, said, problems) = verified(&workspace, "out");
    assert_eq!((status, problems.as_str()), (0, ""), "{said}");
    workspace.remove("out/runs.jsonl");
    refused(
        &workspace,
        "out",
        "out/runs.jsonl is missing in the folder of a study: put it back",
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
    assert_eq!(verified(&workspace, "other").0, 1);
    list_as_written(&workspace, "other", "runs.csv");
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
        status == 1 && said.contains("runs.jsonl differs: other bytes were written\n"),
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
