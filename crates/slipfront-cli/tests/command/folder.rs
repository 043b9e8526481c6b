//! The run folder: whose files are replaced, and whose never.

use super::Bench;

#[test]
fn a_folder_that_holds_something_is_refused() {
    let bench = Bench::new();
    bench.write("full/notes.txt", "mine");
    let said = bench.refused("run small.toml --quiet -o full", 2);
    assert!(
        said.contains("full is not empty") && said.contains("--force"),
        "{said}"
    );
    assert_eq!(bench.files("full").len(), 1);
    // An empty one is taken, and so is one that has to be made.
    std::fs::create_dir(bench.path().join("empty")).unwrap();
    bench.done("run small.toml -o empty");
    bench.done("run small.toml -o not/yet/there");
    assert!(
        bench
            .refused("run small.toml --quiet -o empty", 2)
            .contains("not empty")
    );
}

#[test]
fn force_replaces_own_files_only() {
    let bench = Bench::new();
    bench.done("run small.toml -o clean --set output.snapshots=[]");
    bench.done("run small.toml -o a");
    bench.write("a/notes.txt", "mine");
    bench.write("a/inputs/old.png", "mine too");
    bench.done("run small.toml -o a --force --set output.snapshots=[]");
    assert_eq!(bench.read("a/notes.txt"), b"mine");
    assert_eq!(bench.read("a/inputs/old.png"), b"mine too");
    std::fs::remove_file(bench.path().join("a/notes.txt")).unwrap();
    std::fs::remove_dir_all(bench.path().join("a/inputs")).unwrap();
    // Nothing of the first run is left, such as its maps.
    bench.assert_same("clean", "a");
}

#[test]
fn force_takes_copies_of_an_earlier_run_along() {
    let bench = Bench::masked();
    bench.done("run masked.toml -o a");
    bench.done("run masked.toml -o a --force");
    assert!(bench.exists("a/inputs/spot.png"));
    bench.done("run small.toml -o a --force");
    assert!(
        !bench.exists("a/inputs"),
        "an input that is no longer used has stayed"
    );
}

#[test]
fn a_foreign_file_in_the_place_of_a_copy_is_refused_before_the_run() {
    let bench = Bench::masked();
    bench.write("a/inputs/spot.png", "mine");
    let said = bench.refused("run masked.toml --quiet -o a --force", 2);
    assert!(
        said.contains("spot.png is not a file of an earlier run"),
        "{said}"
    );
    assert_eq!(bench.files("a").len(), 1);
    assert_eq!(bench.read("a/inputs/spot.png"), b"mine");
    // Nor is a file taken for the folder of copies.
    bench.write("b/inputs", "mine");
    bench.refused("run masked.toml --quiet -o b --force", 2);
    assert_eq!(bench.read("b/inputs"), b"mine");
}

#[test]
fn a_damaged_manifest_deletes_nothing_elsewhere() {
    let bench = Bench::new();
    bench.write("treasure", "mine");
    bench.write("a/inputs/deep/treasure", "mine");
    let entry = |name: &str| format!(r#"{{"name":"{name}","bytes":1,"blake3":""}}"#);
    let entries = [
        "../treasure",
        "inputs/../../treasure",
        "inputs/deep/treasure",
        "notes.txt",
    ]
    .map(entry);
    bench.write(
        "a/manifest.json",
        format!(
            r#"{{"version":"","host":"","platform":"","started":"","finished":"","wall_time_s":0.0,"threads":1,
            "files":[{}]}}"#,
            entries.join(",")
        ),
    );
    bench.write("a/notes.txt", "mine");
    bench.done("run small.toml -o a --force");
    for name in ["treasure", "a/inputs/deep/treasure", "a/notes.txt"] {
        assert_eq!(bench.read(name), b"mine", "{name}");
    }
}

#[test]
fn the_case_itself_is_never_replaced() {
    let bench = Bench::new();
    bench.write("mine/case.toml", super::SMALL);
    for line in [
        "run mine/case.toml --quiet -o mine --force",
        "run mine/case.toml --quiet -o mine/../mine",
    ] {
        let said = bench.refused(line, 2);
        assert!(
            said.contains("would replace mine/") && said.contains("case.toml, which the run reads"),
            "{said}"
        );
    }
    assert_eq!(bench.read("mine/case.toml"), super::SMALL.as_bytes());
    assert_eq!(bench.files("mine").len(), 1);
    // Beside it there is room: under a name of its own it is a foreign file.
    bench.write("beside/small.toml", super::SMALL);
    bench.done("run beside/small.toml -o beside --force");
    assert_eq!(bench.read("beside/small.toml"), super::SMALL.as_bytes());
}

