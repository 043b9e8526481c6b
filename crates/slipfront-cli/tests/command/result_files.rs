//! Folders of many runs: their files are compared with the checksums and with the results of the runs, and
//! edited files are not replaced.

use std::process::Stdio;

use crate::fixtures::list_as_written;
use crate::support::process::{
    Running, output, program, send, stderr, stdout, unset, wait_for, wait_for_signal_handlers,
};
use crate::support::workspace::Workspace;
use crate::verify::verified;

const WISH: &str = "[base]\nslider.blocks = [8, 8]\ndrive.v_star = 0.1\n\
    friction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\n\
    [design]\nwish = { least = 'static_friction' }\ncoverage = [0, 25]\nruns = 40\n";

const FIT: &str = "[base]\nslider.blocks = [4, 4]\ndrive.v_star = 0.1\ntime.step = 0.4\n\
    [calibrate]\nx = 'time_s'\ny = 'friction_force_n'\nnoise = 0.01\nruns = 200\nfiner_runs = 0\n\
    unknowns = { 'friction.mu_static' = [0.3, 0.9] }\n";

const TRUTH: &str = "slider.blocks = [4, 4]\ndrive.v_star = 0.1\ntime = { step = 0.4, duration_star = 120 }\noutput.series = 1\n";

const SHEET: &str = "slider.blocks = [8, 8]\nslider.block_size = '50 um'\ndrive.v_star = 0.1\n\
    friction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\ntime.stop = 'after_onset'\n";

const STUDY: &str = "base.slider.blocks = [4, 4]\nbase.drive.v_star = 0.2\nbase.time.stop = 'after_onset'\n\
    [[axes]]\nkey = 'drive.v_star'\nlist = [0.1, 0.2]\n";

/// Commands that write a folder: the line, and a file of the results.
const WRITERS: [(&str, &str); 5] = [
    ("design wish.toml -o out --time 0s --quiet", "mask.dxf"),
    ("calibrate fit.toml record.csv -o out --quiet", "case.toml"),
    ("converge sheet.toml -o out --quiet", "convergence.txt"),
    ("study study.toml -o out --quiet", "points.csv"),
    ("paper fig02 --reduced -o out --quiet", "claims.csv"),
];

fn workspace() -> Workspace {
    let workspace = Workspace::new();
    workspace.write("wish.toml", WISH);
    workspace.write("fit.toml", FIT);
    workspace.write("truth.toml", TRUTH);
    workspace.write("sheet.toml", SHEET);
    workspace.write("study.toml", STUDY);
    workspace.succeed("run truth.toml -o truth --no-pictures --quiet");
    workspace.write("record.csv", workspace.read("truth/series.csv"));
    workspace
}

#[test]
fn edited_results_are_named_and_replaced_on_demand() {
    let workspace = workspace();
    for (line, name) in WRITERS {
        workspace.remove("out");
        workspace.succeed(line);
        let whole = workspace.files("out");
        let path = format!("out/{name}");
        workspace.write(&path, "edited by hand");
        let said = workspace.fail(line, 2);
        assert!(said.contains(name) && said.contains("--force"), "{line}: {said}");
        assert_eq!(workspace.read_text(&path), "edited by hand", "{line}");
        workspace.succeed(&format!("{line} --force"));
        assert!(workspace.files("out") == whole, "{line}");
        workspace.succeed("verify out");
        // Another user's file in place of a missing result.
        workspace.remove("out/checksums.json");
        workspace.write(&path, "of somebody else");
        let said = workspace.fail(line, 2);
        assert!(said.contains(name), "{line}: {said}");
        assert_eq!(workspace.read_text(&path), "of somebody else", "{line}");
    }
}

