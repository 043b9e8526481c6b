//! Replacement of files in the run folder: only slipfront's own files are replaced.

use crate::fixtures::{MASKED, SMALL};
use crate::support::process::ended_with;
use crate::support::workspace::Workspace;

#[test]
fn a_folder_that_holds_something_is_refused() {
    let workspace = Workspace::small();
    workspace.write("full/notes.txt", "mine");
    let said = workspace.fail("run small.toml --quiet -o full", 2);
    assert!(
        said.contains("full is not empty") && said.contains("--force"),
        "{said}"
    );
    assert_eq!(workspace.files("full").len(), 1);
    // An empty folder is used, and a missing one is made.
    std::fs::create_dir(workspace.path("empty")).unwrap();
    workspace.succeed("run small.toml -o empty");
    workspace.succeed("run small.toml -o not/yet/there");
    assert!(
        workspace
            .fail("run small.toml --quiet -o empty", 2)
            .contains("not empty")
    );
}

#[test]
fn force_replaces_own_files_only() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o clean --set output.snapshots=[]");
    workspace.succeed("run small.toml -o a");
    workspace.write("a/notes.txt", "mine");
    workspace.write("a/inputs/old.png", "mine too");
    workspace.succeed("run small.toml -o a --force --set output.snapshots=[]");
    assert_eq!(workspace.read("a/notes.txt"), b"mine");
    assert_eq!(workspace.read("a/inputs/old.png"), b"mine too");
    std::fs::remove_file(workspace.path("a/notes.txt")).unwrap();
    std::fs::remove_dir_all(workspace.path("a/inputs")).unwrap();
    // No file of the first run is left, such as its maps.
    workspace.assert_same_run("clean", "a");
}

#[test]
fn force_takes_copies_of_an_earlier_run_along() {
    let workspace = Workspace::masked();
    workspace.succeed("run masked.toml -o a");
    workspace.succeed("run masked.toml -o a --force");
    assert!(workspace.exists("a/inputs/spot.png"));
    workspace.succeed("run small.toml -o a --force");
    assert!(
        !workspace.exists("a/inputs"),
        "an input that is no longer used has stayed"
    );
}

#[test]
fn a_foreign_file_in_the_place_of_a_copy_is_refused_before_the_run() {
    let workspace = Workspace::masked();
    workspace.write("a/inputs/spot.png", "mine");
    let said = workspace.fail("run masked.toml --quiet -o a --force", 2);
    assert!(
        said.contains("spot.png is not a file of an earlier run"),
        "{said}"
    );
    assert_eq!(workspace.files("a").len(), 1);
    assert_eq!(workspace.read("a/inputs/spot.png"), b"mine");
    // A file is not taken for the folder of copies either.
    workspace.write("b/inputs", "mine");
    workspace.fail("run masked.toml --quiet -o b --force", 2);
    assert_eq!(workspace.read("b/inputs"), b"mine");
}

#[test]
fn a_damaged_manifest_deletes_nothing_elsewhere() {
    let workspace = Workspace::small();
    workspace.write("treasure", "mine");
    workspace.write("a/inputs/deep/treasure", "mine");
    let hash = blake3::hash(b"mine").to_hex();
    let entry = |name: &str| format!(r#"{{"name":"{name}","bytes":4,"blake3":"{hash}"}}"#);
    let entries = [
        "../treasure",
        "inputs/../../treasure",
        "inputs/deep/treasure",
        "notes.txt",
    ]
    .map(entry);
    workspace.write(
        "a/manifest.json",
        format!(
            r#"{{"version":"","host":"","platform":"","started":"","finished":"","wall_time_s":0.0,"threads":1,
            "files":[{}]}}"#,
            entries.join(",")
        ),
    );
    workspace.write("a/notes.txt", "mine");
    let said = workspace.fail("run small.toml --quiet -o a --force", 2);
    assert!(
        said.contains("a/manifest.json is damaged: it has no seal"),
        "{said}"
    );
    assert!(said.contains("move it away"), "{said}");
    // A journal has no seal.
    workspace.remove("a/manifest.json");
    let lines: String = entries.iter().map(|entry| format!("{entry}\n")).collect();
    workspace.write("a/.slipfront/journal.jsonl", lines);
    workspace.succeed("run small.toml -o a --force");
    for name in ["treasure", "a/inputs/deep/treasure", "a/notes.txt"] {
        assert_eq!(workspace.read(name), b"mine", "{name}");
    }
}

