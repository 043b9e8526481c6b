//! Tests of the command `slipfront calibrate`.

use crate::support::process::{send, stderr, stdout, wait_for};
use crate::support::workspace::Workspace;

const FIT: &str = "[base]\nslider.blocks = [6, 6]\ndrive.v_star = 0.1\ntime.step = 0.4\n\
    [calibrate]\nx = 'time_s'\ny = 'friction_force_n'\nnoise = 0.01\nruns = 200\nfiner_runs = 0\n\
    unknowns = { 'friction.mu_static' = [0.3, 0.9], 'drive.stiffness_star' = [0.3, 0.9] }\n";

/// A folder with a calibration file, and the series of a run as a record.
pub(crate) fn workspace() -> Workspace {
    let workspace = Workspace::new();
    workspace.write("fit.toml", FIT);
    workspace.write(
        "truth.toml",
        "slider.blocks = [6, 6]\ndrive.v_star = 0.1\ntime = { step = 0.4, duration_star = 120 }\noutput.series = 1\n",
    );
    // This is one of the surfaces that the check itself uses.
    workspace.succeed("run truth.toml --seed 2 -o truth --no-pictures --quiet");
    workspace.write("record.csv", workspace.read("truth/series.csv"));
    workspace
}

/// The printed text equals the written one, the case can be run, and other calls and `verify` give the same
/// files.
#[test]
fn a_calibration_is_told_and_found_again() {
    let workspace = workspace();
    let said = workspace.succeed("calibrate fit.toml record.csv -o found --threads 1");
    let text = workspace.read_text("found/calibration.txt");
    assert!(
        said.starts_with(&text) && said.trim_end().ends_with("found"),
        "{said}"
    );
    assert!(text.contains("drive.stiffness_star"), "{text}");
    workspace.succeed("run found/case.toml -o run --no-pictures --quiet");
    workspace.succeed("calibrate found/calibration.toml found/record-1.csv -o twice --threads 2 --quiet");
    let others = |folder: &str| {
        let mut files = workspace.files(folder);
        files.retain(|name, _| name != "runs.jsonl");
        files
    };
    assert!(others("found") == others("twice"));
    let said = workspace.succeed("verify twice");
    assert!(
        said.contains("a calibration as its 360 recorded runs give it"),
        "{said}"
    );
    workspace.succeed("plot twice --width 60 --format pdf,png -o figures");
    assert!(workspace.files("figures").keys().eq(["band-1.pdf", "band-1.png"]));
    workspace.write(
        "found/posterior.csv",
        workspace.read_text("found/posterior.csv").replacen("0.", "1.", 1),
    );
    let differs = workspace.output("verify found");
    assert!(differs.status.code() == Some(1) && stdout(&differs).contains("posterior.csv differs"));
    // A second call runs nothing and changes nothing.
    let before = workspace.files("twice");
    let printed = workspace.succeed("calibrate fit.toml record.csv -o twice --json");
    assert!(workspace.files("twice") == before);
    assert_eq!(printed.trim_end(), workspace.read_text("twice/calibration.json"));
    // The copies in the folder are a calibration with the name of the folder.
    std::fs::create_dir(workspace.path("results")).unwrap();
    std::fs::rename(workspace.path("twice"), workspace.path("results/twice")).unwrap();
    workspace.succeed("calibrate results/twice/calibration.toml results/twice/record-1.csv --quiet");
    assert!(workspace.files("results/twice") == before && !workspace.exists("results/calibration"));
}

/// A planned record needs no measured record, and no file is written.
#[test]
fn a_planned_record_says_what_it_would_show() {
    let workspace = Workspace::new();
    workspace.write("fit.toml", FIT);
    let said = workspace.succeed("calibrate fit.toml --dry-run --until 40ns --quiet");
    assert!(
        said.contains("three times the speed") && said.contains("drive.stiffness_star"),
        "{said}"
    );
    assert_eq!(workspace.files(".").len(), 1);
    for (line, status, sentence) in [
        ("--dry-run --until 40nm", 2, "give a time"),
        (
            "--dry-run --until 40",
            2,
            "the end of the planned record: \"40\" has no unit",
        ),
        (
            "--dry-run --until 40ns --values 39",
            2,
            "39 is not in 40..=1000000",
        ),
        ("--until 40ns", 2, "--dry-run"),
    ] {
        let said = workspace.fail(&format!("calibrate fit.toml {line}"), status);
        assert!(said.contains(sentence), "{line}: {said}");
    }
}