/// A folder without the files that tell what it is: its kind is named, and what to do.
#[test]
fn key_files_that_are_missing_are_told_with_the_kind_of_folder() {
    let workspace = workspace();
    for ((line, _), (kind, key_files)) in WRITERS.into_iter().zip([
        ("design", ["design.toml", "design.jsonl"]),
        ("calibration", ["calibration.toml", "runs.jsonl"]),
        ("study", ["study.toml", "runs.jsonl"]),
        ("study", ["study.toml", "runs.jsonl"]),
        ("paper", ["report.html", "runs.jsonl"]),
    ]) {
        workspace.remove("out");
        workspace.succeed(line);
        for name in key_files.into_iter().chain(["checksums.json"]) {
            let path = format!("out/{name}");
            let bytes = workspace.read(&path);
            workspace.remove(&path);
            let sentence =
                format!("{path} is missing in the folder of a {kind}: put it back, or run `slipfront ");
            for verify in ["out", "out --checksums"] {
                let (status, said, problems) = verified(&workspace, verify);
                assert!(
                    status == 1 && said.contains(&sentence),
                    "{line}: {said}{problems}"
                );
            }
            if kind != "paper" {
                let said = workspace.fail("export out --ro-crate", 1);
                assert!(said.contains(&sentence), "{said}");
            }
            workspace.write(&path, bytes);
        }
    }
}

/// A search that ran out of time can be verified like any other, and each of its files is checked.
#[test]
fn a_design_that_ran_out_of_time_is_verified_to_the_last_file() {
    let workspace = workspace();
    for time in ["0s", "100ms"] {
        workspace.remove("out");
        workspace.succeed(&format!(
            "design wish.toml -o out --time {time} --runs 100000 --quiet"
        ));
        let (status, said, problems) = verified(&workspace, "out");
        assert_eq!((status, problems.as_str()), (0, ""), "{said}");
        assert!(
            said.contains("a design as its") && !said.contains("made again"),
            "{said}"
        );
    }
    let files = workspace.files("out");
    for (name, bytes) in &files {
        let mut spoilt = bytes.clone();
        spoilt[bytes.len() / 2] ^= 1;
        workspace.write(&format!("out/{name}"), spoilt);
        let (status, said, problems) = verified(&workspace, "out --checksums");
        assert!(
            status == 1 && said.contains(&format!("out/{name} ")),
            "{name}: {said}{problems}"
        );
        workspace.write(&format!("out/{name}"), bytes);
    }
    // If the list of checksums was changed too, the runs reveal it.
    for name in ["mask.dxf", "mask.npy", "design.txt", "evaluations.csv"] {
        let path = format!("out/{name}");
        let mut spoilt = files[name].clone();
        let middle = spoilt.len() / 2;
        spoilt[middle] ^= 1;
        workspace.write(&path, spoilt);
        list_as_written(&workspace, "out", name);
        assert_eq!(verified(&workspace, "out --checksums").0, 0, "{name}");
        let (status, said, _) = verified(&workspace, "out");
        let sentence = format!("{path} differs: other bytes follow from its runs");
        assert!(status == 1 && said.contains(&sentence), "{name}: {said}");
        workspace.write(&path, &files[name]);
        list_as_written(&workspace, "out", name);
    }
}

/// Figures that could not be derived again are named, and are no success unless only checksums were
/// requested.
#[test]
fn figures_whose_data_are_lost_are_not_taken_for_verified() {
    let workspace = Workspace::new();
    workspace.succeed("paper fig02 --reduced -o out --quiet");
    let (status, said, _) = verified(&workspace, "out");
    assert!(
        status == 0 && said.contains("as the data of the figures give them"),
        "{said}"
    );
    workspace.write("out/found/fig02-auto.bin", "spoilt");
    let (status, said, _) = verified(&workspace, "out --checksums");
    assert!(
        status == 1 && said.contains("out/found/fig02-auto.bin differs"),
        "{said}"
    );
    list_as_written(&workspace, "out", "claims.csv");
    let (status, said, problems) = verified(&workspace, "out");
    assert_eq!(status, 1, "{said}");
    assert!(
        said.contains("were not recomputed") && problems.contains("--checksums"),
        "{said}{problems}"
    );
    assert_eq!(verified(&workspace, "out --checksums").0, 0);
    let (status, said, problems) = verified(&workspace, "out --quiet");
    assert_eq!((status, said.as_str()), (1, ""), "{problems}");
}