#[test]
fn a_folder_that_cannot_be_written_is_said_before_the_run() {
    let bench = Bench::new();
    bench.write("file", "mine");
    for out in ["file", "file/below"] {
        let said = bench.refused(&format!("run small.toml --quiet -o {out} --force"), 2);
        assert!(said.contains("cannot write to the folder"), "{said}");
    }
    assert_eq!(bench.read("file"), b"mine");
}

/// Root may write anywhere: nothing is tested then.
#[cfg(unix)]
#[test]
fn a_read_only_folder_is_said_before_the_run() {
    use std::os::unix::fs::PermissionsExt;
    let bench = Bench::new();
    let locked = bench.path().join("locked");
    std::fs::create_dir(&locked).unwrap();
    std::fs::set_permissions(&locked, PermissionsExt::from_mode(0o555)).unwrap();
    if std::fs::write(locked.join("probe"), "").is_ok() {
        return;
    }
    for out in ["locked", "locked/below"] {
        let said = bench.refused(&format!("run small.toml --quiet -o {out}"), 2);
        assert!(said.contains("cannot write to the folder"), "{said}");
    }
}

#[test]
fn odd_names_are_names() {
    let bench = Bench::new();
    let odd = "fünf µm [2] & #1.toml";
    bench.write(odd, super::SMALL);
    let mut command = bench.slipfront("run --quiet");
    command.arg(odd).assert().success();
    assert!(bench.exists("results/fünf µm [2] & #1/manifest.json"));
    let mut command = bench.slipfront("plot small/../results/../results");
    command
        .arg(bench.path().join("results/fünf µm [2] & #1"))
        .assert()
        .code(2);
    let mut command = bench.slipfront("plot -o over");
    let run = "results/fünf µm [2] & #1";
    command.args([run, run]).assert().success();
}

/// A kill leaves a case, copies of what it reads, and files that were being written, but no manifest that lists them.
#[test]
fn force_takes_the_copies_of_a_killed_run_along() {
    let bench = Bench::masked();
    bench.done("run masked.toml -o clean");
    bench.done("run masked.toml -o a");
    std::fs::remove_file(bench.path().join("a/manifest.json")).unwrap();
    for name in ["a/.slipfront/journal.jsonl", "a/.slipfront/tmp/123456"] {
        bench.write(name, if name.ends_with("jsonl") { "" } else { "half of" });
    }
    bench.done("run masked.toml -o a --force");
    bench.assert_same("clean", "a");
    // A case that a user wrote may name the only copy that there is.
    bench.write(
        "b/case.toml",
        super::MASKED.replace("spot.png", "inputs/spot.png"),
    );
    bench.write("b/inputs/spot.png", bench.read("spot.png"));
    let said = bench.refused("run masked.toml --quiet -o b --force", 2);
    assert!(
        said.contains("b/case.toml is not a file of an earlier run"),
        "{said}"
    );
    assert_eq!(bench.files("b").len(), 2);
}

/// What a link leads to is somebody else's.
#[cfg(unix)]
#[test]
fn copies_behind_a_link_are_originals() {
    let bench = Bench::masked();
    bench.done("run masked.toml -o a");
    bench.write("masks/spot.png", bench.read("spot.png"));
    std::fs::remove_dir_all(bench.path().join("a/inputs")).unwrap();
    std::os::unix::fs::symlink("../masks", bench.path().join("a/inputs")).unwrap();
    let said = bench.refused("run masked.toml --quiet -o a --force", 2);
    assert!(
        said.contains("a/inputs is not a file of an earlier run"),
        "{said}"
    );
    bench.done("run small.toml -o a --force");
    assert_eq!(bench.read("masks/spot.png"), bench.read("spot.png"));
}

