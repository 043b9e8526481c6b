//! The command `slipfront verify` detects every change in a run folder, and a repeated run gives the same
//! files.

use std::collections::BTreeMap;
use std::process::Stdio;

use crate::fixtures::{RUN_FILES, unwrapped};
use crate::support::process::{Running, output, send, wait_for};
use crate::support::workspace::Workspace;

/// Runs `verify`; returns the status, stdout and stderr.
pub(crate) fn verified(workspace: &Workspace, line: &str) -> (i32, String, String) {
    let output = workspace.output(&format!("verify {line}"));
    let [out, err] = [output.stdout, output.stderr].map(|said| String::from_utf8(said).unwrap());
    assert!(!err.contains("panicked"), "{err}");
    (output.status.code().unwrap(), unwrapped(&out), err)
}

/// A workspace with a run that has an input, so that every kind of file exists.
fn workspace_with_a_run() -> Workspace {
    let workspace = Workspace::masked();
    workspace.succeed("run masked.toml -o a");
    workspace
}

fn remove(workspace: &Workspace, name: &str) {
    std::fs::remove_file(workspace.path(name)).unwrap();
}

/// Changes the manifest, and updates its checksum.
fn reseal(workspace: &Workspace, change: impl Fn(&mut serde_json::Value)) {
    let mut manifest: serde_json::Value = serde_json::from_slice(&workspace.read("a/manifest.json")).unwrap();
    change(&mut manifest);
    let mut text = serde_json::to_string_pretty(&manifest).unwrap();
    let seal = text.rfind("\"seal\"").unwrap();
    let hash = blake3::hash(&text.as_bytes()[..seal]).to_hex();
    text.replace_range(seal.., &format!("\"seal\": \"{hash}\"\n}}\n"));
    workspace.write("a/manifest.json", text);
}

#[test]
fn a_run_is_what_was_written() {
    let workspace = workspace_with_a_run();
    workspace.succeed("run small.toml -o b");
    let before = workspace.files(".");
    let (status, said, errors) = verified(&workspace, "a b");
    assert_eq!((status, errors.as_str()), (0, ""));
    assert_eq!(said.lines().count(), 2, "{said}");
    assert!(
        said.contains("a: 12 files unchanged since slipfront 0.1.0"),
        "{said}"
    );
    let (status, said, _) = verified(&workspace, "a --quiet");
    assert_eq!((status, said.as_str()), (0, ""));
    assert!(before == workspace.files("."), "verifying has changed something");
}