#[test]
fn the_case_itself_is_never_replaced() {
    let workspace = Workspace::small();
    workspace.write("mine/case.toml", SMALL);
    for line in [
        "run mine/case.toml --quiet -o mine --force",
        "run mine/case.toml --quiet -o mine/../mine",
    ] {
        let said = workspace.fail(line, 2);
        assert!(
            said.contains("would replace mine/") && said.contains("case.toml, an input of the run"),
            "{said}"
        );
    }
    assert_eq!(workspace.read("mine/case.toml"), SMALL.as_bytes());
    assert_eq!(workspace.files("mine").len(), 1);
    // The folder may contain the case under another name: it is then a foreign file, which stays.
    workspace.write("beside/small.toml", SMALL);
    workspace.succeed("run beside/small.toml -o beside --force");
    assert_eq!(workspace.read("beside/small.toml"), SMALL.as_bytes());
}

#[test]
fn a_folder_that_cannot_be_written_is_said_before_the_run() {
    let workspace = Workspace::small();
    workspace.write("file", "mine");
    for out in ["file", "file/below"] {
        let said = workspace.fail(&format!("run small.toml --quiet -o {out} --force"), 2);
        assert!(said.contains("cannot write to the folder"), "{said}");
    }
    assert_eq!(workspace.read("file"), b"mine");
}

/// A read-only folder is reported before the run. For root, who may write anywhere, nothing is tested.
#[cfg(unix)]
#[test]
fn a_read_only_folder_is_said_before_the_run() {
    use std::os::unix::fs::PermissionsExt;
    let workspace = Workspace::small();
    let locked = workspace.path("locked");
    std::fs::create_dir(&locked).unwrap();
    std::fs::set_permissions(&locked, PermissionsExt::from_mode(0o555)).unwrap();
    if std::fs::write(locked.join("probe"), "").is_ok() {
        return;
    }
    for out in ["locked", "locked/below"] {
        let said = workspace.fail(&format!("run small.toml --quiet -o {out}"), 2);
        assert!(said.contains("cannot write to the folder"), "{said}");
    }
}

#[test]
fn odd_names_are_names() {
    let workspace = Workspace::small();
    let odd = "fünf µm [2] & #1.toml";
    workspace.write(odd, SMALL);
    ended_with(workspace.process("run --quiet").arg(odd), 0);
    assert!(workspace.exists("results/fünf µm [2] & #1/manifest.json"));
    let mut plot = workspace.process("plot small/../results/../results");
    ended_with(plot.arg(workspace.path("results/fünf µm [2] & #1")), 2);
    let run = "results/fünf µm [2] & #1";
    ended_with(workspace.process("plot -o over").args([run, run]), 0);
}

/// A kill leaves a case, copies of its inputs, and files that were being written, but no manifest that lists
/// them.
#[test]
fn force_takes_the_copies_of_a_killed_run_along() {
    let workspace = Workspace::masked();
    workspace.succeed("run masked.toml -o clean");
    workspace.succeed("run masked.toml -o a");
    workspace.interrupt("a");
    workspace.write("a/.slipfront/tmp/123456", "half of");
    workspace.succeed("run masked.toml -o a --force");
    workspace.assert_same_run("clean", "a");
    // A case of the user may refer to the only copy of a file.
    workspace.write("b/case.toml", MASKED.replace("spot.png", "inputs/spot.png"));
    workspace.write("b/inputs/spot.png", workspace.read("spot.png"));
    let said = workspace.fail("run masked.toml --quiet -o b --force", 2);
    assert!(
        said.contains("b/case.toml is not a file of an earlier run"),
        "{said}"
    );
    assert_eq!(workspace.files("b").len(), 2);
}