/// Files that only happen to have a name like ours.
#[test]
fn what_only_looks_like_ours_stays() {
    let bench = Bench::new();
    let names = [
        ".slipfront/checkpoint.bin",
        ".slipfront/checkpoint-previous.bin",
        ".slipfrontrc",
        ".slipfront-notes",
    ];
    for name in names {
        bench.write(&format!("a/{name}"), "mine");
    }
    bench.refused("run small.toml --quiet -o a", 2);
    std::fs::create_dir(bench.path().join("a/.slipfront123abc")).unwrap();
    let said = bench.refused("run small.toml --quiet -o a --force", 2);
    assert!(
        said.contains("checkpoint.bin is not a file of an earlier run"),
        "{said}"
    );
    for name in names {
        assert_eq!(bench.read(&format!("a/{name}")), b"mine", "{name}");
    }
    // What a kill has left is no more than nothing.
    bench.write("b/.slipfront/journal.jsonl", "{\"slipfront_ru");
    bench.write("b/.slipfront/tmp/123abc", "half a file");
    bench.done("run small.toml -o b");
    assert!(!bench.exists("b/.slipfront"));
    // What others put there stays.
    bench.write("c/.slipfront/journal.jsonl", "");
    bench.write("c/.slipfront/notes.txt", "mine");
    bench.done("run small.toml -o c");
    assert_eq!(bench.read("c/.slipfront/notes.txt"), b"mine");
    // Without a journal it may be anybody's.
    bench.write("d/.slipfront/notes.txt", "mine");
    let said = bench.refused("run small.toml --quiet -o d", 2);
    assert!(said.contains("d is not empty"), "{said}");
    let said = bench.refused("run small.toml --quiet -o d --force", 2);
    assert!(
        said.contains("d/.slipfront is not a file of an earlier run"),
        "{said}"
    );
    assert_eq!(bench.read("d/.slipfront/notes.txt"), b"mine");
}

/// Names alone make no run: these files are somebody's.
#[test]
fn a_folder_that_never_held_a_run_loses_nothing() {
    let bench = Bench::new();
    let own = |bench: &Bench| {
        for name in ["case.toml", "series.csv", "stress.png"] {
            bench.write(&format!("mine/{name}"), "# mine");
        }
    };
    own(&bench);
    for name in ["case.toml", "series.csv", "stress.png"] {
        let said = bench.refused(
            "run small.toml --quiet -o mine --force --set output.snapshots=[]",
            2,
        );
        assert!(said.contains("is not a file of an earlier run"), "{said}");
        assert_eq!(bench.read(&format!("mine/{name}")), b"# mine");
        std::fs::remove_file(bench.path().join("mine").join(name)).unwrap();
    }
    bench.write("mine/notes.txt", "mine");
    bench.done("run small.toml -o mine --force");
    // Where there was a run, what it has not written is not its own either.
    std::fs::remove_dir_all(bench.path().join("mine")).unwrap();
    bench.done("run small.toml -o mine --set output.snapshots=[]");
    bench.write("mine/stress.png", "mine");
    let said = bench.refused("run small.toml --quiet -o mine --force", 2);
    assert!(
        said.contains("stress.png is not a file of an earlier run"),
        "{said}"
    );
    assert_eq!(bench.read("mine/stress.png"), b"mine");
}

/// The copy in the folder may be the only one that there is.
#[test]
fn a_file_that_the_run_reads_is_not_replaced() {
    let bench = Bench::masked();
    bench.done("run masked.toml -o a");
    bench.write("a/new.toml", bench.read("a/case.toml"));
    let said = bench.refused("run a/new.toml --quiet -o a --force --seed 2", 2);
    assert!(said.contains("would replace a/inputs/spot.png"), "{said}");
    bench.done("run a/new.toml -o b --seed 2");
    bench.done("verify a");
}

#[test]
fn pictures_of_others_are_not_replaced() {
    let bench = Bench::new();
    bench.done("run small.toml -o a");
    bench.done("run small.toml -o b --seed 2");
    let before = bench.files("b");
    for line in ["plot a -o b", "plot a b -o b", "plot a -o b --force"] {
        let said = bench.refused(line, 2);
        assert!(
            said.contains("b holds a run, and these are not its pictures"),
            "{said}"
        );
    }
    assert_eq!(bench.files("b"), before);
    bench.write("mine/friction.png", "mine");
    let said = bench.refused("plot a -o mine", 2);
    assert!(
        said.contains("mine/friction.png exists") && said.contains("--force"),
        "{said}"
    );
    assert_eq!(bench.files("mine").len(), 1);
    bench.done("plot a -o mine --force");
    bench.done("plot a");
    bench.done("plot a -o ./a");
    bench.done("verify a");
    let said = bench.refused("plot mine", 2);
    assert!(said.contains("mine holds no summary.json"), "{said}");
}