/// The JSON output names the folders that have changed, with the reasons for each.
#[test]
fn json_has_what_was_found_of_each_folder() {
    let workspace = workspace_with_a_run();
    workspace.succeed("run small.toml -o b");
    workspace.write("b/series.csv", "other bytes");
    workspace.succeed("plot a -o drawn");
    let (status, said, errors) = verified(&workspace, "a b drawn nowhere --json");
    assert_eq!(status, 2, "{errors}");
    let found: serde_json::Value = serde_json::from_str(&said).unwrap();
    let of = |key: &str| -> Vec<String> {
        let folders = found["folders"].as_array().unwrap();
        folders.iter().map(|folder| folder[key].to_string()).collect()
    };
    assert_eq!(of("folder"), [r#""a""#, r#""b""#, r#""drawn""#, r#""nowhere""#]);
    assert_eq!(
        of("status"),
        [
            r#""unchanged""#,
            r#""different""#,
            r#""pictures""#,
            r#""unusable""#
        ]
    );
    assert!(of("differences")[1].contains("b/series.csv differs"), "{said}");
    assert!(of("error")[3].contains("nowhere is not a folder"), "{said}");
}

#[test]
fn every_changed_byte_is_seen() {
    let workspace = workspace_with_a_run();
    let files = workspace.files("a");
    assert_eq!(files.len(), RUN_FILES.len() + 1);
    for (name, bytes) in &files {
        for at in [0, bytes.len() / 3, bytes.len() / 2, bytes.len() - 1] {
            let mut changed = bytes.clone();
            changed[at] ^= 1;
            workspace.write(&format!("a/{name}"), changed);
            let (status, said, errors) = verified(&workspace, "a");
            assert_eq!(status, 1, "byte {at} of {name}: {said}");
            assert!(
                errors.contains("1 of 1 folder differs from what was written"),
                "{errors}"
            );
            // A changed case may also be invalid, which is a second finding; for an untrustworthy manifest
            // there is no other finding.
            let lines: Vec<&str> = said.lines().collect();
            let expected = if name == "case.toml" { 1..=2 } else { 1..=1 };
            assert!(expected.contains(&lines.len()), "{said}");
            assert!(
                lines.iter().all(|line| line.starts_with(&format!("a/{name} "))),
                "{name}: {said}"
            );
        }
        workspace.write(&format!("a/{name}"), bytes);
    }
    assert_eq!(verified(&workspace, "a").0, 0);
}

/// Changed files are not drawn, because pictures of damaged files would look right.
#[test]
fn what_has_changed_is_not_drawn() {
    let workspace = workspace_with_a_run();
    for name in ["summary.json", "series.csv", "kymograph.nc", "fields.nc"] {
        let path = format!("a/{name}");
        let bytes = workspace.read(&path);
        let mut changed = bytes.clone();
        changed[bytes.len() / 2] ^= 1;
        workspace.write(&path, &changed);
        for line in ["plot a -o drawn", "plot a a -o drawn"] {
            let said = workspace.fail(line, 2);
            assert!(
                said.contains(&format!("{path} differs: other bytes were written")),
                "{said}"
            );
            assert!(said.contains("remove a/manifest.json"), "{said}");
        }
        workspace.write(&path, bytes);
    }
    assert!(!workspace.exists("drawn"));
    // Files that pictures are not drawn from do not matter.
    workspace.write("a/friction.svg", "changed");
    workspace.succeed("plot a --force");
    let seen = verified(&workspace, "a");
    assert_eq!(seen.0, 0, "{}", seen.1);
}

#[test]
fn every_byte_of_the_manifest_is_under_its_seal() {
    let workspace = workspace_with_a_run();
    let bytes = workspace.read("a/manifest.json");
    for at in (0..bytes.len()).step_by(29) {
        let mut changed = bytes.clone();
        changed[at] ^= 1;
        workspace.write("a/manifest.json", changed);
        let (status, said, _) = verified(&workspace, "a");
        assert_eq!(status, 1, "byte {at}");
        assert!(said.starts_with("a/manifest.json is damaged: "), "{said}");
    }
}

/// A manifest that cannot be read is not called damaged: permissions or the disk may be the cause.
#[cfg(unix)]
#[test]
fn a_manifest_that_cannot_be_read_is_not_called_damaged() {
    let workspace = workspace_with_a_run();
    remove(&workspace, "a/manifest.json");
    // Permissions do not restrict root, but a link to itself cannot be read.
    std::os::unix::fs::symlink("manifest.json", workspace.path("a/manifest.json")).unwrap();
    let (status, said, _) = verified(&workspace, "a");
    assert_eq!(status, 1);
    assert!(said.starts_with("cannot read a/manifest.json: "), "{said}");
    for line in [
        "run --quiet --resume a",
        "run small.toml --quiet -o a --force",
        "plot a",
    ] {
        let said = workspace.fail(line, 2);
        assert!(said.contains("cannot read a/manifest.json: "), "{line}: {said}");
    }
}

#[test]
fn missing_and_cut_files_are_named() {
    let workspace = workspace_with_a_run();
    let files = workspace.files("a");
    for (name, bytes) in &files {
        let path = format!("a/{name}");
        if name != "manifest.json" {
            remove(&workspace, &path);
            let (status, said, _) = verified(&workspace, "a");
            assert_eq!((status, said), (1, format!("{path} is missing\n")));
            workspace.write(&path, &bytes[..bytes.len() - 1]);
            let (status, said, _) = verified(&workspace, "a");
            let lengths = format!("{} bytes where {} were written", bytes.len() - 1, bytes.len());
            assert!(status == 1 && said.contains(&lengths), "{said}");
        }
        workspace.write(&path, bytes);
    }
    std::fs::remove_file(workspace.path("a/series.csv")).unwrap();
    std::fs::create_dir(workspace.path("a/series.csv")).unwrap();
    let (status, said, _) = verified(&workspace, "a");
    assert!(status == 1 && said.contains("not a regular file"), "{said}");
}

/// Files of others are listed, but cause no failure, because a user may keep notes next to results.
#[test]
fn files_of_others_are_named() {
    let workspace = workspace_with_a_run();
    for name in [
        "notes.txt",
        "inputs/other.png",
        ".slipfront-0123456789abcdef-AbC123",
        "more/notes.txt",
    ] {
        workspace.write(&format!("a/{name}"), "mine");
    }
    workspace.write("a/.slipfront/journal.jsonl", "");
    let (status, said, errors) = verified(&workspace, "a");
    assert_eq!((status, errors.as_str()), (0, ""));
    let notes: Vec<&str> = said.lines().skip(1).collect();
    assert_eq!(
        notes,
        [
            "note: a/.slipfront was left by a run that was interrupted",
            "note: a/.slipfront-0123456789abcdef-AbC123 was left by a run that was interrupted",
            "note: a/inputs/other.png is not slipfront's",
            "note: a/more is not slipfront's",
            "note: a/notes.txt is not slipfront's",
        ]
    );
}

#[test]
fn what_is_no_run_folder_is_said_with_status_2() {
    let workspace = workspace_with_a_run();
    std::fs::create_dir(workspace.path("empty")).unwrap();
    for (folder, words) in [
        (
            "empty",
            "empty has no manifest.json: it is not a run folder, or its run did not finish",
        ),
        ("small.toml", "small.toml is not a folder"),
        ("nowhere", "nowhere is not a folder"),
    ] {
        let (status, said, errors) = verified(&workspace, folder);
        assert_eq!((status, said.as_str()), (2, ""), "{folder}");
        assert!(errors.contains(words), "{errors}");
    }
    // The other folders are still verified.
    let (status, said, errors) = verified(&workspace, "empty a nowhere");
    assert_eq!(status, 2);
    assert!(said.starts_with("a: 12 files"), "{said}");
    assert!(
        errors.contains("2 of 3 folders cannot be verified, 0 differ"),
        "{errors}"
    );
    workspace.fail("verify", 2);
}

/// Folders of pictures from `slipfront plot` cause no failure next to run folders. On their own they contain
/// nothing to verify, and a folder without a case cannot be resumed.
#[test]
fn folders_of_pictures_are_passed_over() {
    let workspace = workspace_with_a_run();
    workspace.succeed("plot a a --units si");
    let (status, said, errors) = verified(&workspace, "a results/overlay");
    assert_eq!((status, errors.as_str()), (0, ""), "{said}");
    assert!(
        said.starts_with("a: 12 files")
            && said.contains("note: results/overlay holds only pictures, without recorded results"),
        "{said}"
    );
    assert_eq!(
        verified(&workspace, "a results/overlay --quiet"),
        (0, String::new(), String::new())
    );
    let (status, _, errors) = verified(&workspace, "results/overlay");
    assert_eq!(status, 2);
    assert!(
        errors.contains("there is nothing to verify: give folders of runs or studies"),
        "{errors}"
    );
    workspace.write("results/overlay/notes.txt", "");
    let (status, _, errors) = verified(&workspace, "a results/overlay");
    assert_eq!(status, 2);
    assert!(
        errors.contains("results/overlay has no manifest.json") && !errors.contains("--resume"),
        "{errors}"
    );
    remove(&workspace, "a/manifest.json");
    let (_, _, errors) = verified(&workspace, "a");
    assert!(
        errors.contains("`slipfront run --resume a` resumes it"),
        "{errors}"
    );
}

#[test]
fn a_manifest_of_another_version_is_understood() {
    let workspace = workspace_with_a_run();
    // Another version may write other keys, and fewer.
    reseal(&workspace, |manifest| {
        manifest["version"] = "9.9.9".into();
        manifest["build"] = "slipfront 9.9.9, sources 00".into();
        manifest["weather"] = "fine".into();
        let keys = manifest.as_object_mut().unwrap();
        keys.remove("random");
        keys.remove("kernel");
        // The seal comes last.
        let seal = keys.remove("seal").unwrap();
        keys.insert("seal".to_owned(), seal);
    });
    let (status, said, _) = verified(&workspace, "a");
    assert_eq!(status, 0, "{said}");
    assert!(
        said.contains("a: 12 files unchanged since slipfront 9.9.9"),
        "{said}"
    );
    let (status, said, _) = verified(&workspace, "a --rerun --quiet");
    assert_eq!(status, 0, "{said}");
    let (_, said, _) = verified(&workspace, "a --rerun");
    assert!(
        said.contains("note: a was written by slipfront 9.9.9")
            && said.contains("repeated by slipfront 0.1.0"),
        "{said}"
    );
    // Programs of the same version and commit may be built from different sources.
    reseal(&workspace, |manifest| manifest["version"] = "0.1.0".into());
    let (_, said, _) = verified(&workspace, "a --rerun");
    assert!(
        said.contains(
            "note: a was written by slipfront 9.9.9, sources 00, and repeated by slipfront 0.1.0, "
        ),
        "{said}"
    );
    // The seal may be missing.
    reseal(&workspace, |manifest| {
        manifest["seal"] = "".into();
    });
    let text = String::from_utf8(workspace.read("a/manifest.json")).unwrap();
    let seal = text.rfind(",\n  \"seal\"").unwrap();
    workspace.write("a/manifest.json", format!("{}\n}}\n", &text[..seal]));
    let (status, said, _) = verified(&workspace, "a");
    assert!(status == 1 && said.contains("it has no seal"), "{said}");
}

#[test]
fn a_manifest_speaks_of_its_own_folder_alone() {
    let workspace = workspace_with_a_run();
    workspace.write("treasure", "mine");
    for name in ["../treasure", "/etc/passwd", "inputs/../../treasure"] {
        reseal(&workspace, |manifest| manifest["files"][0]["name"] = name.into());
        let (status, said, _) = verified(&workspace, "a");
        assert_eq!(status, 1);
        assert!(said.contains("lies outside of its folder"), "{said}");
    }
}

/// A sealed case of another version may be invalid in this one.
#[test]
fn a_case_that_is_none_any_more_is_told() {
    let workspace = workspace_with_a_run();
    for (from, to, words) in [
        (
            "[drive]",
            "[drove]",
            "is not a valid case for this version: a/case.toml:",
        ),
        (
            "v_star = 0.1",
            "v_star = 0.10",
            "is not the original resolved case",
        ),
    ] {
        let before = workspace.files("a");
        let case = String::from_utf8(before["case.toml"].clone()).unwrap();
        let case = case.replace(from, to);
        reseal(&workspace, |manifest| {
            let file = &mut manifest["files"][0];
            assert_eq!(file["name"], "case.toml");
            file["bytes"] = case.len().into();
            file["blake3"] = blake3::hash(case.as_bytes()).to_hex().to_string().into();
        });
        workspace.write("a/case.toml", &case);
        let (status, said, _) = verified(&workspace, "a");
        assert_eq!((status, said.lines().count()), (1, 1), "{said}");
        assert!(said.contains(words), "{said}");
        reseal(&workspace, |manifest| {
            manifest["build"] = "slipfront 0.0.9, sources 0".into();
        });
        let (status, said, _) = verified(&workspace, "a");
        assert!(
            status == 0 && said.contains("unchanged since") && said.contains(words),
            "{said}"
        );
        for (name, bytes) in before {
            workspace.write(&format!("a/{name}"), bytes);
        }
    }
}

/// Uses a separate temporary folder, which shows whether any file is left in it.
fn rerun(workspace: &Workspace, folder: &str) -> (i32, String) {
    let temporary = workspace.path("temporary");
    std::fs::create_dir_all(&temporary).unwrap();
    let mut command = workspace.process(&format!("verify --rerun {folder}"));
    let output = output(command.env("TMPDIR", &temporary));
    let left = std::fs::read_dir(&temporary).unwrap().count();
    assert_eq!(left, 0, "something is left behind");
    let said = String::from_utf8(output.stdout).unwrap();
    (output.status.code().unwrap(), said)
}

#[test]
fn a_repeated_run_gives_the_same() {
    let workspace = workspace_with_a_run();
    let before = workspace.files("a");
    let (status, said) = rerun(&workspace, "a");
    assert_eq!(status, 0, "{said}");
    assert!(said.trim_end().ends_with("; the same when repeated"), "{said}");
    assert!(before == workspace.files("a"));
}

#[test]
fn a_repeated_run_of_another_case_gives_another() {
    let workspace = workspace_with_a_run();
    let case = String::from_utf8(workspace.read("a/case.toml")).unwrap();
    workspace.write("a/case.toml", case.replace("\nseed = 1\n", "\nseed = 2\n"));
    let (status, said) = rerun(&workspace, "a");
    assert_eq!(status, 1);
    let named = |words: &str| -> BTreeMap<&str, ()> {
        let lines = said.lines().filter_map(|line| line.strip_suffix(words));
        lines.map(|path| (path, ())).collect()
    };
    assert_eq!(
        named(" differs: other bytes were written")
            .keys()
            .collect::<Vec<_>>(),
        [&"a/case.toml"]
    );
    // The length of a file may also differ.
    for name in ["summary.json", "series.csv", "fields.nc", "friction.svg"] {
        let path = format!("a/{name} differs: ");
        assert!(
            said.lines()
                .any(|line| line.starts_with(&path) && line.contains("written now")),
            "{name}: {said}"
        );
    }
    // The mask is read, and not changed.
    assert!(!said.contains("spot.png"), "{said}");
    // A case that cannot be run is bad input, but differences are still reported.
    workspace.write("a/case.toml", "[drive]\nv_star = -1\n");
    let (status, said) = rerun(&workspace, "a");
    assert_eq!(status, 2);
    assert!(said.starts_with("a/case.toml differs: it has "), "{said}");
}

/// A repeated run may write fewer files.
#[test]
fn a_repeated_run_may_write_less() {
    let workspace = workspace_with_a_run();
    let case = String::from_utf8(workspace.read("a/case.toml")).unwrap();
    workspace.write(
        "a/case.toml",
        case.replace("snapshots = \"auto\"", "snapshots = []"),
    );
    let (status, said) = rerun(&workspace, "a");
    assert_eq!(status, 1);
    for name in ["stress.svg", "stress.png"] {
        assert!(said.contains(&format!("a/{name} is not written now\n")), "{said}");
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_repetition_leaves_nothing_behind() {
    use std::process::Stdio;
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a");
    let case = String::from_utf8(workspace.read("a/case.toml")).unwrap();
    let long = case
        .replace("blocks = [6, 5]", "blocks = [100, 100]")
        .replace("duration_star = \"auto\"", "duration_star = 1e6");
    workspace.write("a/case.toml", long);
    let temporary = workspace.path("temporary");
    std::fs::create_dir(&temporary).unwrap();
    let mut process = workspace.process("verify --rerun --quiet a");
    process.env("TMPDIR", &temporary).stdout(Stdio::null());
    let child = Running::start(process.stderr(Stdio::null()));
    wait_for("folder of the run", || {
        std::fs::read_dir(&temporary).unwrap().next().is_some()
    });
    std::thread::sleep(std::time::Duration::from_millis(100));
    send(&child, "-INT");
    assert_eq!(child.ended().status.code(), Some(130));
    assert_eq!(std::fs::read_dir(&temporary).unwrap().count(), 0);
}

/// A run is repeated twice at the same time: the second repetition neither waits for the first nor removes
/// its folder.
#[cfg(unix)]
#[test]
fn a_run_is_repeated_twice_at_once() {
    let workspace = Workspace::masked();
    // Long enough to be stopped before its end.
    workspace.succeed("run masked.toml -o a --set time.duration_star=20000 --set output.series=1000");
    std::fs::create_dir(workspace.path("temporary")).unwrap();
    let in_temporary = || std::fs::read_dir(workspace.path("temporary")).unwrap().count();
    let has_begun = || {
        let mut folders = std::fs::read_dir(workspace.path("temporary")).unwrap();
        folders.any(|folder| {
            let files = std::fs::read_dir(folder.unwrap().path());
            files.is_ok_and(|mut files| files.next().is_some())
        })
    };
    let repetition = || {
        let mut process = workspace.process("verify --rerun --quiet a");
        process.env("TMPDIR", workspace.path("temporary"));
        process.stdout(Stdio::null());
        process
    };
    // On a busy machine it may have ended before the signal arrives.
    let stopped_on_the_way = |_| {
        let first = Running::start(&mut repetition());
        // A folder without a file may not be locked yet: it would be taken for a leftover and replaced.
        wait_for("file in the folder to work in", has_begun);
        send(&first, "-STOP");
        if in_temporary() == 1 {
            return Some(first);
        }
        send(&first, "-CONT");
        assert!(first.ended().status.success());
        None
    };
    let first = (0..10).find_map(stopped_on_the_way).unwrap();
    assert!(output(&mut repetition()).status.success());
    assert_eq!(in_temporary(), 1);
    send(&first, "-CONT");
    assert!(first.ended().status.success());
    assert_eq!(in_temporary(), 0);
}