/// Training runs are kept where a calibration of another record at the same times finds them.
#[test]
fn another_record_needs_no_runs() {
    let workspace = workspace();
    workspace.succeed("calibrate fit.toml record.csv -o one --training runs --quiet");
    let runs = workspace.read("runs/runs.jsonl");
    workspace.write(
        "other.csv",
        workspace.read_text("record.csv").replace("e-6,", "e-6 ,"),
    );
    let output = workspace.output("calibrate fit.toml other.csv -o two --training runs");
    assert!(
        output.status.success() && stderr(&output).contains("contains 200 runs"),
        "{}",
        stderr(&output)
    );
    assert!(workspace.read("runs/runs.jsonl") == runs);
    let said = workspace.fail("calibrate fit.toml other.csv -o one", 2);
    assert!(said.contains("contains another calibration"), "{said}");
}

/// A record with an obvious mistake is refused before any run, and before a folder is made.
#[test]
fn a_record_that_cannot_be_meant_is_refused_before_any_run() {
    let workspace = workspace();
    let series = workspace.read_text("record.csv");
    let (header, rows) = series.split_once('\n').unwrap();
    let refused = |record: &str, words: &str| {
        workspace.write("wrong.csv", record);
        let said = workspace.fail("calibrate fit.toml wrong.csv -o new", 2);
        assert!(said.contains(words), "{words}: {said}");
        assert!(!workspace.exists("new"), "{words}");
    };
    // This file is longer than the limit for copies: no part of it is read.
    let file = std::fs::File::create(workspace.path("long.csv")).unwrap();
    file.set_len(1 << 40).unwrap();
    let said = workspace.fail("calibrate fit.toml long.csv -o new", 2);
    assert!(
        said.contains("long.csv: it has 1099511627776 bytes; at most 16777216 are expected"),
        "{said}"
    );
    refused(
        &format!("{header}\n{}", rows.replacen('\n', "\nNaN\n", 3)),
        "line 3 of wrong.csv, \"NaN\", has no number in column",
    );
    // The times of the series begin at 0; the time is shifted in the first of the two requested columns.
    let place = header.split(',').position(|name| name == "time_s").unwrap();
    let before = rows.lines().map(|row| {
        let mut fields: Vec<String> = row.split(',').map(str::to_owned).collect();
        fields[place] = (fields[place].parse::<f64>().unwrap() - 2.0).to_string();
        fields.join(",") + "\n"
    });
    refused(
        &format!("{header}\n{}", before.collect::<String>()),
        "wrong.csv ends at -2 s, before the drive begins: times count from the beginning of the drive",
    );
    workspace.write("ended.csv", format!("{series}End of test\n"));
    let output = workspace.output("calibrate fit.toml ended.csv -o ended");
    let said = stderr(&output);
    assert!(
        output.status.success() && said.contains("note: ended.csv ends with 1 line without numbers"),
        "{said}"
    );
}

/// For a record that the model cannot reproduce, the status is 1, all results are written, and an error
/// message is printed even with `--quiet`.
#[test]
fn a_foreign_record_is_refused_aloud() {
    let workspace = workspace();
    let fit = FIT.replace("[calibrate]\n", "[calibrate]\ny_unit = 'MN'\n");
    workspace.write("foreign.toml", fit);
    let said = workspace.fail("calibrate foreign.toml record.csv -o found --quiet", 1);
    assert!(
        said.contains("the model cannot reproduce these records") && said.contains("found/calibration.txt"),
        "{said}"
    );
    let text = workspace.read_text("found/calibration.txt");
    assert!(
        text.starts_with("The model cannot reproduce these records"),
        "{text}"
    );
    assert!(workspace.exists("found/case.toml"));
}

#[test]
fn folders_of_others_are_left_alone() {
    let workspace = workspace();
    workspace.write("mine/notes.txt", "kept");
    let said = workspace.fail("calibrate fit.toml record.csv -o mine", 2);
    assert!(said.contains("is not the folder of a calibration"), "{said}");
    let said = workspace.fail("calibrate fit.toml missing.csv -o new", 2);
    assert!(said.contains("missing.csv") && !workspace.exists("new"), "{said}");
    let said = workspace.fail(
        "calibrate fit.toml record.csv record.csv mine/notes.txt -o new",
        2,
    );
    assert!(said.contains("notes.txt") && !workspace.exists("new"), "{said}");
}

/// A signal keeps the finished runs, and the same command continues with them.
#[cfg(unix)]
#[test]
fn a_signal_keeps_what_was_run() {
    let workspace = workspace();
    workspace.write("long.toml", FIT.replace("runs = 200\n", "runs = 5000\n"));
    let child = workspace.start("calibrate long.toml record.csv -o found");
    let has_runs = || workspace.exists("found/runs.jsonl") && !workspace.read("found/runs.jsonl").is_empty();
    wait_for("some runs", has_runs);
    send(&child, "-INT");
    let output = child.ended();
    assert!(
        !output.status.success() && stderr(&output).contains("the same command resumes"),
        "{}",
        stderr(&output)
    );
    assert!(!workspace.exists("found/calibration.json"));
    let said = workspace.fail("verify found", 2);
    assert!(said.contains("is not finished"), "{said}");
}
