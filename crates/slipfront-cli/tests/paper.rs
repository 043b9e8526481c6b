//! `slipfront paper` from outside, on the figures that cost least.

use assert_cmd::Command;

fn paper(out: &std::path::Path) -> Command {
    let mut command = Command::cargo_bin("slipfront").expect("the command is built");
    command.args(["paper", "--reduced", "--out"]).arg(out);
    command
}

#[test]
fn figures_are_made_judged_and_reported() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("paper");
    let docs = folder.path().join("docs");
    // Twice: what is there is replaced.
    for _ in 0..2 {
        let output = paper(&out)
            .args(["fig13", "table1", "--docs"])
            .arg(&docs)
            .output()
            .unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success(), "{text}");
        assert!(
            text.contains("4 claims: 2 hold, 0 hold with a condition, 2 do not hold"),
            "{text}"
        );
        assert!(text.contains("report.html"));
    }
    for name in [
        "fig13.svg",
        "fig13.png",
        "fig13.csv",
        "table1.csv",
        "claims.csv",
        "numbers.csv",
        "report.html",
    ] {
        assert!(out.join(name).exists(), "{name}");
    }
    assert!(docs.join("paper.md").exists());
    let claims = std::fs::read_to_string(out.join("claims.csv")).unwrap();
    assert_eq!(claims.lines().count(), 5);
    // A part of them leaves the rest in the report.
    assert!(paper(&out).arg("table1").output().unwrap().status.success());
    assert_eq!(std::fs::read_to_string(out.join("claims.csv")).unwrap(), claims);
}

#[test]
fn quiet_says_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let output = paper(&folder.path().join("paper"))
        .args(["fig13", "--quiet"])
        .output()
        .unwrap();
    assert!(output.status.success() && output.stdout.is_empty() && output.stderr.is_empty());
}

#[test]
fn what_cannot_be_done_is_said_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("paper");
    let refused = |figure: &str, sentence: &str| {
        let output = paper(&out).arg(figure).output().unwrap();
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(
            output.status.code() == Some(2) && text.contains(sentence),
            "{text}"
        );
    };
    refused("fig19", "the paper has no `fig19`");
    assert!(!out.exists());
    std::fs::create_dir(&out).unwrap();
    std::fs::write(out.join("notes.txt"), "mine").unwrap();
    refused("fig13", "holds other things");
    assert_eq!(std::fs::read_dir(&out).unwrap().count(), 1);
}

/// Neither a page of somebody's nor a study is replaced by figures, nor figures by a study.
#[test]
fn what_others_have_written_stays() {
    let folder = tempfile::tempdir().unwrap();
    let (out, docs) = (folder.path().join("paper"), folder.path().join("docs"));
    std::fs::create_dir_all(&docs).unwrap();
    std::fs::write(docs.join("paper.md"), "# My manuscript").unwrap();
    let output = paper(&out).args(["fig13", "--docs"]).arg(&docs).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("paper.md is not of an earlier call"), "{said}");
    assert!(!out.exists());
    for (name, text) in [("records.jsonl", ""), ("study.toml", "study.replicates = 1")] {
        std::fs::create_dir_all(&out).unwrap();
        std::fs::write(out.join(name), text).unwrap();
    }
    let output = paper(&out).arg("fig13").output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("holds other things than figures of the paper"),
        "{said}"
    );
    std::fs::remove_file(out.join("study.toml")).unwrap();
    std::fs::create_dir(out.join("found")).unwrap();
    let study = folder.path().join("study.toml");
    std::fs::write(&study, "base.slider.blocks = [2, 2]").unwrap();
    let mut command = Command::cargo_bin("slipfront").unwrap();
    let output = command
        .arg("study")
        .arg(&study)
        .arg("--out")
        .arg(&out)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("holds other things than a study"), "{said}");
}