/// Verification does not wait for a pipe without a writer, and does not copy a file longer than the disk.
#[cfg(unix)]
#[test]
fn pipes_and_endless_files_end_no_verification() {
    let workspace = workspace();
    for (line, files) in [
        (
            WRITERS[0].0,
            ["design.jsonl", "design.toml", "checksums.json", "design.json"],
        ),
        (
            WRITERS[1].0,
            ["runs.jsonl", "calibration.toml", "checksums.json", "record-1.csv"],
        ),
        (
            WRITERS[3].0,
            ["runs.jsonl", "study.toml", "checksums.json", "points.csv"],
        ),
    ] {
        workspace.remove("out");
        workspace.succeed(line);
        for name in files {
            let path = format!("out/{name}");
            let bytes = workspace.read(&path);
            workspace.remove(&path);
            assert!(workspace.shell(&format!("mkfifo {path}")).status.success());
            assert_ne!(verified(&workspace, "out").0, 0, "{line}: {name}");
            workspace.remove(&path);
            let endless = std::fs::File::create(workspace.path(&path)).unwrap();
            endless.set_len(1 << 40).unwrap();
            assert_ne!(verified(&workspace, "out").0, 0, "{line}: {name}");
            workspace.remove(&path);
            workspace.write(&path, bytes);
        }
        workspace.succeed("verify out");
    }
}

/// An archive may be read-only, but its copy in the folder for temporary files must be writable.
#[cfg(unix)]
#[test]
fn a_read_only_folder_is_verified_by_everybody() {
    use std::os::unix::fs::{MetadataExt, chown};
    use std::os::unix::process::CommandExt;
    const NOBODY: u32 = 65534;
    let workspace = workspace();
    // Only root can become another user, who is bound by file modes.
    let is_root = std::fs::metadata("/proc/self").is_ok_and(|own| own.uid() == 0);
    for (line, _) in WRITERS {
        workspace.remove("out");
        workspace.succeed(line);
        assert!(
            workspace
                .shell("chmod -R a-w,a+rX . && mkdir -p temporary")
                .status
                .success()
        );
        let temporary = workspace.path("temporary");
        let mut process = workspace.process("verify out");
        process.env("TMPDIR", &temporary);
        if is_root {
            // If this process wrote the copy, another thread could start a process that holds it open, and it
            // could not be run.
            let script = format!(
                "chmod a+rx . && chmod u+w temporary && cp '{}' temporary/slipfront",
                program()
            );
            assert!(workspace.shell(&script).status.success());
            chown(&temporary, Some(NOBODY), Some(NOBODY)).unwrap();
            process = unset(workspace.path("temporary/slipfront").to_str().unwrap());
            process.args(["verify", "out"]).current_dir(workspace.path("."));
            process.env("TMPDIR", &temporary).uid(NOBODY).gid(NOBODY);
        }
        let output = output(&mut process);
        assert!(
            output.status.success(),
            "{line}: {}{}",
            stdout(&output),
            stderr(&output)
        );
        assert!(
            workspace
                .shell("chmod -R u+w .; rm -rf temporary")
                .status
                .success()
        );
    }
}

/// A signal ends a verification that repeats runs, and no file of it is left.
#[cfg(unix)]
#[test]
fn a_signal_leaves_no_copy_behind() {
    let workspace = workspace();
    // Without its journal, all runs are made again.
    workspace.write(
        "wish.toml",
        WISH.replace("[8, 8]", "[40, 40]")
            .replace("runs = 40", "runs = 200"),
    );
    workspace.succeed("design wish.toml -o out --quiet");
    workspace.write("out/design.jsonl", "");
    list_as_written(&workspace, "out", "mask.dxf");
    std::fs::create_dir(workspace.path("temporary")).unwrap();
    let names = || std::fs::read_dir(workspace.path("temporary")).unwrap().count();
    for (signal, status) in [("-INT", 130), ("-TERM", 143), ("-HUP", 129)] {
        let mut process = workspace.process("verify out --threads 1");
        process.env("TMPDIR", workspace.path("temporary"));
        let child = Running::start(process.stdout(Stdio::null()).stderr(Stdio::piped()));
        wait_for_signal_handlers(&child);
        wait_for("a copy", || names() > 0);
        send(&child, signal);
        let output = child.ended();
        let ignored = signal == "-HUP" && crate::support::process::ignores_hangup();
        if !ignored {
            assert_eq!(output.status.code(), Some(status), "{}", stderr(&output));
        }
        assert_eq!(names(), 0, "{signal}");
    }
}