/// Files that an interrupted run has not written stay, whatever their names: a file belongs to the run only
/// if the run has finished it and it is unchanged.
#[test]
fn what_an_interrupted_run_has_not_written_stays() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o whole");
    for (name, listed) in [
        ("summary.json", false),
        ("series.csv", false),
        ("friction.png", false),
        ("stress.svg", true),
        ("fields.nc", true),
    ] {
        workspace.fill("a", &workspace.files("whole"));
        if !listed {
            let text = workspace.read_text("a/manifest.json");
            workspace.write("a/manifest.json", text.replace(name, "another.txt"));
        }
        workspace.interrupt("a");
        workspace.write(&format!("a/{name}"), "mine");
        let before = workspace.files("a");
        let why = if listed {
            "was changed after the run wrote it: move it away"
        } else {
            "is not a file of an earlier run: move it away"
        };
        for line in ["run --quiet --resume a", "run small.toml --quiet -o a --force"] {
            let said = workspace.fail(line, 2);
            assert!(said.contains(&format!("a/{name} {why}")), "{line}: {said}");
            assert!(workspace.files("a") == before, "{line} has changed the folder");
        }
        // A file with a name that the run does not use has no effect.
        std::fs::rename(workspace.path("a").join(name), workspace.path("a/mine.txt")).unwrap();
        workspace.succeed("run --resume a");
        assert_eq!(workspace.read("a/mine.txt"), b"mine");
        workspace.remove("a/mine.txt");
        workspace.assert_same_run("whole", "a");
    }
}

/// A kill while the journal is written leaves part of a line, for a file that does not exist yet.
#[test]
fn a_torn_line_of_the_journal_does_no_harm() {
    let workspace = Workspace::masked();
    workspace.succeed("run masked.toml -o whole");
    workspace.fill("a", &workspace.files("whole"));
    workspace.interrupt("a");
    let journal = workspace.read_text("a/.slipfront/journal.jsonl");
    for line in ["run --resume a", "run masked.toml -o a --force"] {
        let last = journal.trim_end().rfind('\n').unwrap();
        workspace.fill("a", &workspace.files("whole"));
        workspace.remove("a/manifest.json");
        workspace.remove("a/front.png");
        workspace.write("a/.slipfront/journal.jsonl", &journal[..last + 20]);
        workspace.succeed(line);
        workspace.assert_same_run("whole", "a");
        workspace.succeed("verify a");
    }
}

/// `--force` replaces slipfront's own files, but an edited file is a user's work.
#[test]
fn what_was_edited_in_a_complete_folder_is_not_replaced_without_a_word() {
    let workspace = Workspace::masked();
    workspace.succeed("run masked.toml -o a");
    let whole = workspace.files("a");
    for name in ["friction.svg", "summary.json", "case.toml", "inputs/spot.png"] {
        workspace.write(&format!("a/{name}"), "mine");
        let before = workspace.files("a");
        let said = workspace.fail("run masked.toml --quiet -o a --force", 2);
        let why = format!("a/{name} was changed after the run wrote it");
        assert!(said.contains(&why), "{said}");
        assert!(workspace.files("a") == before);
        workspace.fill("a", &whole);
    }
    workspace.write("a/friction.svg", "mine");
    let said = workspace.fail("plot a", 2);
    assert!(
        said.contains("a/friction.svg was changed after the run drew it") && said.contains("--force"),
        "{said}"
    );
    assert_eq!(workspace.read("a/friction.svg"), b"mine");
    workspace.succeed("plot a --force");
    workspace.succeed("verify a");
    workspace.succeed("plot a");
    workspace.succeed("run masked.toml -o a --force");
    assert!(
        workspace.run_files("a")
            == whole
                .into_iter()
                .filter(|(name, _)| name != "manifest.json")
                .collect()
    );
}

/// Copies behind a link may be a user's originals.
#[cfg(unix)]
#[test]
fn copies_behind_a_link_are_originals() {
    let workspace = Workspace::masked();
    workspace.succeed("run masked.toml -o a");
    workspace.write("masks/spot.png", workspace.read("spot.png"));
    std::fs::remove_dir_all(workspace.path("a/inputs")).unwrap();
    std::os::unix::fs::symlink("../masks", workspace.path("a/inputs")).unwrap();
    let said = workspace.fail("run masked.toml --quiet -o a --force", 2);
    assert!(
        said.contains("a/inputs is not a file of an earlier run"),
        "{said}"
    );
    workspace.succeed("run small.toml -o a --force");
    assert_eq!(workspace.read("masks/spot.png"), workspace.read("spot.png"));
}

/// Files with a name similar to one of slipfront's stay.
#[test]
fn what_only_looks_like_ours_stays() {
    let workspace = Workspace::small();
    let names = [
        ".slipfront/checkpoint.bin",
        ".slipfront/checkpoint-previous.bin",
        ".slipfrontrc",
        ".slipfront-notes",
        ".slipfront-0123456789abcdef-notes",
    ];
    for name in names {
        workspace.write(&format!("a/{name}"), "mine");
    }
    workspace.fail("run small.toml --quiet -o a", 2);
    std::fs::create_dir(workspace.path("a/.slipfront-0123456789abcdef-123abc")).unwrap();
    let said = workspace.fail("run small.toml --quiet -o a --force", 2);
    assert!(
        said.contains("checkpoint.bin is not a file of an earlier run"),
        "{said}"
    );
    for name in names {
        assert_eq!(workspace.read(&format!("a/{name}")), b"mine", "{name}");
    }
    // Leftovers of a kill count as an empty folder.
    workspace.write("b/.slipfront/journal.jsonl", "");
    workspace.write("b/.slipfront/tmp/123abc", "half a file");
    workspace.succeed("run small.toml -o b");
    assert!(!workspace.exists("b/.slipfront"));
    // Files of others stay.
    workspace.write("c/.slipfront/journal.jsonl", "");
    workspace.write("c/.slipfront/notes.txt", "mine");
    workspace.succeed("run small.toml -o c");
    assert_eq!(workspace.read("c/.slipfront/notes.txt"), b"mine");
    // Without a journal the folder may belong to anybody.
    workspace.write("d/.slipfront/notes.txt", "mine");
    let said = workspace.fail("run small.toml --quiet -o d", 2);
    assert!(said.contains("d is not empty"), "{said}");
    let said = workspace.fail("run small.toml --quiet -o d --force", 2);
    assert!(
        said.contains("d/.slipfront is not a file of an earlier run"),
        "{said}"
    );
    assert_eq!(workspace.read("d/.slipfront/notes.txt"), b"mine");
}

/// Names alone do not make a run: these files belong to a user.
#[test]
fn a_folder_that_never_held_a_run_loses_nothing() {
    let workspace = Workspace::small();
    let own = |workspace: &Workspace| {
        for name in ["case.toml", "series.csv", "stress.png"] {
            workspace.write(&format!("mine/{name}"), "# mine");
        }
    };
    own(&workspace);
    for name in ["case.toml", "series.csv", "stress.png"] {
        let said = workspace.fail(
            "run small.toml --quiet -o mine --force --set output.snapshots=[]",
            2,
        );
        assert!(said.contains("is not a file of an earlier run"), "{said}");
        assert_eq!(workspace.read(&format!("mine/{name}")), b"# mine");
        std::fs::remove_file(workspace.path("mine").join(name)).unwrap();
    }
    workspace.write("mine/notes.txt", "mine");
    workspace.succeed("run small.toml -o mine --force");
    // In the folder of a run, files that the run has not written do not belong to it either.
    std::fs::remove_dir_all(workspace.path("mine")).unwrap();
    workspace.succeed("run small.toml -o mine --set output.snapshots=[]");
    workspace.write("mine/stress.png", "mine");
    let said = workspace.fail("run small.toml --quiet -o mine --force", 2);
    assert!(
        said.contains("stress.png is not a file of an earlier run"),
        "{said}"
    );
    assert_eq!(workspace.read("mine/stress.png"), b"mine");
}

/// The copy in the folder may be the only one.
#[test]
fn a_file_that_the_run_reads_is_not_replaced() {
    let workspace = Workspace::masked();
    workspace.succeed("run masked.toml -o a");
    workspace.write("a/new.toml", workspace.read("a/case.toml"));
    let said = workspace.fail("run a/new.toml --quiet -o a --force --seed 2", 2);
    assert!(said.contains("would replace a/inputs/spot.png"), "{said}");
    workspace.succeed("run a/new.toml -o b --seed 2");
    workspace.succeed("verify a");
}

#[test]
fn pictures_of_others_are_not_replaced() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a");
    workspace.succeed("run small.toml -o b --seed 2");
    let before = workspace.files("b");
    for line in ["plot a -o b", "plot a b -o b", "plot a -o b --force"] {
        let said = workspace.fail(line, 2);
        assert!(said.contains("b contains another run"), "{said}");
    }
    assert_eq!(workspace.files("b"), before);
    workspace.write("mine/friction.png", "mine");
    let said = workspace.fail("plot a -o mine", 2);
    assert!(
        said.contains("mine/friction.png exists") && said.contains("--force"),
        "{said}"
    );
    assert_eq!(workspace.files("mine").len(), 1);
    workspace.succeed("plot a -o mine --force");
    workspace.succeed("plot a");
    workspace.succeed("plot a -o ./a");
    workspace.succeed("verify a");
    let said = workspace.fail("plot mine", 2);
    assert!(said.contains("mine contains no summary.json"), "{said}");
}