#[test]
fn journals_of_another_kind_are_refused() {
    let workspace = workspace();
    let kinds = [
        ("design", WRITERS[0].0, "design.jsonl"),
        ("calibration", WRITERS[1].0, "runs.jsonl"),
        ("study", WRITERS[3].0, "runs.jsonl"),
    ];
    for (kind, line, _) in kinds {
        workspace.succeed(&line.replace("-o out", &format!("-o {kind}")));
    }
    for (kind, line, name) in kinds {
        let path = format!("{kind}/{name}");
        let own = workspace.read(&path);
        for (_, _, other) in kinds.iter().filter(|(_, _, other)| *other != name) {
            let folder = kinds.iter().find(|(_, _, name)| name == other).unwrap().0;
            let foreign = workspace.read(&format!("{folder}/{other}"));
            workspace.write(&path, &foreign);
            let said = workspace.fail(&line.replace("-o out", &format!("-o {kind}")), 2);
            assert!(
                said.contains("contains runs of another kind of task"),
                "{line}: {said}"
            );
            let (status, said, _) = verified(&workspace, kind);
            assert!(
                status == 1 && said.contains(&format!("{path} differs: ")),
                "{said}"
            );
            assert!(workspace.read(&path) == foreign, "{kind}: {other}");
        }
        workspace.write(&path, own);
        workspace.succeed(&format!("verify {kind}"));
    }
}

/// A line of a design for a run without result and without error is invalid.
#[test]
fn a_run_without_an_end_is_none() {
    let workspace = workspace();
    let (line, _) = WRITERS[0];
    workspace.succeed(line);
    let text = workspace.read_text("out/design.jsonl");
    let json: serde_json::Value = serde_json::from_str(&text.lines().next().unwrap()[17..]).unwrap();
    let json = serde_json::json!({ "id": json["id"] }).to_string();
    let sum = &blake3::hash(json.as_bytes()).to_hex()[..16];
    workspace.write("out/design.jsonl", format!("{sum} {json}\n"));
    let said = workspace.fail(line, 2);
    assert!(said.contains("contains runs of another kind of task"), "{said}");
}

#[test]
fn the_folder_of_training_runs_is_not_that_of_the_results() {
    let workspace = workspace();
    for (out, training) in [("new", "new"), ("new", "./new"), ("./new", "new")] {
        let said = workspace.fail(
            &format!("calibrate fit.toml record.csv -o {out} --training {training}"),
            2,
        );
        assert!(
            said.contains(&format!("--training {training} is the results folder")),
            "{said}"
        );
        assert!(!workspace.exists("new"));
    }
}

/// A folder of training runs that another calibration uses contains no new files.
#[cfg(unix)]
#[test]
fn waiting_for_training_runs_leaves_no_folder() {
    let workspace = workspace();
    workspace.write("long.toml", FIT.replace("runs = 200\n", "runs = 5000\n"));
    let child = workspace.start("calibrate long.toml record.csv -o one --training runs");
    wait_for("training runs", || {
        workspace.exists("runs/runs.jsonl") && !workspace.read("runs/runs.jsonl").is_empty()
    });
    let said = workspace.fail("calibrate fit.toml record.csv -o two --training runs", 2);
    assert!(said.contains("another slipfront is running in runs"), "{said}");
    assert!(!workspace.exists("two"));
    send(&child, "-INT");
    child.ended();
}
